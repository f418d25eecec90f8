// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/synthetic_room.h"

#include "support/random.h"

#include <algorithm>
#include <cmath>

namespace opp::test {
namespace {

/// Samples in the scene's frame, before the truth is made up.
struct Samples {
  std::vector<Eigen::Vector3d> points, normals;
  std::vector<int> rectangles;
};

/// Does the open segment from `eye` to `x` pass through the rectangle (1 % of slack at x, so that a
/// surface does not hide itself)?
bool hides(const Rectangle& rectangle, const Eigen::Vector3d& eye, const Eigen::Vector3d& x) {
  const Plane plane = rectangle.plane();
  const double at_eye = plane.signedDistance(eye), at_x = plane.signedDistance(x);
  if (at_eye * at_x >= 0.0) return false;
  const double t = at_eye / (at_eye - at_x);
  if (t > 0.99) return false;
  const Eigen::Vector3d hit = eye + t * (x - eye) - rectangle.center;
  return std::abs(hit.dot(rectangle.half_u)) <= rectangle.half_u.squaredNorm() &&
         std::abs(hit.dot(rectangle.half_v)) <= rectangle.half_v.squaredNorm();
}

bool visible(const Rectangles& rectangles, const Eigen::Vector3d& eye, const Eigen::Vector3d& x) {
  return std::none_of(rectangles.begin(), rectangles.end(),
                      [&](const Rectangle& rectangle) { return hides(rectangle, eye, x); });
}

Eigen::Vector3d noisyNormal(const Eigen::Vector3d& normal, double sigma, Random& random) {
  const double a = random.normal(), b = random.normal();
  return (normal + sigma * tangentBasis(normal) * Eigen::Vector2d(a, b)).normalized();
}

void addRectangle(const Rectangles& rectangles, int index, const Eigen::Vector3d& eye,
                  const SyntheticOptions& options, Random& random, Samples& samples) {
  const Rectangle& rectangle = rectangles[static_cast<std::size_t>(index)];
  const Plane plane = rectangle.plane();
  if (plane.signedDistance(eye) <= 0.0) return;
  const auto steps = [&](const Eigen::Vector3d& half) {
    return std::max(1, static_cast<int>(std::lround(2.0 * half.norm() / options.spacing)));
  };
  const int nu = steps(rectangle.half_u), nv = steps(rectangle.half_v);
  for (int i = 0; i < nu; ++i) {
    for (int j = 0; j < nv; ++j) {
      // Jittered grid: even, but without a lattice's exact repetitions.
      const double u = 2.0 * (i + random.uniform(0.2, 0.8)) / nu - 1.0;
      const double v = 2.0 * (j + random.uniform(0.2, 0.8)) / nv - 1.0;
      const Eigen::Vector3d x = rectangle.center + u * rectangle.half_u + v * rectangle.half_v;
      const Eigen::Vector3d noisy = x + random.normal() * options.sigma * plane.normal();
      const Eigen::Vector3d normal = noisyNormal(plane.normal(), options.normal_sigma, random);
      if (options.occlusion && !visible(rectangles, eye, x)) continue;
      samples.points.push_back(noisy);
      samples.normals.push_back(normal);
      samples.rectangles.push_back(index);
    }
  }
}

void addOutliers(double ratio, Random& random, Samples& samples) {
  if (samples.points.empty()) return;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& x : samples.points) box.extend(x);
  const auto count = static_cast<int>(ratio * static_cast<double>(samples.points.size()));
  for (int k = 0; k < count; ++k) {
    const Eigen::Vector3d in_unit_cube = random.vector(1.0);
    samples.points.push_back(box.center() + 0.5 * box.sizes().cwiseProduct(in_unit_cube));
    samples.normals.push_back(random.unitVector());
    samples.rectangles.push_back(-1);
  }
}

bool samePlane(const Plane& a, const Plane& b) {
  return (a.coefficients() - b.coefficients()).norm() < 1e-9;
}

/// Fills planes, counts and labels of the scene; planes are still in the scene's frame.
void addTruth(const Rectangles& rectangles, const Samples& samples, int min_samples,
              SyntheticScene& scene) {
  std::vector<Plane> planes;
  std::vector<int> plane_of(rectangles.size()), counts, index;
  for (std::size_t r = 0; r < rectangles.size(); ++r) {
    const Plane plane = rectangles[r].plane();
    const auto found = std::find_if(planes.begin(), planes.end(),
                                    [&](const Plane& other) { return samePlane(plane, other); });
    plane_of[r] = static_cast<int>(found - planes.begin());
    if (found == planes.end()) planes.push_back(plane);
  }
  counts.resize(planes.size());
  for (const int r : samples.rectangles) {
    if (r >= 0) ++counts[static_cast<std::size_t>(plane_of[static_cast<std::size_t>(r)])];
  }
  for (std::size_t p = 0; p < planes.size(); ++p) {
    index.push_back(counts[p] < min_samples ? -1 : static_cast<int>(scene.planes.size()));
    if (index[p] < 0) continue;
    scene.planes.push_back(planes[p]);
    scene.counts.push_back(counts[p]);
  }
  for (const int r : samples.rectangles) {
    scene.labels.push_back(
        r < 0 ? -1 : index[static_cast<std::size_t>(plane_of[static_cast<std::size_t>(r)])]);
  }
}

/// Do samples of planes a and b come closer to each other than `reach`?
bool touch(const SyntheticScene& scene, int a, int b, double reach) {
  std::vector<Eigen::Vector3d> near_b;
  const auto point = [&](std::size_t i) { return scene.cloud.points[i].cast<double>(); };
  for (std::size_t i = 0; i < scene.labels.size(); ++i) {
    const Plane& plane_b = scene.planes[static_cast<std::size_t>(b)];
    if (scene.labels[i] == a && std::abs(plane_b.signedDistance(point(i))) < reach) {
      near_b.push_back(point(i));
    }
  }
  for (std::size_t i = 0; i < scene.labels.size(); ++i) {
    const Plane& plane_a = scene.planes[static_cast<std::size_t>(a)];
    if (scene.labels[i] != b || std::abs(plane_a.signedDistance(point(i))) >= reach) continue;
    for (const Eigen::Vector3d& x : near_b) {
      if ((x - point(i)).norm() < reach) return true;
    }
  }
  return false;
}

void addEdges(double reach, SyntheticScene& scene) {
  const int count = static_cast<int>(scene.planes.size());
  for (int a = 0; a < count; ++a) {
    for (int b = a + 1; b < count; ++b) {
      const double cosine = scene.planes[static_cast<std::size_t>(a)].normal().dot(
          scene.planes[static_cast<std::size_t>(b)].normal());
      if (std::abs(cosine) < 1e-9 && touch(scene, a, b, reach)) scene.edges.push_back({a, b});
    }
  }
}

Rectangles cuboid(const Eigen::Vector3d& low, const Eigen::Vector3d& high, double outward) {
  const Eigen::Vector3d center = 0.5 * (low + high), half = 0.5 * (high - low);
  Rectangles sides;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      Rectangle side{center, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
      side.center[axis] += sign * half[axis];
      side.half_u[u] = sign * outward * half[u];
      side.half_v[v] = half[v];
      sides.push_back(side);
    }
  }
  return sides;
}

}  // namespace

