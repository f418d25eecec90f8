// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/trajectory.h"
#include "opp/mapping/importing/camera_preset.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace opp::mapping {

/// Forms of public data sets.
enum class DatasetFormat { kTum, kIclNuim, kSevenScenes, kRedwood, kKitti, kPcd, kPly };

/// "tum", "icl-nuim", "7scenes", "redwood", "kitti", "pcd" or "ply".
/// \throws std::invalid_argument for other names.
DatasetFormat datasetFormatFromName(std::string_view name);

/// What the user may say about a data set.
struct ImportOptions {
  std::optional<CameraIntrinsics> intrinsics;  ///< else those of the set
  std::optional<double> range_unit;            ///< [m] of a depth count; else that of the set
  std::optional<double> rate;                  ///< [Hz] where the set has no times; else the set's
  std::filesystem::path poses;                 ///< file of true poses; empty: where the set has it
  /// Leave out frames whose file is missing (ImportPlan::missing names them) instead of failing.
  bool skip_missing = false;
  /// Time of frame 0 of sets without absolute times: Unix time [s].
  double start_time = 1.6e9;
};

/// How the frames of a set are stored.
enum class FrameKind { kDepthPng, kKittiPoints, kCloudFile };

/// One frame to import.
struct ImportFrame {
  double timestamp = 0.0;  ///< Unix time [s]
  std::filesystem::path file;
};

/// All that is known of a data set before its frames are read.
struct ImportPlan {
  FrameKind kind = FrameKind::kDepthPng;
  std::vector<ImportFrame> frames;
  CameraIntrinsics intrinsics;  ///< depth only
  double range_unit = 0.0;      ///< [m]; depth only
  /// map_from_body with the body's x forward, y left, z up; empty if the set has no poses.
  Trajectory ground_truth;
  std::vector<std::string> missing;  ///< frames that were skipped, by file
  std::vector<std::string> notes;    ///< choices the user should know of
};

/// Looks through a data set's folder:
/// - tum: depth.txt ("timestamp file"), groundtruth.txt; 1/5000 m; intrinsics by "freiburgN" in the
///   path, else tum-default.
/// - icl-nuim (PNG form): depth/N.png at 30 Hz, *.gt.freiburg; 1/5000 m.
/// - 7scenes: frame-N.depth.png and frame-N.pose.txt at 30 Hz; 1 mm.
/// - redwood: depth/N*.png or N*.png at 30 Hz; *.log or *-traj.txt; 1 mm.
/// - kitti: velodyne/N.bin (or N.bin), times.txt or 10 Hz; with `poses`, calib.txt for the pose of
///   the lidar on the camera.
/// - pcd, ply: a series of clouds in the frame of the body. A name that is a number with decimals
/// is
///   the time (1305031102.175304.pcd), else the last number in the name counts frames at 10 Hz.
///   `poses`: TUM text, map_from_body.
/// Numbered frames must be without gaps: a missing number is a missing file. Poses of the optical
/// camera frame are turned into those of the body; the map frame is that of the set (kitti: the
/// first lidar frame).
/// \throws std::runtime_error that names the missing or wrong file and says what is expected;
/// std::invalid_argument if an option is out of range.
ImportPlan planImport(DatasetFormat format, const std::filesystem::path& folder,
                      const ImportOptions& options = {});

}  // namespace opp::mapping
