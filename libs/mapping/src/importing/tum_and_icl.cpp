// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/tum_trajectory.h"

#include "importing/dataset_folder.h"
#include "importing/dataset_formats.h"

#include <fstream>
#include <locale>
#include <sstream>
#include <stdexcept>

namespace opp::mapping {
namespace {

namespace fs = std::filesystem;

constexpr double kTumRangeUnit = 1.0 / 5000.0;  ///< [m], also of ICL-NUIM's PNG form
constexpr double kIclRate = 30.0;               ///< [Hz]

/// "timestamp file" lines of depth.txt.
void addListedFrames(const fs::path& folder, const ImportOptions& options, ImportPlan& plan) {
  const fs::path list = folder / "depth.txt";
  std::ifstream stream(list);
  if (!stream) {
    throw std::runtime_error(
        list.string() + ": missing; TUM RGB-D sets list time and file of each depth image there");
  }
  std::string text;
  for (std::size_t line = 1; std::getline(stream, text); ++line) {
    std::istringstream words(text.substr(0, text.find('#')));
    words.imbue(std::locale::classic());
    ImportFrame frame;
    std::string file, rest;
    if ((words >> std::ws).eof()) continue;
    if (!(words >> frame.timestamp >> file) || words >> rest) {
      throw std::runtime_error(list.string() + ":" + std::to_string(line) +
                               ": expected 'timestamp file'");
    }
    frame.file = folder / file;
    if (fs::is_regular_file(frame.file)) {
      plan.frames.push_back(frame);
    } else if (options.skip_missing) {
      plan.missing.push_back(frame.file.string());
    } else {
      throw std::runtime_error(frame.file.string() + ": missing, but listed in " + list.string() +
                               "; --skip-missing leaves such frames out");
    }
    const std::size_t n = plan.frames.size();
    if (n > 1 && !(plan.frames[n - 2].timestamp < plan.frames[n - 1].timestamp)) {
      throw std::runtime_error(list.string() + ":" + std::to_string(line) +
                               ": the times do not ascend");
    }
  }
  if (plan.frames.empty()) throw std::runtime_error(list.string() + ": lists no depth image");
}

/// Intrinsics by the name of the camera that TUM puts into its folder names.
CameraIntrinsics tumIntrinsics(const fs::path& folder, ImportPlan& plan) {
  const std::string name = fs::absolute(folder).lexically_normal().string();
  std::string preset = "tum-default";
  for (const char* number : {"1", "2", "3"}) {
    if (name.find(std::string("freiburg") + number) != std::string::npos) {
      preset = std::string("tum-fr") + number;
    }
  }
  plan.notes.push_back("intrinsics: " + preset);
  return intrinsicsFromText(preset);
}

Trajectory bodyPoses(Trajectory optical_poses) {
  for (StampedPose& pose : optical_poses) {
    pose.map_from_body = pose.map_from_body * opticalFromBody();
  }
  return optical_poses;
}

}  // namespace

ImportPlan planTum(const fs::path& folder, const ImportOptions& options) {
  ImportPlan plan;
  addListedFrames(folder, options, plan);
  plan.intrinsics = options.intrinsics ? *options.intrinsics : tumIntrinsics(folder, plan);
  plan.range_unit = options.range_unit.value_or(kTumRangeUnit);
  const fs::path poses = options.poses.empty() ? folder / "groundtruth.txt" : options.poses;
  if (!options.poses.empty() || fs::exists(poses)) {
    plan.ground_truth = bodyPoses(readTumTrajectory(poses));
  }
  return plan;
}

ImportPlan planIclNuim(const fs::path& folder, const ImportOptions& options) {
  ImportPlan plan;
  addNumberedFrames(numberedFiles(subfolderIfAny(folder, "depth"), ".png"), kIclRate, options,
                    plan);
  plan.intrinsics = options.intrinsics.value_or(intrinsicsFromText("icl-nuim"));
  plan.range_unit = options.range_unit.value_or(kTumRangeUnit);
  const fs::path poses = options.poses.empty()
                             ? onlyFile(folder, {".gt.freiburg"}, "true poses (*.gt.freiburg)")
                             : options.poses;
  if (poses.empty()) return plan;
  plan.ground_truth = bodyPoses(readTumTrajectory(poses));
  // The file counts frames where TUM's have times.
  for (StampedPose& pose : plan.ground_truth) {
    pose.timestamp = options.start_time + pose.timestamp / options.rate.value_or(kIclRate);
  }
  return plan;
}

}  // namespace opp::mapping
