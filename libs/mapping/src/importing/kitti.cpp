// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "importing/dataset_folder.h"
#include "importing/dataset_formats.h"

#include <fstream>
#include <locale>
#include <sstream>
#include <stdexcept>

namespace opp::mapping {
namespace {

namespace fs = std::filesystem;

constexpr double kLidarRate = 10.0;  ///< [Hz]

/// Pose of the lidar on the left camera: the line "Tr: ..." of calib.txt.
Eigen::Isometry3d cameraFromLidar(const fs::path& folder) {
  const fs::path file = folder / "calib.txt";
  std::ifstream stream(file);
  if (!stream) {
    throw std::runtime_error(file.string() +
                             ": missing; poses are those of the camera, and its line 'Tr:' gives "
                             "the lidar's pose on it");
  }
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("Tr:", 0) != 0 && line.rfind("Tr ", 0) != 0) continue;
    std::istringstream words(line.substr(3));
    words.imbue(std::locale::classic());
    std::vector<double> numbers;
    for (double number = 0.0; words >> number;) numbers.push_back(number);
    const auto pose = poseFromRows(numbers, file.string() + ": Tr");
    if (pose) return *pose;
  }
  throw std::runtime_error(file.string() + ": holds no line 'Tr:' of 12 finite numbers");
}

/// Times of frames 0, 1, ... from times.txt.
void setTimes(const fs::path& file, const std::map<long, fs::path>& files,
              const ImportOptions& options, ImportPlan& plan) {
  const auto lines = readNumbers(file);
  if (static_cast<long>(lines.size()) <= files.rbegin()->first) {
    throw std::runtime_error(file.string() + ": has " + std::to_string(lines.size()) +
                             " times, but " + files.rbegin()->second.string() + " needs number " +
                             std::to_string(files.rbegin()->first));
  }
  std::size_t k = 0;
  for (const auto& [number, path] : files) {
    plan.frames[k++].timestamp =
        options.start_time + lines[static_cast<std::size_t>(number)].front();
  }
}

}  // namespace

ImportPlan planKitti(const fs::path& folder, const ImportOptions& options) {
  ImportPlan plan;
  plan.kind = FrameKind::kKittiPoints;
  const auto files = numberedFiles(subfolderIfAny(folder, "velodyne"), ".bin");
  addNumberedFrames(files, kLidarRate, options, plan);
  const fs::path times = folder / "times.txt";
  if (fs::exists(times) && !options.rate) setTimes(times, files, options, plan);
  const fs::path poses = !options.poses.empty()             ? options.poses
                         : fs::exists(folder / "poses.txt") ? folder / "poses.txt"
                                                            : fs::path();
  if (poses.empty()) return plan;
  const Eigen::Isometry3d camera_from_lidar = cameraFromLidar(folder);
  const auto lines = readNumbers(poses);
  std::size_t k = 0;
  for (const auto& [number, path] : files) {
    const ImportFrame& frame = plan.frames[k++];
    if (number >= static_cast<long>(lines.size())) {
      plan.notes.push_back(poses.string() + ": has " + std::to_string(lines.size()) +
                           " poses; scans from number " + std::to_string(number) +
                           " on have no true pose");
      break;
    }
    const std::string where = poses.string() + ": pose " + std::to_string(number);
    const auto first_camera_from_camera =
        poseFromRows(lines[static_cast<std::size_t>(number)], where);
    if (!first_camera_from_camera) continue;
    plan.ground_truth.push_back(
        {frame.timestamp,
         camera_from_lidar.inverse() * *first_camera_from_camera * camera_from_lidar});
  }
  return plan;
}

}  // namespace opp::mapping
