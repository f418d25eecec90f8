// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/simulator.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace opp::mapping {

SimulatedSensor simulatedSensorFromName(std::string_view name) {
  if (name == "kinect") return SimulatedSensor::kKinect;
  if (name == "ideal") return SimulatedSensor::kIdeal;
  if (name == "lidar16") return SimulatedSensor::kLidar16;
  if (name == "lidar64") return SimulatedSensor::kLidar64;
  throw std::invalid_argument("unknown sensor '" + std::string(name) +
                              "'; known: kinect, ideal, lidar16, lidar64");
}

Simulator::Simulator(Scene scene, const SimulationOptions& options)
    : scene_(std::move(scene)),
      options_(options),
      tracer_(scene_.world),
      path_(scene_.waypoints, scene_.motion, options.seed),
      camera_(PinholeCamera().decimated(options.decimation)) {
  if (options.frames < 0) throw std::invalid_argument("frames must not be negative");
  if (options.passes < 1) throw std::invalid_argument("passes must be at least 1");
  if (options.passes > 1 && !path_.closed()) {
    throw std::invalid_argument("more than one pass needs a path that ends where it starts");
  }
  if (!(options.rate >= 0.0 && options.rate <= 1e4)) {
    throw std::invalid_argument("rate must be from 0 to 10000 Hz");
  }
  const double available = options.passes * path_.duration();
  frames_ = options.frames > 0 ? options.frames : scene_.frames * options.passes;
  if (options.rate > 0.0) {
    const int most = 1 + static_cast<int>(std::floor(available * options.rate));
    frames_ = options.frames > 0 ? std::min(options.frames, most) : most;
    duration_ = (frames_ - 1) / options.rate;
  } else {
    // On a closed path the frame after the last one would be the first again.
    const int intervals = std::max(1, path_.closed() ? frames_ : frames_ - 1);
    duration_ = available * (frames_ - 1) / intervals;
  }
}

double Simulator::pathTime(int index) const {
  if (index < 0 || index >= frames_) throw std::invalid_argument("no frame of this number");
  return frames_ > 1 ? duration_ * index / (frames_ - 1) : 0.0;
}

double Simulator::timestamp(int index) const {
  return std::round((options_.start_time + pathTime(index)) * 1e6) * 1e-6;
}

Eigen::Isometry3d Simulator::mapFromBody(int index) const {
  return path_.mapFromBody(pathTime(index));
}

SimulatedFrame Simulator::frame(int index) const {
  SimulatedFrame frame{timestamp(index), mapFromBody(index), {}};
  const Eigen::Isometry3d map_from_sensor = frame.map_from_body * options_.body_from_sensor;
  const auto stream = static_cast<std::uint64_t>(index);
  switch (options_.sensor) {
    case SimulatedSensor::kKinect:
      frame.data = renderKinect(tracer_, map_from_sensor, camera_, {}, options_.seed, stream);
      break;
    case SimulatedSensor::kIdeal:
      frame.data = renderIdeal(tracer_, map_from_sensor, camera_, options_.ideal_range_unit);
      break;
    case SimulatedSensor::kLidar16:
      frame.data = sweep(tracer_, map_from_sensor, LidarModel::vlp16(), options_.seed, stream);
      break;
    case SimulatedSensor::kLidar64:
      frame.data = sweep(tracer_, map_from_sensor, LidarModel::os1_64(), options_.seed, stream);
      break;
  }
  return frame;
}

}  // namespace opp::mapping
