// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/detection/detect_opps.h"
#include "opp/geometry/point_cloud.h"
#include "opp/graph/graph_params.h"
#include "opp/graph/plane_graph.h"

namespace opp {

/// Clusters hypotheses into planes and their orthogonality graph (Sommer et al. 2020, III-c).
/// Union-find on the mutual distance of anchors and planes gathers hypotheses; all samples are then
/// given to the nearest plane (distance and normal), planes are fitted to their samples' moments,
/// and two planes become one only if the samples of both stay within the noise of the common plane:
/// parallel surfaces are never chained. Planes without a connected patch of samples are dropped.
/// An edge needs orthogonal planes with samples of both along their common line; it carries the
/// orthogonal votes of the pair.
///
/// Nodes come in descending order of support. Empty without hypotheses. Signs of normals do not
/// matter. O(hypotheses × planes + samples × planes).
/// \throws std::invalid_argument if a parameter is out of range.
PlaneGraph buildPlaneGraph(const OrientedCloud& cloud, const OppHypotheses& hypotheses,
                           const SensorModel& sensor, const GraphParams& params);

}  // namespace opp
