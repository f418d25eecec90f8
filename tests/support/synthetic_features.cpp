// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/synthetic_features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace opp::test {
namespace {

constexpr double kParallel = 1e-9;
/// Samples this many spacings from a corner decide which of its quarter-planes are occupied.
constexpr double kCornerReach = 6.0;
constexpr double kCornerSigma = 1e-3;

Eigen::Vector3d sample(const SyntheticScene& scene, std::size_t i) {
  return scene.cloud.points[i].cast<double>();
}

std::vector<PlanePrimitive> planesOf(const SyntheticScene& scene) {
  std::vector<PlanePrimitive> planes(scene.planes.size());
  for (std::size_t i = 0; i < scene.labels.size(); ++i) {
    if (scene.labels[i] < 0) continue;
    PlanePrimitive& plane = planes[static_cast<std::size_t>(scene.labels[i])];
    const double sigma = scene.cloud.sigmas[i];
    plane.moments.add(sample(scene, i), 1.0 / (sigma * sigma));
    ++plane.support;
  }
  for (std::size_t p = 0; p < planes.size(); ++p) {
    planes[p].plane = scene.planes[p];
    planes[p].area = planes[p].support * scene.cloud.spacing * scene.cloud.spacing;
    if (!planes[p].moments.empty()) {
      planes[p].covariance = planeCovariance(planes[p].plane, planes[p].moments);
    }
  }
  return planes;
}

void addFamilies(Primitives& primitives) {
  for (std::size_t p = 0; p < primitives.planes.size(); ++p) {
    const Eigen::Vector3d& normal = primitives.planes[p].plane.normal();
    std::size_t f = 0;
    while (f < primitives.families.size() &&
           primitives.families[f].normal.cross(normal).norm() > kParallel) {
      ++f;
    }
    if (f == primitives.families.size()) primitives.families.push_back({normal, {}});
    primitives.families[f].planes.push_back(static_cast<int>(p));
    primitives.planes[p].family = static_cast<int>(f);
  }
}

/// Interval of the common line of two planes where both have samples within two spacings of it.
void addLine(const SyntheticScene& scene, const std::array<int, 2>& edge, Primitives& primitives) {
  const Plane& a = scene.planes[static_cast<std::size_t>(edge[0])];
  const Plane& b = scene.planes[static_cast<std::size_t>(edge[1])];
  const Eigen::Vector3d direction = a.normal().cross(b.normal());
  const Eigen::Vector3d base = -a.d() * a.normal() - b.d() * b.normal();
  std::array<double, 2> low, high;
  low.fill(std::numeric_limits<double>::max());
  high.fill(std::numeric_limits<double>::lowest());
  for (std::size_t i = 0; i < scene.labels.size(); ++i) {
    const auto side = std::find(edge.begin(), edge.end(), scene.labels[i]) - edge.begin();
    const Eigen::Vector3d x = sample(scene, i);
    if (side == 2 ||
        std::hypot(a.signedDistance(x), b.signedDistance(x)) > 2.0 * scene.cloud.spacing) {
      continue;
    }
    const auto k = static_cast<std::size_t>(side);
    low[k] = std::min(low[k], direction.dot(x));
    high[k] = std::max(high[k], direction.dot(x));
  }
  const double start = std::max(low[0], low[1]), end = std::min(high[0], high[1]);
  if (end - start < 2.0 * scene.cloud.spacing) return;
  primitives.lines.push_back(
      {edge, base + start * direction, base + end * direction, LineKind::kUnknown});
}

/// Bits of the quarter-planes of the corner that have samples; 0 if one of its planes has none.
std::uint16_t signatureOf(const SyntheticScene& scene, const Corner& corner) {
  std::uint16_t signature = 0;
  std::array<bool, 3> seen{};
  for (std::size_t i = 0; i < scene.labels.size(); ++i) {
    const auto found = std::find(corner.planes.begin(), corner.planes.end(), scene.labels[i]);
    const Eigen::Vector3d x =
        corner.cloud_from_corner.transpose() * (sample(scene, i) - corner.position);
    if (found == corner.planes.end() || x.norm() > kCornerReach * scene.cloud.spacing) continue;
    const auto k = static_cast<int>(found - corner.planes.begin());
    const int quadrant = 2 * (x[(k + 2) % 3] > 0.0 ? 1 : 0) + (x[(k + 1) % 3] > 0.0 ? 1 : 0);
    signature = static_cast<std::uint16_t>(signature | (1 << (4 * k + quadrant)));
    seen[static_cast<std::size_t>(k)] = true;
  }
  return seen[0] && seen[1] && seen[2] ? signature : std::uint16_t{0};
}

void addCorner(const SyntheticScene& scene, const std::array<int, 3>& planes,
               Primitives& primitives) {
  Corner corner;
  corner.planes = planes;
  Eigen::Vector3d offsets;
  for (int k = 0; k < 3; ++k) {
    const Plane& plane =
        scene.planes[static_cast<std::size_t>(planes[static_cast<std::size_t>(k)])];
    corner.cloud_from_corner.col(k) = plane.normal();
    offsets[k] = plane.d();
  }
  corner.position = -corner.cloud_from_corner * offsets;
  if (corner.cloud_from_corner.determinant() < 0.0) corner.cloud_from_corner.col(2) *= -1.0;
  corner.signature = signatureOf(scene, corner);
  if (corner.signature == 0) return;
  const Eigen::Vector3d view = corner.cloud_from_corner.transpose() *
                               (scene.cloud.viewpoint.cast<double>() - corner.position);
  for (int k = 0; k < 3; ++k) {
    if (view[k] > 0.0)
      corner.view_octant = static_cast<std::uint8_t>(corner.view_octant | (1 << k));
  }
  corner.covariance = kCornerSigma * kCornerSigma * Eigen::Matrix3d::Identity();
  primitives.corners.push_back(corner);
}

}  // namespace

