// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/geometry/point_cloud.h"
#include "opp/graph/plane_graph.h"
#include "opp/primitives/primitives.h"
#include "opp/refinement/refinement_params.h"

namespace opp {

/// Joint refinement of all planes of a scan (Sommer et al. 2020, IV-b, Eq. 8–11).
///
/// Alternates two steps until no plane moves by more than a hundredth of its standard deviation:
/// every sample goes to the nearest plane whose normal it shares, with a robust weight, and adds to
/// that plane's moments; the normals of all families are solved together from the moments. The
/// planes are first fitted alone, on a part of the samples; what their fits say about parallelism
/// and orthogonality is tested (`findStructure`), and what passes is imposed: parallel planes share
/// one normal, two or three mutually orthogonal families form an exact frame (to 1e-12), further
/// orthogonal pairs are drawn together with λ = 1/systematic_angle². Planes that turn out to be one
/// are merged, planes without support dropped, both with their edges.
///
/// Fills planes, families, edges, normal_covariance, labels and converged; lines and corners stay
/// empty. Edges are those of `graph`, and of planes that meet by its rule once refined, that the
/// data support. Planes keep their order in `graph`. An empty cloud or graph gives no planes. Of
/// `sensor` only the noise's correlation is used: how noisy points are, the cloud says. O(samples ×
/// families) per pass; deterministic.
/// \throws std::invalid_argument for parameters out of range, edges that name no node, or vectors
/// of `cloud` of different lengths.
Primitives refinePlanes(const OrientedCloud& cloud, const PlaneGraph& graph,
                        const SensorModel& sensor, const RefinementParams& params);

}  // namespace opp
