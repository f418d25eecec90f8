// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "registration/scan_model.h"

#include <Eigen/Geometry>

#include <vector>

namespace opp::mapping {

/// A rotation that turns directions of the source's planes to directions of the target's.
struct RotationCandidate {
  Eigen::Matrix3d target_from_source = Eigen::Matrix3d::Identity();
  double area = 0.0;  ///< of plane directions that coincide [m²]
};

/// Distinct rotations by which at least two non-parallel directions of planes coincide, those with
/// most area first. Empty if all planes of a scan are parallel.
std::vector<RotationCandidate> rotationCandidates(const ScanModel& target, const ScanModel& source,
                                                  const GlobalAlignmentParams& params);

/// Translations that go with a rotation, most support first: coinciding corners, offsets of
/// parallel planes along three axes, and even steps along an axis that no plane of both scans
/// fixes.
std::vector<Eigen::Vector3d> translationCandidates(const ScanModel& target, const ScanModel& source,
                                                   const Eigen::Matrix3d& target_from_source,
                                                   const GlobalAlignmentParams& params);

/// Could these be the same corner, if the source were turned by `target_from_source`? The planes'
/// normals have to pair up and the kinds must not contradict.
bool compatibleCorners(const ScanModel& target, const Corner& target_corner,
                       const ScanModel& source, const Corner& source_corner,
                       const Eigen::Matrix3d& target_from_source,
                       const GlobalAlignmentParams& params);

}  // namespace opp::mapping
