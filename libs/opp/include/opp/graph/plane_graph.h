// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"
#include "opp/geometry/point_moments.h"
#include "opp/primitives/primitives.h"

#include <Eigen/Geometry>

#include <limits>
#include <vector>

namespace opp {

/// A vertex of the plane graph before refinement.
struct PlaneNode {
  Plane plane;           ///< n points to the viewpoint's side
  PointMoments moments;  ///< of the samples that support it, weights 1/σ² [1/m²]
  double votes = 0.0;    ///< coplanar and orthogonal votes of the reference points merged into it
  Eigen::AlignedBox3f reach;  ///< where its samples can be; empty: anywhere
  double spacing = 0.0;       ///< mean extent of its samples [m]
};

/// When two orthogonal planes meet. The default never says so.
struct MeetingRule {
  double orthogonality = 0.0;  ///< [rad] largest deviation from a right angle
  double reach = 0.0;          ///< samples are beside the common line within so many extents
  double min_length = std::numeric_limits<double>::infinity();  ///< of the line, in extents
};

/// Planes and their orthogonality, as voting and clustering give them (Sommer et al. 2020, III-c).
/// Nodes without an edge are lone planes.
struct PlaneGraph {
  std::vector<PlaneNode> nodes;
  std::vector<OrthogonalityEdge>
      edges;            ///< indices into nodes; each pair at most once, in ascending order
  MeetingRule meeting;  ///< what makes an edge: planes that move may come to meet
};

}  // namespace opp
