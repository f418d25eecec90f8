// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace opp::mapping {

/// Depth image as a rawlog stores it. Rows from the top; depth along the optical axis.
struct RawlogDepthImage {
  int width = 0;
  int height = 0;
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;  ///< [px], no distortion
  double range_unit = 0.001;                      ///< [m] of a count
  double max_range = 0.0;                         ///< [m]
  std::vector<std::uint16_t> counts;              ///< row by row; 0: no measurement
};

/// What observations of one moment share.
struct RawlogStamp {
  double timestamp = 0.0;  ///< Unix time [s]; stored in steps of 100 ns
  std::string label;       ///< of the sensor
  Eigen::Isometry3d body_from_sensor = Eigen::Isometry3d::Identity();
};

struct RawlogWriterOptions {
  /// Pairs of action and sensory frame, where odometry is the action's increment, instead of a
  /// sequence of observations.
  bool action_format = false;
  int compression = 1;  ///< gzip level 0–9; noisy depth gains nothing above 1
};

/// Writes a rawlog object by object; the memory needed does not grow with its length. The file is
/// complete once close() has returned; until then it has another name in the same folder, and is
/// removed if close() is never reached. Equal calls give equal bytes: nothing of the clock gets in.
class RawlogWriter {
 public:
  /// \throws std::runtime_error if the file cannot be written, std::invalid_argument for a
  /// compression level that gzip does not have.
  explicit RawlogWriter(const std::filesystem::path& file, const RawlogWriterOptions& options = {});
  ~RawlogWriter();
  RawlogWriter(RawlogWriter&&) noexcept;
  RawlogWriter& operator=(RawlogWriter&&) noexcept;

  /// Pose of the body in the odometry frame, valid for observations of the same and later times
  /// until the next call: CObservationOdometry (planar: x, y, yaw) or, in the action format, the
  /// increment of the next pair, in 3D. Observations without any call get no odometry (action
  /// format: the increment is zero).
  void writeOdometry(double timestamp, const Eigen::Isometry3d& odom_from_body);
  /// CObservation3DRangeScan with 16-bit depth inside.
  /// \throws std::invalid_argument if sizes do not fit or the camera has no focal length.
  void write(const RawlogStamp& stamp, const RawlogDepthImage& image);
  /// CObservationPointCloud; \p points_in_sensor [m].
  void write(const RawlogStamp& stamp, const std::vector<Eigen::Vector3f>& points_in_sensor);
  /// Ends the file and gives it its name. \throws std::runtime_error if that fails.
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace opp::mapping
