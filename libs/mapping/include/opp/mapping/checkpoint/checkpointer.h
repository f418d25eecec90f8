// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/checkpoint/checkpoint_params.h"
#include "opp/mapping/checkpoint/run_identity.h"
#include "opp/mapping/pipeline/mapping_run.h"

#include <chrono>
#include <filesystem>
#include <functional>

namespace opp::mapping {

/// Keeps the checkpoint of a run up to date, now and then: large maps take long to write.
class Checkpointer {
 public:
  using Clock = std::function<std::chrono::duration<double>()>;

  /// \param file the checkpoint. \param clock for tests; by default that of the machine.
  Checkpointer(std::filesystem::path file, RunIdentity identity, const CheckpointParams& params,
               Clock clock = {});

  /// Takes up the run of the checkpoint, see `readCheckpoint`; false if there is none.
  bool restore(MappingRun& run) const;

  /// `save` if the last time is long enough ago; to be called after each scan.
  void update(MappingRun& run);

  /// Replaces the checkpoint. The report takes note of the seconds.
  /// \throws std::runtime_error if it cannot be written; the last one is then still there.
  void save(MappingRun& run);

 private:
  std::filesystem::path file_;
  RunIdentity identity_;
  CheckpointParams params_;
  Clock clock_;
  std::chrono::duration<double> due_;  ///< when `update` writes next
};

}  // namespace opp::mapping
