// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/simulator.h"

#include "opp/mapping/simulation/seeded_random.h"

#include <algorithm>
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

namespace {

/// The way of a robot through the same way-points.
void makePlanar(Scene& scene) {
  for (Waypoint& waypoint : scene.waypoints) {
    waypoint.position.z() = 0.0;
    waypoint.pitch = 0.0;
  }
  scene.motion.jitter_position = 0.0;
  scene.motion.jitter_angle = 0.0;
}

Scene prepared(Scene scene, const SimulationOptions& options) {
  if (options.planar) makePlanar(scene);
  return scene;
}

void requireValid(const SimulationOptions& options, bool closed) {
  if (options.frames < 0) throw std::invalid_argument("frames must not be negative");
  if (options.passes < 1) throw std::invalid_argument("passes must be at least 1");
  if (options.passes > 1 && !closed) {
    throw std::invalid_argument("more than one pass needs a path that ends where it starts");
  }
  if (!(options.rate >= 0.0 && options.rate <= 1e4)) {
    throw std::invalid_argument("rate must be from 0 to 10000 Hz");
  }
  if (!(options.drop_rate >= 0.0 && options.drop_rate < 1.0)) {
    throw std::invalid_argument("drop rate must be at least 0 and less than 1");
  }
  if (!options.kidnap) return;
  const auto [from, to] = *options.kidnap;
  if (!(from > 0.0 && from < to && to < 1.0)) {
    throw std::invalid_argument("kidnapping needs two shares of the way, 0 < from < to < 1");
  }
}

}  // namespace

Simulator::Simulator(Scene scene, const SimulationOptions& options)
    : scene_(prepared(std::move(scene), options)),
      options_(options),
      tracer_(scene_.world),
      path_(scene_.waypoints, scene_.motion, options.seed),
      camera_(PinholeCamera().decimated(options.decimation)) {
  requireValid(options, path_.closed());
  double available = options.passes * path_.duration();
  if (options.kidnap) {
    jump_at_ = (*options.kidnap)[0] * available;
    jump_ = ((*options.kidnap)[1] - (*options.kidnap)[0]) * available;
    available -= jump_;
  }
  chooseTimes(available);
}

void Simulator::chooseTimes(double available) {
  int count = options_.frames > 0 ? options_.frames : scene_.frames * options_.passes;
  double step = 0.0;
  if (options_.rate > 0.0) {
    const int most = 1 + static_cast<int>(std::floor(available * options_.rate));
    count = options_.frames > 0 ? std::min(options_.frames, most) : most;
    step = 1.0 / options_.rate;
  } else {
    // On a closed path the frame after the last one would be the first again.
    step = available / std::max(1, path_.closed() ? count : count - 1);
  }
  constexpr std::uint64_t kStream = 0x64726F70;  // "drop": not a frame's number
  for (int i = 0; i < count; ++i) {
    SeededRandom random(options_.seed, kStream, static_cast<std::uint64_t>(i));
    const bool lost = random.uniform() < options_.drop_rate;
    if (i == 0 || !lost) times_.push_back(step * i);
  }
}

double Simulator::frameTime(int index) const {
  if (index < 0 || index >= frames()) throw std::invalid_argument("no frame of this number");
  return times_[static_cast<std::size_t>(index)];
}

double Simulator::pathTime(int index) const {
  const double time = frameTime(index);
  return jump_ > 0.0 && time > jump_at_ ? time + jump_ : time;
}

bool Simulator::kidnappedBefore(int index) const {
  return jump_ > 0.0 && index > 0 && frameTime(index) > jump_at_ &&
         frameTime(index - 1) <= jump_at_;
}

double Simulator::timestamp(int index) const {
  return std::round((options_.start_time + frameTime(index)) * 1e6) * 1e-6;
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
