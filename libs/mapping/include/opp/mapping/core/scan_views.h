// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/planar/plane_extent.h"
#include "opp/primitives/primitives.h"

#include <vector>

namespace opp::mapping {

/// A plane as scans that are no keyframes saw it, in the body frame of the keyframe they follow.
struct PlaneView {
  /// The keyframe's plane primitive that it is; −1: none, as long as it is not adopted.
  int keyframe_plane = -1;
  bool is_own = false;  ///< the keyframe saw it, too
  PlanePrimitive seen;  ///< what all these scans saw of it; no family, no covariance
  /// Where: cells of the raster on this plane, see `rasterOf`; ascending, unique.
  Plane raster_plane;
  std::vector<PlaneCell> support;
  std::vector<double> timestamps;  ///< of the scans [s], in the order of time
};

/// A corner as the same scans saw it, in the same frame.
struct CornerView {
  Corner seen;                     ///< plane indices are of ScanViews::planes
  std::vector<double> timestamps;  ///< of the scans [s], in the order of time
};

/// What the scans that follow a keyframe, up to the next, saw.
struct ScanViews {
  bool adopted = false;  ///< all are among the keyframe's primitives, see `adoptViews`
  std::vector<PlaneView> planes;
  std::vector<OrthogonalityEdge> edges;  ///< plane indices are of `planes`; each pair once
  std::vector<LineSegment> lines;        ///< plane indices are of `planes`
  /// Each triple of planes once; once adopted, the last of the keyframe's corners.
  std::vector<CornerView> corners;
};

/// Raster of a view; u is not chosen, so that the plane alone says where a cell is.
inline PlaneFrame rasterOf(const Plane& plane) {
  return {plane, Eigen::Vector3d(tangentBasis(plane.normal()).col(0))};
}

}  // namespace opp::mapping
