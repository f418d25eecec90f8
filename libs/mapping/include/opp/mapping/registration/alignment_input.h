// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/scan_features.h"

#include <Eigen/Geometry>

#include <vector>

namespace opp::mapping {

/// What was seen from one place. Between there and each of its samples is free space.
struct ScanView {
  const OrientedCloud* cloud = nullptr;  ///< in the view's frame; must outlive the view
  Eigen::Isometry3d features_from_view = Eigen::Isometry3d::Identity();
};

/// One side of an alignment: a scan, or several scans merged in one frame.
struct AlignmentInput {
  /// A scan that was taken from `scan.cloud_in_body.viewpoint`.
  AlignmentInput(const ScanFeatures& scan)  // NOLINT(google-explicit-constructor): a scan is one
      : features(&scan), views{{&scan.cloud_in_body, Eigen::Isometry3d::Identity()}} {}
  /// \param seen_from empty: nothing is known of free space
  /// \param knows_sides false: the sign of normals tells nothing
  AlignmentInput(const ScanFeatures& merged, std::vector<ScanView> seen_from, bool knows_sides)
      : features(&merged), views(std::move(seen_from)), sided(knows_sides) {}

  const ScanFeatures* features;  ///< must outlive the input
  std::vector<ScanView> views;   ///< where its samples were seen from
  bool sided = true;             ///< normals point to the side from which surfaces were seen
};

}  // namespace opp::mapping