Primitives truePrimitives(const SyntheticScene& scene) {
  Primitives primitives;
  primitives.planes = planesOf(scene);
  primitives.labels = scene.labels;
  addFamilies(primitives);
  const std::set<std::array<int, 2>> edges(scene.edges.begin(), scene.edges.end());
  for (const std::array<int, 2>& edge : edges) {
    primitives.edges.push_back({edge, 1.0});
    addLine(scene, edge, primitives);
    for (int c = edge[1] + 1; c < static_cast<int>(scene.planes.size()); ++c) {
      if (edges.count({edge[0], c}) == 0 || edges.count({edge[1], c}) == 0) continue;
      addCorner(scene, {edge[0], edge[1], c}, primitives);
    }
  }
  return primitives;
}

mapping::ScanFeatures trueFeatures(const SyntheticScene& scene) {
  mapping::ScanFeatures features;
  features.cloud_in_body = scene.cloud;
  features.primitives_in_body = truePrimitives(scene);
  return features;
}

mapping::ScanFeatures scanOfScene(const Rectangles& scene, int step,
                                  const Eigen::Isometry3d& scene_from_body, double sigma) {
  SyntheticOptions options;
  options.spacing = 0.08;
  options.sigma = sigma;
  options.seed = static_cast<std::uint64_t>(step);
  mapping::ScanFeatures scan = trueFeatures(
      sampleScene(scene, scene_from_body.translation(), scene_from_body.inverse(), options));
  scan.timestamp = kTimeStep * step;
  return scan;
}

mapping::ScanFeatures scanOfRoom(std::uint64_t room, int step,
                                 const Eigen::Isometry3d& scene_from_body, double sigma) {
  return scanOfScene(furnishedRoom(room), step, scene_from_body, sigma);
}

Eigen::Isometry3d poseOnCircle(int step) {
  const double phase = 0.06 * step;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(0.5 * std::cos(phase) - 0.5, 0.5 * std::sin(phase), 1.2);
  pose.linear() = Eigen::AngleAxisd(phase, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

}  // namespace opp::test