Rectangles roomSides(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return cuboid(low, high, -1.0);
}

Rectangles boxSides(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return cuboid(low, high, 1.0);
}

Rectangles furnishedRoom(std::uint64_t seed) {
  Random random(seed);
  const double x = random.uniform(2.2, 2.8), y = random.uniform(1.8, 2.2);
  const double height = random.uniform(2.3, 2.7);
  Rectangles all = roomSides({-x, -y, 0.0}, {x, y, height});
  const auto add = [&all](const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    const Rectangles sides = boxSides(low, high);
    all.insert(all.end(), sides.begin(), sides.end());
  };
  const double depth = random.uniform(0.4, 0.6), top = random.uniform(1.4, 2.0);
  const double left = random.uniform(-x + 0.3, -0.8);
  add({left, y - depth, 0.0}, {left + random.uniform(0.7, 1.2), y, top});
  const double front = random.uniform(0.3, x - 1.2), desk = random.uniform(0.7, 0.8);
  add({front, -y, desk - 0.04}, {front + 0.8, -y + 1.5, desk});
  add({front, -y, 0.0}, {front + 0.8, -y + 0.04, desk - 0.04});
  add({front, -y + 1.46, 0.0}, {front + 0.8, -y + 1.5, desk - 0.04});
  return all;
}

SyntheticScene sampleScene(const Rectangles& rectangles, const Eigen::Vector3d& viewpoint,
                           const Eigen::Isometry3d& cloud_from_scene,
                           const SyntheticOptions& options) {
  Random random(options.seed);
  Samples samples;
  for (std::size_t r = 0; r < rectangles.size(); ++r) {
    addRectangle(rectangles, static_cast<int>(r), viewpoint, options, random, samples);
  }
  addOutliers(options.outlier_ratio, random, samples);
  SyntheticScene scene;
  addTruth(rectangles, samples, options.min_plane_samples, scene);
  for (Plane& plane : scene.planes) plane = transformed(cloud_from_scene, plane);
  scene.cloud.viewpoint = (cloud_from_scene * viewpoint).cast<float>();
  scene.cloud.spacing = options.spacing;
  const std::size_t count = samples.points.size();
  // A sensor without noise does not exist: 0.1 mm keeps thresholds and weights finite.
  scene.cloud.sigmas.assign(count, static_cast<float>(std::max(options.sigma, 1e-4)));
  scene.cloud.weights.assign(count, 1.0F);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d& normal = samples.normals[i];
    const bool away = normal.dot(viewpoint - samples.points[i]) < 0.0;
    const bool flip = options.flip_normals ? random.integer(0, 1) == 1 : away;
    scene.cloud.points.push_back((cloud_from_scene * samples.points[i]).cast<float>());
    scene.cloud.normals.push_back(
        (cloud_from_scene.linear() * (flip ? -normal : normal)).cast<float>());
  }
  addEdges(2.5 * options.spacing, scene);
  return scene;
}

}  // namespace opp::test
