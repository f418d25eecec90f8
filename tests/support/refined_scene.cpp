// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/refined_scene.h"

#include "opp/primitives/find_corners.h"
#include "opp/primitives/find_lines.h"
#include "opp/refinement/refine_planes.h"

#include "support/rough_graph.h"

namespace opp::test {

RefinementParams undistortedSensor() {
  RefinementParams params;
  params.systematic_angle = 0.0;
  // Thousands of relations are tested over all scenes; 3 sigmas would deny some by chance.
  params.test_sigmas = 5.0;
  return params;
}

Rectangles boxFromAllSides(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                           const Eigen::Vector3d& viewpoint) {
  Rectangles sides = boxSides(low, high);
  for (Rectangle& side : sides) {
    if (side.plane().signedDistance(viewpoint) < 0.0) side.half_u = -side.half_u;
  }
  return sides;
}

Primitives refinedScene(const SyntheticScene& scene, Random& random) {
  Primitives result = refinePlanes(scene.cloud, roughGraph(scene, 0.03, 0.02, random),
                                   SensorModel(), undistortedSensor());
  result.corners = findCorners(scene.cloud, result, CornerParams());
  result.lines = findLines(scene.cloud, result, LineParams());
  return result;
}

}  // namespace opp::test
