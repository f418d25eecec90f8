// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "importing/dataset_folder.h"
#include "importing/dataset_formats.h"

#include <stdexcept>

namespace opp::mapping {
namespace {

namespace fs = std::filesystem;

constexpr double kMillimetre = 0.001;
constexpr double kRate = 30.0;             ///< [Hz] of the Kinect
constexpr std::size_t kRedwoodHeader = 3;  ///< numbers on the line before each matrix
constexpr std::size_t kRedwoodRows = 4;

void finishDepth(const char* preset, const ImportOptions& options, ImportPlan& plan) {
  plan.intrinsics = options.intrinsics.value_or(intrinsicsFromText(preset));
  plan.range_unit = options.range_unit.value_or(kMillimetre);
}

/// The camera's pose of frame `number`, unless it is lost.
void addPose(double timestamp, const std::optional<Eigen::Isometry3d>& map_from_optical,
             const std::string& where, ImportPlan& plan) {
  if (map_from_optical) {
    plan.ground_truth.push_back({timestamp, *map_from_optical * opticalFromBody()});
  } else {
    plan.notes.push_back(where + ": no finite pose");
  }
}

std::vector<double> joined(const std::vector<std::vector<double>>& lines, std::size_t begin,
                           std::size_t end) {
  std::vector<double> numbers;
  for (std::size_t k = begin; k < end && k < lines.size(); ++k) {
    numbers.insert(numbers.end(), lines[k].begin(), lines[k].end());
  }
  return numbers;
}

}  // namespace

ImportPlan planSevenScenes(const fs::path& folder, const ImportOptions& options) {
  ImportPlan plan;
  addNumberedFrames(numberedFiles(folder, ".depth.png"), kRate, options, plan);
  finishDepth("7scenes", options, plan);
  if (!options.poses.empty()) {
    throw std::runtime_error(options.poses.string() +
                             ": 7-Scenes has a pose file for each frame; leave --poses out");
  }
  for (const ImportFrame& frame : plan.frames) {
    std::string name = frame.file.filename().string();
    name = name.substr(0, name.find('.')) + ".pose.txt";
    const fs::path file = frame.file.parent_path() / name;
    if (!fs::exists(file)) {
      plan.notes.push_back(file.string() + ": missing; the frame has no true pose");
      continue;
    }
    const auto lines = readNumbers(file);
    addPose(frame.timestamp, poseFromRows(joined(lines, 0, lines.size()), file.string()),
            file.string(), plan);
  }
  return plan;
}

ImportPlan planRedwood(const fs::path& folder, const ImportOptions& options) {
  ImportPlan plan;
  addNumberedFrames(numberedFiles(subfolderIfAny(folder, "depth"), ".png"), kRate, options, plan);
  finishDepth("redwood", options, plan);
  const fs::path poses =
      options.poses.empty() ? onlyFile(folder, {".log", "-traj.txt"}, "true poses") : options.poses;
  if (poses.empty()) return plan;
  // Poses are in the order of the frames; the first one is that of the first image.
  const auto lines = readNumbers(poses);
  constexpr std::size_t kStep = 1 + kRedwoodRows;
  const double first = plan.frames.front().timestamp;
  const double rate = options.rate.value_or(kRate);
  for (std::size_t k = 0; k < lines.size(); k += kStep) {
    const std::string where = poses.string() + ": pose " + std::to_string(k / kStep);
    if (lines[k].size() != kRedwoodHeader) {
      throw std::runtime_error(where + ": expected a line of three numbers and a 4 x 4 matrix");
    }
    addPose(first + static_cast<double>(k / kStep) / rate,
            poseFromRows(joined(lines, k + 1, k + kStep), where), where, plan);
  }
  const std::size_t count = lines.size() / kStep;
  if (count < plan.frames.size()) {
    plan.notes.push_back(poses.string() + ": has " + std::to_string(count) + " poses for " +
                         std::to_string(plan.frames.size()) + " frames");
  }
  return plan;
}

}  // namespace opp::mapping
