// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/hand_path.h"

#include "opp/geometry/constants.h"
#include "opp/mapping/simulation/seeded_random.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace opp::mapping {
namespace {

constexpr int kStepsPerSegment = 256;  ///< of the time table; its error is far below the unrest's
constexpr double kMetresPerRadian = 1.0;  ///< weighs turning against walking between way-points
constexpr double kSmoothingTime = 0.8;    ///< [s] in which speed adapts

double wrapped(double angle) { return std::remainder(angle, 2.0 * kPi); }

double stepLength(const Eigen::Matrix<double, 5, 1>& step) {
  return std::hypot(step.head<3>().norm(), kMetresPerRadian * step.tail<2>().norm());
}

/// Mean over a window of `half` entries on both sides.
std::vector<double> smoothed(const std::vector<double>& values, std::size_t half) {
  std::vector<double> sums(values.size() + 1, 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) sums[i + 1] = sums[i] + values[i];
  std::vector<double> result(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t first = i > half ? i - half : 0;
    const std::size_t last = std::min(values.size(), i + half + 1);
    result[i] = (sums[last] - sums[first]) / static_cast<double>(last - first);
  }
  return result;
}

}  // namespace

HandPath::HandPath(std::vector<Waypoint> waypoints, const HandMotion& motion, std::uint64_t seed)
    : motion_(motion), seed_(seed) {
  validate(motion);
  for (const Waypoint& waypoint : waypoints) {
    Knot knot;
    knot << waypoint.position, waypoint.yaw, waypoint.pitch;
    if (!knot.allFinite()) throw std::invalid_argument("path: a way-point is not finite");
    if (!knots_.empty()) {
      knot[3] = knots_.back()[3] + wrapped(knot[3] - knots_.back()[3]);  // the shorter way round
      if (stepLength(knot - knots_.back()) < 1e-9) continue;
    }
    knots_.push_back(knot);
  }
  if (knots_.size() < 2) throw std::invalid_argument("path: needs two different way-points");
  knots_.insert(knots_.begin(), 2.0 * knots_[0] - knots_[1]);
  knots_.push_back(2.0 * knots_.back() - knots_[knots_.size() - 2]);
  parameters_.push_back(0.0);
  for (std::size_t i = 1; i < knots_.size(); ++i) {
    parameters_.push_back(parameters_.back() + std::sqrt(stepLength(knots_[i] - knots_[i - 1])));
  }
  buildTimeTable();
}

bool HandPath::closed() const {
  Knot gap = knots_[knots_.size() - 2] - knots_[1];
  gap[3] = wrapped(gap[3]);
  return stepLength(gap) < 1e-6;
}

/// Barry & Goldman's pyramid of linear interpolations.
HandPath::Knot HandPath::pointAt(double parameter) const {
  const auto& t = parameters_;
  const auto after = std::upper_bound(t.begin() + 2, t.end() - 2, parameter);
  const auto i = static_cast<std::size_t>(after - t.begin()) - 2;  // segment i + 1 … i + 2
  const auto mix = [&](const Knot& a, const Knot& b, std::size_t from, std::size_t to) -> Knot {
    const double s = (parameter - t[from]) / (t[to] - t[from]);
    return (1.0 - s) * a + s * b;
  };
  const Knot a1 = mix(knots_[i], knots_[i + 1], i, i + 1);
  const Knot a2 = mix(knots_[i + 1], knots_[i + 2], i + 1, i + 2);
  const Knot a3 = mix(knots_[i + 2], knots_[i + 3], i + 2, i + 3);
  return mix(mix(a1, a2, i, i + 2), mix(a2, a3, i + 1, i + 3), i + 1, i + 2);
}

void HandPath::buildTimeTable() {
  const double begin = parameters_[1], end = parameters_[parameters_.size() - 2];
  const std::size_t steps = kStepsPerSegment * (knots_.size() - 3);
  std::vector<double> durations(steps);
  Knot previous = pointAt(begin);
  for (std::size_t i = 0; i < steps; ++i) {
    const double s = static_cast<double>(i + 1) / static_cast<double>(steps);
    const Knot next = pointAt(begin + s * (end - begin));
    durations[i] = std::max((next - previous).head<3>().norm() / motion_.speed,
                            (next - previous).tail<2>().norm() / motion_.turn_rate);
    previous = next;
  }
  double total = 0.0;
  for (const double duration : durations) total += duration;
  const auto half =
      static_cast<std::size_t>(0.5 * kSmoothingTime / total * static_cast<double>(steps));
  times_.assign(1, 0.0);
  for (const double duration : smoothed(durations, half))
    times_.push_back(times_.back() + duration);
}

Eigen::Isometry3d HandPath::mapFromBody(double time) const {
  const double within = time <= duration() ? std::max(0.0, time) : std::fmod(time, duration());
  const auto after = std::upper_bound(times_.begin() + 1, times_.end() - 1, within);
  const auto i = static_cast<std::size_t>(after - times_.begin()) - 1;
  const double s = (static_cast<double>(i) + (within - times_[i]) / (times_[i + 1] - times_[i])) /
                   static_cast<double>(times_.size() - 1);
  const double begin = parameters_[1], end = parameters_[parameters_.size() - 2];
  const Knot knot = pointAt(begin + s * (end - begin));
  Eigen::Isometry3d map_from_body = Eigen::Isometry3d::Identity();
  map_from_body.translation() = knot.head<3>();
  map_from_body.linear() = (Eigen::AngleAxisd(knot[3], Eigen::Vector3d::UnitZ()) *
                            Eigen::AngleAxisd(knot[4], Eigen::Vector3d::UnitY()))
                               .toRotationMatrix();
  return map_from_body * unrest(time);
}

/// Three sines for each of the six axes; frequencies and phases follow from the seed.
Eigen::Isometry3d HandPath::unrest(double time) const {
  Eigen::Matrix<double, 6, 1> offset = Eigen::Matrix<double, 6, 1>::Zero();
  for (int axis = 0; axis < 6; ++axis) {
    SeededRandom random(seed_, 0x68616E64U, static_cast<std::uint64_t>(axis));  // "hand"
    for (int k = 0; k < 3; ++k) {
      const double frequency = 0.3 + 1.7 * random.uniform();  // [Hz]
      offset[axis] += std::sin(2.0 * kPi * (frequency * time + random.uniform())) / 3.0;
    }
  }
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.translation() = motion_.jitter_position * offset.head<3>();
  const Eigen::Vector3d turn = motion_.jitter_angle * offset.tail<3>();
  result.linear() = (Eigen::AngleAxisd(turn.z(), Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(turn.y(), Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(turn.x(), Eigen::Vector3d::UnitX()))
                        .toRotationMatrix();
  return result;
}

}  // namespace opp::mapping
