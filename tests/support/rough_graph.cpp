// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/rough_graph.h"

namespace opp::test {

PlaneGraph roughGraph(const SyntheticScene& scene, double angle, double offset, Random& random) {
  PlaneGraph graph;
  std::vector<PointMoments> moments(scene.planes.size());
  for (std::size_t i = 0; i < scene.cloud.size(); ++i) {
    if (scene.labels[i] < 0) continue;
    moments[static_cast<std::size_t>(scene.labels[i])].add(scene.cloud.points[i].cast<double>());
  }
  for (std::size_t k = 0; k < scene.planes.size(); ++k) {
    const Eigen::AngleAxisd turn(random.uniform(-angle, angle), random.unitVector());
    const Eigen::Vector3d normal = turn * scene.planes[k].normal();
    PlaneNode node;
    node.plane = Plane::fromPointNormal(
        moments[k].mean() + random.uniform(-offset, offset) * normal, normal);
    graph.nodes.push_back(node);
  }
  for (const std::array<int, 2>& edge : scene.edges) graph.edges.push_back({edge, 1.0});
  return graph;
}

}  // namespace opp::test
