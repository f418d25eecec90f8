// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "frontend/landmark_support.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace opp::mapping {
namespace {

using Index = std::size_t;

/// Standard deviation of the samples along a direction [m].
double extent(const PointMoments& moments, const Eigen::Vector3d& direction) {
  return std::sqrt(direction.dot(moments.scatter() * direction) / moments.weight());
}

/// Variance of the distance from `point` to a plane that was fitted to the moments [m²].
double varianceAt(const Eigen::Vector3d& point, const PointMoments& moments, const Plane& plane) {
  const Eigen::Matrix<double, 3, 2> tangents = tangentBasis(plane.normal());
  const Eigen::Vector2d lever = tangents.transpose() * (point - moments.mean());
  const Eigen::Matrix2d known = tangents.transpose() * moments.scatter() * tangents;
  return 1.0 / moments.weight() + lever.dot(known.ldlt().solve(lever));
}

Plane ownPlane(const LandmarkSupport& part, const Plane& near) {
  return part.moments.fitPlane(part.moments.mean() + near.normal());
}

double ownError(const LandmarkSupport& part, const Plane& near) {
  return part.moments.squaredError(ownPlane(part, near));
}

/// More noise than expected makes everything less certain. \param apart sum of their own errors
double unexpectedNoise(const LandmarkSupport& a, const LandmarkSupport& b, double apart) {
  return std::max(1.0, apart / (a.effective_samples + b.effective_samples));
}

}  // namespace

void LandmarkSupport::merge(const LandmarkSupport& other) {
  const double weight = moments.weight() + other.moments.weight();
  mean_range = (mean_range * moments.weight() + other.mean_range * other.moments.weight()) / weight;
  moments.merge(other.moments);
  effective_samples += other.effective_samples;
  keyframes.insert(other.keyframes.begin(), other.keyframes.end());
}

LandmarkSupport supportOf(const PlaneFactor& factor, const MapState& map) {
  const Keyframe& keyframe = map.keyframes[Index(factor.keyframe)];
  return {transformed(keyframe.map_from_body, factor.moments_in_body),
          factor.effective_samples,
          factor.moments_in_body.mean().norm(),
          {factor.keyframe}};
}

std::vector<LandmarkSupport> supportsOf(const MapState& map) {
  std::vector<LandmarkSupport> supports(map.landmarks.planes.size());
  for (const PlaneFactor& factor : map.factors.planes) {
    if (!factor.moments_in_body.empty())
      supports[Index(factor.landmark)].merge(supportOf(factor, map));
  }
  return supports;
}

bool touch(const LandmarkSupport& a, const LandmarkSupport& b) {
  // An even patch reaches √3 standard deviations from its centre; a quarter more allows for what
  // occlusion leaves out between them.
  constexpr double kReach = 1.25 * 1.7320508;
  const Eigen::Vector3d between = b.moments.mean() - a.moments.mean();
  const double distance = between.norm();
  if (distance < 1e-9) return true;
  const Eigen::Vector3d direction = between / distance;
  return distance <= kReach * (extent(a.moments, direction) + extent(b.moments, direction));
}

bool fits(const LandmarkSupport& part, const Plane& common, double gate_sigmas) {
  return part.moments.squaredError(common) <= gate_sigmas * gate_sigmas * part.effective_samples;
}

bool explains(const Plane& plane, const LandmarkSupport& part, const SensorModel& sensor,
              double gate_sigmas) {
  const double distortion = sensor.distortion(part.mean_range);
  return part.moments.squaredError(plane) <=
         gate_sigmas * gate_sigmas *
             (part.effective_samples + distortion * distortion * part.moments.weight());
}

bool fitsDistorted(const LandmarkSupport& part, const Plane& own, const Plane& common,
                   const SensorModel& sensor, double gate_sigmas) {
  const double bend = gate_sigmas * sensor.distortion(part.mean_range);
  const double tilt = gate_sigmas * sensor.distortionSlope(part.mean_range);
  return part.moments.squaredError(common) - part.moments.squaredError(own) <=
             bend * bend * part.moments.weight() &&
         own.normal().dot(common.normal()) >= std::cos(std::min(tilt, 1.0));
}

bool faceAlike(const Plane& a, const Plane& b) {
  constexpr double kSameSide = 0.87;  // cos 30°
  return a.normal().dot(b.normal()) >= kSameSide;
}

double commonPlaneExcess(const LandmarkSupport& a, const LandmarkSupport& b, const Plane& common) {
  constexpr double kPossibleExcess = 16.27;  // of the three numbers of a plane
  const double apart = ownError(a, common) + ownError(b, common);
  const double together = a.moments.squaredError(common) + b.moments.squaredError(common);
  return (together - apart) / (kPossibleExcess * unexpectedNoise(a, b, apart));
}

double oneSurfaceExcess(const Plane& plane_a, const LandmarkSupport& a, const Plane& plane_b,
                        const LandmarkSupport& b) {
  if (!faceAlike(plane_a, plane_b) || !touch(a, b)) return std::numeric_limits<double>::infinity();
  PointMoments joint = a.moments;
  joint.merge(b.moments);
  return commonPlaneExcess(a, b, joint.fitPlane(joint.mean() + plane_a.normal()));
}

bool coplanar(const LandmarkSupport& a, const LandmarkSupport& b, const Plane& common,
              double resolution) {
  double farthest = 0.0;
  for (const auto& [part, other] : {std::pair{&a, &b}, std::pair{&b, &a}}) {
    farthest = std::max(farthest,
                        varianceAt(other->moments.mean(), part->moments, ownPlane(*part, common)));
  }
  const double noise = unexpectedNoise(a, b, ownError(a, common) + ownError(b, common));
  return commonPlaneExcess(a, b, common) <= 1.0 && farthest * noise <= resolution * resolution;
}

bool seenTogether(const LandmarkSupport& a, const LandmarkSupport& b) {
  return std::any_of(a.keyframes.begin(), a.keyframes.end(),
                     [&](int keyframe) { return b.keyframes.count(keyframe) > 0; });
}

}  // namespace opp::mapping
