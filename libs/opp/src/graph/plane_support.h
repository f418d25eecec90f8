// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"
#include "opp/geometry/point_cloud.h"
#include "opp/graph/graph_params.h"
#include "opp/graph/plane_graph.h"

#include <vector>

namespace opp {

/// Largest connected patch of a plane's samples.
struct SupportPatch {
  double samples = 0.0;
  double width = 0.0;  ///< of the rectangle with the same least second moment, in mean extents
};

/// What a plane needs: less in clouds with detail, where small planes have patches for samples.
SupportPatch leastSupport(const OrientedCloud& cloud, const GraphParams& params);

/// Mean extent of some samples [m]; 0 if there are none.
double meanExtent(const OrientedCloud& cloud, const std::vector<int>& samples);

/// Samples are connected if they lie in neighbouring cells (8-neighbourhood) of a grid of twice
/// their mean extent. O(n log n).
SupportPatch largestPatch(const OrientedCloud& cloud, const Plane& plane,
                          const std::vector<int>& samples);

/// A plane and its samples, as an edge sees them.
struct EdgeSide {
  const Plane& plane;
  const std::vector<int>& samples;
  double spacing;  ///< mean extent of the samples [m]
};

/// Length of the stretches of the planes' common line along which both have samples within `reach`
/// (in extents of their samples) of it, in extents of the wider spaced ones. Zero for parallel
/// planes.
double commonEdgeLength(const OrientedCloud& cloud, const EdgeSide& a, const EdgeSide& b,
                        double reach);

/// Whether the planes are orthogonal and meet where there are samples. O(samples of both), and of
/// planes that are not orthogonal O(1).
bool meet(const OrientedCloud& cloud, const EdgeSide& a, const EdgeSide& b,
          const MeetingRule& rule);

}  // namespace opp
