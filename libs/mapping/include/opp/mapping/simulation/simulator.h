// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/simulation/depth_camera.h"
#include "opp/mapping/simulation/lidar.h"
#include "opp/mapping/simulation/scene.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <string_view>
#include <variant>

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
  int frames() const { return frames_; }
  double duration() const { return duration_; }  ///< from first to last frame [s]
  Eigen::Isometry3d mapFromBody(int index) const;
  double timestamp(int index) const;
  SimulatedFrame frame(int index) const;

 private:
  double pathTime(int index) const;

  Scene scene_;
  SimulationOptions options_;
  RayTracer tracer_;
  HandPath path_;
  PinholeCamera camera_;
  int frames_ = 0;
  double duration_ = 0.0;
};

}  // namespace opp::mapping
