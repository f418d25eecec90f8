// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "registration/free_space.h"

#include <algorithm>
#include <cmath>

namespace opp::mapping {
namespace {

/// Bins along the side of a face: 1.2–2° each.
constexpr int kSide = 60;
/// A surface in front of another one is in conflict with it only if it is nearer by more spacings
/// than the depth map's blur.
constexpr float kBlurSpacings = 2.0F;
/// And by more than this share of the range: a bin of the depth map is about 0.03 rad wide, and
/// surfaces may be seen at a grazing angle.
constexpr float kBlurRatio = 0.05F;

struct CubePoint {
  int face;
  float u, v;  ///< in bins
};

CubePoint project(const Eigen::Vector3f& ray) {
  int axis = 0;
  const float largest = ray.cwiseAbs().maxCoeff(&axis);
  const float scale = 0.5F * kSide / largest;
  return {2 * axis + (ray[axis] > 0.0F ? 1 : 0), ray[(axis + 1) % 3] * scale + 0.5F * kSide,
          ray[(axis + 2) % 3] * scale + 0.5F * kSide};
}

int clampBin(float bin) { return std::clamp(static_cast<int>(bin), 0, kSide - 1); }

std::size_t indexOf(int face, int u, int v) {
  return static_cast<std::size_t>((face * kSide + u) * kSide + v);
}

}  // namespace

DepthMap::DepthMap(const OrientedCloud& cloud)
    : viewpoint_(cloud.viewpoint), spacing_(cloud.spacing), ranges_(6 * kSide * kSide, 0.0F) {
  for (const Eigen::Vector3f& point : cloud.points) {
    const Eigen::Vector3f ray = point - viewpoint_;
    const float distance = ray.norm();
    if (distance > 0.0F) cover(ray, static_cast<float>(cloud.spacing) / distance);
  }
}

void DepthMap::cover(const Eigen::Vector3f& ray, float angular_radius) {
  // The disc of a sample does not wrap around the edges of a face: bins there stay a little less
  // covered. Half a bin per radian of the face's middle is at most half the density of its edge.
  const CubePoint at = project(ray);
  const float radius = std::min(0.5F * kSide * angular_radius, 0.25F * kSide);
  const float distance = ray.norm();
  for (int u = clampBin(at.u - radius); u <= clampBin(at.u + radius); ++u) {
    for (int v = clampBin(at.v - radius); v <= clampBin(at.v + radius); ++v) {
      float& nearest = ranges_[indexOf(at.face, u, v)];
      nearest = nearest > 0.0F ? std::min(nearest, distance) : distance;
    }
  }
}

float DepthMap::range(const Eigen::Vector3f& point) const {
  const Eigen::Vector3f ray = point - viewpoint_;
  if (!(ray.squaredNorm() > 0.0F)) return 0.0F;
  const CubePoint at = project(ray);
  return ranges_[indexOf(at.face, clampBin(at.u), clampBin(at.v))];
}

float DepthMap::margin(float range) const {
  return kBlurSpacings * static_cast<float>(spacing_) + kBlurRatio * range;
}

FreeSpace::FreeSpace(const std::vector<ScanView>& views) {
  for (const ScanView& view : views) {
    views_.push_back({view.features_from_view.inverse().cast<float>(), DepthMap(*view.cloud)});
  }
}

bool FreeSpace::contains(const Eigen::Vector3f& point, float slack) const {
  return std::any_of(views_.begin(), views_.end(), [&](const View& view) {
    const Eigen::Vector3f in_view = view.view_from_features * point;
    const float surface = view.depth.range(in_view);
    return (in_view - view.depth.viewpoint()).norm() < surface - view.depth.margin(surface) - slack;
  });
}

}  // namespace opp::mapping
