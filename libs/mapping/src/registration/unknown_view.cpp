// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/registration/register_scans.h"

#include "registration/free_space.h"

#include <algorithm>

namespace opp::mapping {
namespace {

/// More hidden samples than this share, and the cloud was not seen from the viewpoint alone. Floors
/// that are seen at a grazing angle hide part of themselves in the depth map.
constexpr double kMaxHidden = 0.25;
/// More normals than this share that point away from the viewpoint are not a matter of chance.
constexpr double kMaxAway = 0.9;

double shareHidden(const OrientedCloud& cloud) {
  const DepthMap depth(cloud);
  const auto hidden =
      std::count_if(cloud.points.begin(), cloud.points.end(), [&](const Eigen::Vector3f& p) {
        return (p - depth.viewpoint()).norm() > depth.range(p) + depth.margin(depth.range(p));
      });
  return static_cast<double>(hidden) / static_cast<double>(cloud.size());
}

double shareAway(const PointCloud& cloud) {
  int known = 0, away = 0;
  for (std::size_t i = 0; i < cloud.normals.size(); ++i) {
    const float toward = cloud.normals[i].dot(cloud.viewpoint - cloud.points[i]);
    if (toward > 0.0F || toward < 0.0F) ++known;
    if (toward < 0.0F) ++away;
  }
  return known == 0 ? 0.0 : static_cast<double>(away) / known;
}

}  // namespace

AlignmentInput inputOfUnknownView(const ScanFeatures& scan, const PointCloud& raw) {
  const OrientedCloud& cloud = scan.cloud_in_body;
  const bool seen = cloud.size() == 0 || raw.organized() ||
                    (shareHidden(cloud) <= kMaxHidden && shareAway(raw) <= kMaxAway);
  return seen ? AlignmentInput(scan) : AlignmentInput(scan, {}, false);
}

}  // namespace opp::mapping
