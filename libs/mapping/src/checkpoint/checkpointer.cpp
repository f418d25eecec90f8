// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/checkpoint/checkpointer.h"

#include "opp/mapping/checkpoint/checkpoint_file.h"

#include <algorithm>
#include <utility>

namespace opp::mapping {
namespace {

using Seconds = std::chrono::duration<double>;

Seconds steadyNow() { return std::chrono::steady_clock::now().time_since_epoch(); }

}  // namespace

Checkpointer::Checkpointer(std::filesystem::path file, RunIdentity identity,
                           const CheckpointParams& params, Clock clock)
    : file_(std::move(file)),
      identity_(std::move(identity)),
      params_(params),
      clock_(clock ? std::move(clock) : steadyNow),
      due_(clock_() + Seconds(params_.interval)) {}

bool Checkpointer::restore(MappingRun& run) const {
  if (!std::filesystem::exists(file_)) return false;
  readCheckpoint(file_, identity_, run);
  return true;
}

void Checkpointer::update(MappingRun& run) {
  if (clock_() >= due_) save(run);
}

void Checkpointer::save(MappingRun& run) {
  const Seconds start = clock_();
  due_ = start + Seconds(params_.interval);  // also if it cannot be written
  writeCheckpoint(file_, identity_, run);
  const Seconds end = clock_();
  const Seconds cost = end - start;
  run.report.seconds["checkpoints"] += cost.count();
  due_ = end + std::max(Seconds(params_.interval), cost / params_.max_share);
}

}  // namespace opp::mapping
