// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/rectangle_scene.h"

#include <algorithm>
#include <cmath>

namespace opp::test {

std::vector<Rectangle> boxFaces(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  std::vector<Rectangle> faces;
  const Eigen::Vector3d size = high - low;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d u = size[(axis + 1) % 3] * Eigen::Vector3d::Unit((axis + 1) % 3);
    const Eigen::Vector3d v = size[(axis + 2) % 3] * Eigen::Vector3d::Unit((axis + 2) % 3);
    faces.push_back({low, u, v});
    faces.push_back({low + size[axis] * Eigen::Vector3d::Unit(axis), u, v});
  }
  return faces;
}

Plane RectangleScene::plane(std::size_t index) const {
  const Rectangle& face = rectangles[index];
  const Plane plane = Plane::fromPointNormal(face.origin, face.u.cross(face.v));
  return plane.signedDistance(viewpoint) < 0.0 ? plane.flipped() : plane;
}

OrientedCloud RectangleScene::sample(Random& random) const {
  OrientedCloud cloud;
  cloud.viewpoint = viewpoint.cast<float>();
  cloud.spacing = spacing;
  for (std::size_t k = 0; k < rectangles.size(); ++k) {
    const Rectangle& face = rectangles[k];
    const Eigen::Vector3d normal = plane(k).normal();
    const int rows = std::max(1, static_cast<int>(face.u.norm() / spacing));
    const int cols = std::max(1, static_cast<int>(face.v.norm() / spacing));
    for (int i = 0; i < rows * cols; ++i) {
      const double s = (i / cols + random.uniform(0.0, 1.0)) / rows;
      const double t = (i % cols + random.uniform(0.0, 1.0)) / cols;
      const double noise = random.normal(1.0) * sigma;
      const Eigen::Vector3d point = face.origin + s * face.u + t * face.v + noise * normal;
      const Eigen::Vector3d tilt = normal +
                                   random.normal(1.0) * normal_sigma * face.u.normalized() +
                                   random.normal(1.0) * normal_sigma * face.v.normalized();
      cloud.points.push_back(point.cast<float>());
      cloud.normals.push_back(tilt.normalized().cast<float>());
      cloud.sigmas.push_back(static_cast<float>(std::max(sigma, 1e-6)));
      cloud.weights.push_back(1.0f);
    }
  }
  return cloud;
}

PlaneGraph RectangleScene::rough(Random& random, double angle, double offset) const {
  PlaneGraph graph;
  for (std::size_t k = 0; k < rectangles.size(); ++k) {
    const Rectangle& face = rectangles[k];
    const Eigen::Vector3d center = face.origin + 0.5 * (face.u + face.v);
    const Eigen::AngleAxisd turn(random.uniform(-angle, angle), random.unitVector());
    const Eigen::Vector3d normal = turn * plane(k).normal();
    PlaneNode node;
    node.plane = Plane::fromPointNormal(center + random.uniform(-offset, offset) * normal, normal);
    graph.nodes.push_back(node);
  }
  for (const std::array<int, 2>& edge : edges) graph.edges.push_back({edge, 1.0});
  return graph;
}

RectangleScene RectangleScene::transformed(const Eigen::Isometry3d& b_from_a) const {
  RectangleScene scene = *this;
  scene.viewpoint = b_from_a * viewpoint;
  for (Rectangle& face : scene.rectangles) {
    face = {b_from_a * face.origin, b_from_a.linear() * face.u, b_from_a.linear() * face.v};
  }
  return scene;
}

RectangleScene boxScene(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  RectangleScene scene;
  scene.rectangles = boxFaces(low, high);
  for (int a = 0; a < 6; ++a) {
    for (int b = a + 1; b < 6; ++b) {
      if (a / 2 != b / 2) scene.edges.push_back({a, b});
    }
  }
  return scene;
}

}  // namespace opp::test
