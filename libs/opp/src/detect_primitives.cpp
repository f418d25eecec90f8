// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/detect_primitives.h"

#include "opp/detection/detect_opps.h"
#include "opp/graph/build_plane_graph.h"
#include "opp/primitives/find_corners.h"
#include "opp/primitives/find_lines.h"
#include "opp/refinement/refine_planes.h"

#include "narrow/add_narrow_planes.h"
#include "primitives/stopwatch.h"

namespace opp {
namespace {

/// All stages after clustering. `stopwatch` ran since the beginning of the last; fills `laps`.
Primitives primitivesOf(const OrientedCloud& cloud, const PlaneGraph& graph,
                        const PrimitiveParams& params, Stopwatch stopwatch, StageTimings& laps) {
  Primitives primitives = refinePlanes(cloud, graph, params.sensor, params.refinement);
  laps.refinement = stopwatch.lap();
  primitives.corners = findCorners(cloud, primitives, params.corners);
  laps.corners = stopwatch.lap();
  primitives.lines = findLines(cloud, primitives, params.lines);
  laps.lines = stopwatch.lap();
  return primitives;
}

}  // namespace

Primitives detectPrimitives(const PointCloud& cloud, ScanSurface& surface,
                            const PrimitiveParams& params, int threads, StageTimings* timings) {
  StageTimings unwanted;
  StageTimings& laps = timings == nullptr ? unwanted : *timings;
  Stopwatch stopwatch;
  // Voting splits samples: the surface holds others afterwards.
  const OppHypotheses hypotheses = detectOpps(surface, params.sensor, params.voting, threads);
  laps.voting = stopwatch.lap();
  PlaneGraph graph = buildPlaneGraph(surface.samples, hypotheses, params.sensor, params.graph);
  laps.clustering = stopwatch.lap();
  if (surface.grid) addNarrowPlanes(cloud, *surface.grid, params, surface.samples, graph);
  laps.narrow = stopwatch.lap();
  return primitivesOf(surface.samples, graph, params, stopwatch, laps);
}

Primitives detectPrimitives(const OrientedCloud& cloud, const PrimitiveParams& params, int threads,
                            StageTimings* timings) {
  StageTimings unwanted;
  StageTimings& laps = timings == nullptr ? unwanted : *timings;
  Stopwatch stopwatch;
  const OppHypotheses hypotheses = detectOpps(cloud, params.sensor, params.voting, threads);
  laps.voting = stopwatch.lap();
  const PlaneGraph graph = buildPlaneGraph(cloud, hypotheses, params.sensor, params.graph);
  laps.clustering = stopwatch.lap();
  return primitivesOf(cloud, graph, params, stopwatch, laps);
}

}  // namespace opp
