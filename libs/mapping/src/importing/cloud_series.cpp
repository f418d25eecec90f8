// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/tum_trajectory.h"

#include "importing/dataset_folder.h"
#include "importing/dataset_formats.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace opp::mapping {
namespace {

namespace fs = std::filesystem;

constexpr double kRate = 10.0;  ///< [Hz] of common lidars

/// The time that a name gives: a number with decimals and nothing else.
std::optional<double> timeIn(const fs::path& file) {
  const std::string stem = file.stem().string();
  double time = 0.0;
  const auto [stop, error] = std::from_chars(stem.data(), stem.data() + stem.size(), time);
  const bool is_number = error == std::errc() && stop == stem.data() + stem.size();
  if (!is_number || stem.find('.') == std::string::npos || !std::isfinite(time)) {
    return std::nullopt;
  }
  return time;
}

/// Frames of a folder whose names all are times, in ascending order; else none.
std::vector<ImportFrame> timedFrames(const fs::path& folder, const std::string& extension) {
  std::vector<ImportFrame> frames;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != extension) continue;
    const auto time = timeIn(entry.path());
    if (!time) return {};
    frames.push_back({*time, entry.path()});
  }
  std::sort(frames.begin(), frames.end(),
            [](const ImportFrame& a, const ImportFrame& b) { return a.timestamp < b.timestamp; });
  for (std::size_t k = 1; k < frames.size(); ++k) {
    if (frames[k - 1].timestamp < frames[k].timestamp) continue;
    throw std::runtime_error(frames[k - 1].file.string() + " and " +
                             frames[k].file.filename().string() + " have the same time");
  }
  return frames;
}

}  // namespace

ImportPlan planCloudSeries(const fs::path& folder, const std::string& extension,
                           const ImportOptions& options) {
  ImportPlan plan;
  plan.kind = FrameKind::kCloudFile;
  plan.frames = timedFrames(folder, extension);
  if (plan.frames.empty()) {
    addNumberedFrames(numberedFiles(folder, extension, NumberIn::kLast), kRate, options, plan);
  }
  if (!options.poses.empty()) plan.ground_truth = readTumTrajectory(options.poses);
  return plan;
}

}  // namespace opp::mapping
