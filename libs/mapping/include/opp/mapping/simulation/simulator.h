// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/simulation/depth_camera.h"
#include "opp/mapping/simulation/lidar.h"
#include "opp/mapping/simulation/scene.h"

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

namespace opp::mapping {

enum class SimulatedSensor { kKinect, kIdeal, kLidar16, kLidar64 };

/// "kinect", "ideal", "lidar16" or "lidar64". \throws std::invalid_argument for other names.
SimulatedSensor simulatedSensorFromName(std::string_view name);

struct SimulationOptions {
  SimulatedSensor sensor = SimulatedSensor::kKinect;
  int frames = 0;     ///< spread evenly over the passes; 0: as many as the scene says
  int passes = 1;     ///< rounds through the path; more than one needs a closed path
  double rate = 0.0;  ///< [Hz] frames from the start at this rate instead; 0: spread evenly
  std::uint64_t seed = 1;
  int decimation = 1;         ///< of the depth image's width and height
  double start_time = 1.7e9;  ///< Unix time of frame 0 [s]
  /// Unit of the `ideal` camera's 16-bit depth [m]: reaches 13.1 m, rounds by at most 0.1 mm.
  double ideal_range_unit = 2e-4;
  Eigen::Isometry3d body_from_sensor = Eigen::Isometry3d::Identity();
  /// The body is a robot: it drives through the way-points on the floor z = 0, level and without
  /// unrest. The sensor's height and tilt are those of body_from_sensor alone.
  bool planar = false;
  double drop_rate = 0.0;  ///< share of the frames that get lost (never the first)
  /// Shares [from, to] of the whole way that the body is carried over unseen, while its clock
  /// stands still: a jump.
  std::optional<std::array<double, 2>> kidnap;
};

/// One observation and what is true about it.
struct SimulatedFrame {
  double timestamp = 0.0;  ///< Unix time, whole microseconds [s]
  Eigen::Isometry3d map_from_body = Eigen::Isometry3d::Identity();
  std::variant<DepthImage, LidarScan> data;
};

/// Renders frames of a scene. Each frame depends on the scene, the options and its number alone, so
/// that they may be rendered in any order and by several threads.
class Simulator {
 public:
  /// \throws std::invalid_argument if the scene has no usable path or an option is out of range.
  Simulator(Scene scene, const SimulationOptions& options);

  const Scene& scene() const { return scene_; }
  const SimulationOptions& options() const { return options_; }
  int frames() const { return static_cast<int>(times_.size()); }
  double duration() const {
    return times_.back() - times_.front();
  }  ///< from first to last frame [s]
  /// Functions of a frame's number \throw std::invalid_argument if there is no such frame.
  /// Whether the body was kidnapped between the frame before and this one.
  bool kidnappedBefore(int index) const;
  Eigen::Isometry3d mapFromBody(int index) const;
  double timestamp(int index) const;
  SimulatedFrame frame(int index) const;

 private:
  void chooseTimes(double available);
  double frameTime(int index) const;  ///< since the first frame [s]
  double pathTime(int index) const;   ///< of the same moment, jumps counted in [s]

  Scene scene_;
  SimulationOptions options_;
  RayTracer tracer_;
  HandPath path_;
  PinholeCamera camera_;
  std::vector<double> times_;  ///< of the frames, from the first on [s]
  double jump_at_ = 0.0;       ///< time of the kidnapping [s]
  double jump_ = 0.0;          ///< path time that it skips [s]
};

}  // namespace opp::mapping
