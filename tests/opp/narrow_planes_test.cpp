// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/cloud/oriented_cloud.h"

#include "narrow/add_narrow_planes.h"
#include "narrow/grow_planes.h"
#include "narrow/inverse_depth_fit.h"
#include "narrow/open_pixels.h"
#include "support/depth_image.h"
#include "support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace opp {
namespace {

using Eigen::Vector3d;

TEST(InverseDepthFit, FindsThePlaneOfExactPoints) {
  test::Random random(11);
  for (int trial = 0; trial < 100; ++trial) {
    const Vector3d axis = random.unitVector();
    const Vector3d normal = (-axis + 0.8 * random.unitVector()).normalized();
    const Plane plane = Plane::fromPointNormal(random.uniform(0.5, 5.0) * axis, normal);
    const RayFrame frame(axis);
    InverseDepthFit fit;
    for (int k = 0; k < 20; ++k) {
      const Vector3d ray = axis + 0.1 * random.unitVector();
      const Vector3d point = ray * (-plane.d() / plane.normal().dot(ray));
      const RayFrame::Ray seen = frame.of(point.cast<float>());
      EXPECT_LT((frame.meet(seen, frame.coefficientsOf(plane)) - point).norm(), 1e-5);
      fit.add(seen, random.uniform(1.0, 4.0));
    }
    ASSERT_TRUE(fit.solve());
    const Plane found = frame.planeOf(fit.coefficients());
    EXPECT_LT(angleBetween(found, plane), 1e-4);
    EXPECT_NEAR(found.d(), plane.d(), 1e-4);
    EXPECT_LT(fit.misfit(), 1e-9);
  }
}

TEST(InverseDepthFit, AnglesScatterAsItsCovarianceSays) {
  test::Random random(12);
  const SensorModel sensor;
  const Plane plane = Plane::fromPointNormal({2.0, 0.0, 0.0}, Vector3d(-1.0, 0.7, 0.0));
  const RayFrame frame(Vector3d::UnitX());
  const double sigma = sensor.sigma(2.0) / 4.0;  // of the inverse depth, for all
  constexpr int kTrials = 400;
  double squares = 0.0, variance = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    InverseDepthFit fit;
    for (int i = 0; i < 8; ++i) {
      for (int k = 0; k < 60; ++k) {
        RayFrame::Ray ray{0.002 * i, 0.002 * k, 0.0};
        ray.inverse_depth = frame.coefficientsOf(plane).dot(ray.row()) + sigma * random.normal();
        fit.add(ray, 1.0 / (sigma * sigma));
      }
    }
    ASSERT_TRUE(fit.solve());
    const double angle = angleBetween(frame.planeOf(fit.coefficients()), plane);
    squares += angle * angle / kTrials;
    variance += frame.angleVariance(fit.coefficients(), fit.covariance()) / kTrials;
  }
  // The other direction, along which the strip is long, adds little; χ² of 400 trials: ± 7 %.
  EXPECT_NEAR(squares / variance, 1.0, 0.25);
}

TEST(InverseDepthFit, RaysOnALineFixNoPlane) {
  const RayFrame frame(Vector3d::UnitX());
  InverseDepthFit fit;
  EXPECT_FALSE(fit.solve());
  for (int k = 0; k < 10; ++k) fit.add(frame.of({2.0F, 0.0F, 0.0F}), 1.0);
  EXPECT_FALSE(fit.solve());
}

/// A floor and a wall, and before the wall a bar that hangs from above, `width` wide, turned about
/// its own axis.
struct Scene {
  Plane floor = Plane::fromPointNormal({0.0, 0.0, -1.0}, {0.0, 0.0, 1.0});
  Plane wall = Plane::fromPointNormal({2.5, 0.0, 0.0}, {-1.0, 0.0, 0.0});
  std::vector<Plane> bar;

  Scene(double width, double turn) {
    const Eigen::Isometry3d pose =
        Eigen::Translation3d(1.6, 0.2, 0.2) * Eigen::AngleAxisd(turn, Vector3d::UnitZ());
    const Vector3d half(0.5 * width, 0.5 * width, 0.5);
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {-1.0, 1.0}) {
        const Vector3d normal = sign * Vector3d::Unit(axis);
        bar.push_back(transformed(pose, Plane::fromPointNormal(normal.cwiseProduct(half), normal)));
      }
    }
  }

  PointCloud seen() const {
    const test::RangeAlong room = test::insideOf({floor, wall}), box = test::outsideOf(bar);
    return test::renderDepth({}, [&](const Vector3d& ray) {
      const double near = box(ray), far = room(ray);
      return std::isfinite(near) && near > 0.0 && near < far ? near : far;
    });
  }

  PointCloud seenThroughNoise(test::Random& random) const {
    PointCloud cloud = seen();
    test::addRangeNoise(cloud, SensorModel(), random);
    return cloud;
  }

  std::vector<KnownSurface> room() const {
    std::vector<KnownSurface> surfaces;
    const Eigen::Vector3f far = Eigen::Vector3f::Constant(10.0F);
    const PointNoise noise({}, {}, 0.002);
    for (const Plane& plane : {floor, wall}) {
      surfaces.emplace_back(plane, Eigen::AlignedBox3f(-far, far), noise);
    }
    return surfaces;
  }
};

DepthImage imageOf(const PointCloud& cloud, const PrimitiveParams& params) {
  SensorModel sensor = params.sensor;
  sensor.noise_correlation = 0.0;
  return {cloud, sensor, params.sampling};
}

GridPatches gridOf(const PointCloud& cloud, const PrimitiveParams& params) {
  return makeGridPatches(cloud, params.sensor, cloud.size() / 16);
}

TEST(OpenPixels, AreThoseOfWhatIsNotKnown) {
  const PrimitiveParams params;
  test::Random random(13);
  const Scene scene(0.08, 0.6);
  const PointCloud cloud = scene.seenThroughNoise(random);
  const DepthImage image = imageOf(cloud, params);
  const auto open = openPixels(image, gridOf(cloud, params), scene.room(), params.narrow);
  double hidden = 0.0, bar = 0.0, wrong = 0.0, others = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const bool on_bar = cloud.points[i].x() < 2.0F && cloud.points[i].z() > -0.4F;
    (on_bar ? bar : others) += 1.0;
    if (on_bar && open[i] == 0) hidden += 1.0;
    if (!on_bar && open[i] != 0) wrong += 1.0;
  }
  EXPECT_GT(bar, 10000.0);
  EXPECT_LT(hidden / bar, 0.01);
  // One of 80 cells of four pixels, and single pixels of the blocks that were looked at.
  EXPECT_LT(wrong / others, 0.03);
}

TEST(OpenPixels, MeansTellWhatIsWithinTheNoiseOfEachPixel) {
  // A board of 1.5 standard deviations before a wall, as wide as the image is high.
  const PrimitiveParams params;
  test::Random random(14);
  const double thick = 1.5 * params.sensor.sigma(2.5);
  const Scene scene(0.05, 0.0);
  PointCloud cloud = test::renderDepth({}, [&](const Vector3d& ray) {
    const double range = 2.5 / ray.x();
    return std::abs(range * ray.y()) < 0.3 ? (2.5 - thick) / ray.x() : range;
  });
  test::addRangeNoise(cloud, params.sensor, random);
  const auto open =
      openPixels(imageOf(cloud, params), gridOf(cloud, params), {scene.room()[1]}, params.narrow);
  double board = 0.0, found = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (std::abs(cloud.points[i].y()) > 0.28F) continue;
    board += 1.0;
    found += open[i] != 0 ? 1.0 : 0.0;
  }
  // Of single pixels 16 % were: they are 2.5 − 1.5 standard deviations from being so.
  EXPECT_GT(found / board, 0.4);
}

TEST(OpenPixels, NothingIsOpenWhereNothingWasMeasured) {
  PrimitiveParams params;
  PointCloud cloud = Scene(0.08, 0.6).seen();
  for (Eigen::Vector3f& point : cloud.points) point.setConstant(std::nanf(""));
  const DepthImage image = imageOf(cloud, params);
  const auto open = openPixels(image, gridOf(cloud, params), {}, params.narrow);
  EXPECT_EQ(std::count(open.begin(), open.end(), 0), static_cast<std::ptrdiff_t>(cloud.size()));
}

std::vector<PixelPlane> planesIn(const PointCloud& cloud, const std::vector<KnownSurface>& known,
                                 const PrimitiveParams& params) {
  const DepthImage image = imageOf(cloud, params);
  return growPlanes(image, openPixels(image, gridOf(cloud, params), known, params.narrow), known,
                    {params.narrow, params.sampling.max_incidence, params.refinement.max_turn,
                     params.refinement.test_sigmas});
}

TEST(GrowPlanes, FindsTheSidesOfABar) {
  // 5 to 8 cm at 1.6 m: sides of 8 to 22 pixels.
  const PrimitiveParams params;
  test::Random random(15);
  constexpr int kScans = 30;
  int found = 0;
  for (int scan = 0; scan < kScans; ++scan) {
    const Scene scene(random.uniform(0.05, 0.08), random.uniform(0.6, 1.0));
    const PointCloud cloud = scene.seenThroughNoise(random);
    const auto planes = planesIn(cloud, scene.room(), params);
    EXPECT_LE(planes.size(), 2U) << "scan " << scan;
    for (const PixelPlane& plane : planes) {
      const Vector3d middle(1.6, 0.2, 0.2);
      const bool is_side = std::any_of(scene.bar.begin(), scene.bar.end(), [&](const Plane& side) {
        return angleBetween(plane.plane, side) < degToRad(5.0) &&
               std::abs(plane.plane.signedDistance(side.project(middle))) < 0.003;
      });
      EXPECT_TRUE(is_side) << "scan " << scan;
      found += is_side ? 1 : 0;
      EXPECT_TRUE(std::is_sorted(plane.pixels.begin(), plane.pixels.end()));
    }
  }
  EXPECT_GE(found, 2 * kScans * 9 / 10) << "of two sides each";
}

TEST(GrowPlanes, FacesThatMeetAtAFoldAreTwo) {
  // A frame 2 cm behind a door, which is known, and the side of the cabinet; neither is yet known,
  // and grown to cells on it each goes on around the fold.
  const PrimitiveParams params;
  test::Random random(20);
  const PointNoise noise({}, {}, 0.002);
  constexpr int kScans = 20;
  int found = 0;
  for (int scan = 0; scan < kScans; ++scan) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(random.uniform(0.5, 0.9), Vector3d::UnitZ()).toRotationMatrix();
    const Vector3d corner(1.2, 0.0, 0.0);
    const double width = random.uniform(0.03, 0.05);
    const Plane front = Plane::fromPointNormal(corner, -turn.col(0));
    const Plane side = Plane::fromPointNormal(corner, turn.col(1));
    const Plane door = Plane::fromPointNormal(corner - 0.02 * turn.col(0), -turn.col(0));
    const test::RangeAlong cabinet = test::outsideOf({front, side});
    PointCloud cloud = test::renderDepth({}, [&](const Vector3d& ray) {
      const double on_door = test::insideOf({door})(ray);
      const double across = turn.col(1).dot(corner - on_door * ray);
      const double range = cabinet(ray);
      const bool is_seen = std::abs(range * ray.z()) < 0.25 && range < 1.6;
      return across > width ? on_door : is_seen ? range : 3.0 / ray.x();
    });
    test::addRangeNoise(cloud, params.sensor, random);
    const Eigen::Vector3f far = Eigen::Vector3f::Constant(10.0F);
    const std::vector<KnownSurface> known{
        {door, {-far, far}, noise},
        {Plane::fromPointNormal({3.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}), {-far, far}, noise}};
    for (const PixelPlane& plane : planesIn(cloud, known, params)) {
      for (const Plane& face : {front, side}) {
        if (angleBetween(plane.plane, face) > degToRad(3.0)) continue;
        found += std::abs(plane.plane.d() - face.d()) < 0.005 ? 1 : 0;
      }
    }
  }
  EXPECT_GE(found, 2 * kScans * 3 / 4) << "of two faces each";
}

TEST(GrowPlanes, APipeHasNoWideOne) {
  const PrimitiveParams params;
  test::Random random(16);
  const Scene scene(0.05, 0.0);
  for (int scan = 0; scan < 10; ++scan) {
    const double radius = random.uniform(0.03, 0.06);
    const test::RangeAlong room = test::insideOf({scene.floor, scene.wall});
    PointCloud cloud = test::renderDepth({}, [&](const Vector3d& ray) {
      // |r (x, y) − (1, 0)|² = radius², the pipe upright at 1 m
      const double a = ray.head<2>().squaredNorm(), b = ray.x();
      const double root = b * b - a * (1.0 - radius * radius);
      return root < 0.0 ? room(ray) : (b - std::sqrt(root)) / a;
    });
    test::addRangeNoise(cloud, params.sensor, random);
    for (const PixelPlane& plane : planesIn(cloud, scene.room(), params)) {
      // Facets that noise does not tell from planes are narrow ones.
      EXPECT_LT(plane.pixels.size(), 6000U) << "radius " << radius;
    }
  }
}

TEST(GrowPlanes, NoiseHasNone) {
  const PrimitiveParams params;
  test::Random random(17);
  PointCloud cloud = Scene(0.05, 0.0).seen();
  for (Eigen::Vector3f& point : cloud.points) {
    point *= static_cast<float>(random.uniform(0.5, 3.0)) / point.norm();
  }
  EXPECT_TRUE(planesIn(cloud, {}, params).empty());
}

/// Samples and graph as the stages before would leave them; both may be empty.
struct Input {
  OrientedCloud samples;
  PlaneGraph graph;

  explicit Input(const Scene& scene) {
    samples.spacing = 0.03;
    samples.noise_correlation = 0.0;
    add({2.5F, 1.0F, 0.5F}, scene.wall);
    for (const Plane& plane : {scene.floor, scene.wall}) {
      PlaneNode node;
      node.plane = plane;
      node.spacing = 0.03;
      for (const double x : {-1.0, 1.0}) {
        for (const double y : {-1.0, 1.0}) {
          const Eigen::Matrix<double, 3, 2> tangents = tangentBasis(plane.normal());
          node.moments.add(plane.project(Vector3d(2.0, 0, 0)) + tangents * Eigen::Vector2d(x, y));
        }
      }
      graph.nodes.push_back(node);
    }
    graph.edges.push_back({{0, 1}, 7.0});
  }

  void add(const Eigen::Vector3f& point, const Plane& plane) {
    samples.points.push_back(point);
    samples.normals.emplace_back(plane.normal().cast<float>());
    samples.sigmas.push_back(0.005F);
    samples.weights.push_back(16.0F);
    samples.extents.push_back(0.02F);
    samples.patch_extents.push_back(0.02F);
  }
};

TEST(AddNarrowPlanes, SamplesAndNodesFollowThoseThatWere) {
  const PrimitiveParams params;
  test::Random random(18);
  const Scene scene(0.06, 0.8);
  const PointCloud cloud = scene.seenThroughNoise(random);
  Input input(scene);
  const Eigen::Vector3f first = input.samples.points[0];
  addNarrowPlanes(cloud, gridOf(cloud, params), params, input.samples, input.graph);
  ASSERT_EQ(input.graph.nodes.size(), 4U);
  ASSERT_EQ(input.graph.edges.size(), 1U);
  EXPECT_EQ(input.graph.edges[0].planes, (std::array<int, 2>{0, 1}));
  const OrientedCloud& samples = input.samples;
  EXPECT_EQ(samples.points[0], first);
  EXPECT_EQ(samples.narrow_samples, samples.size() - 1);
  EXPECT_EQ(samples.normals.size(), samples.size());
  EXPECT_EQ(samples.sigmas.size(), samples.size());
  EXPECT_EQ(samples.weights.size(), samples.size());
  EXPECT_EQ(samples.extents.size(), samples.size());
  EXPECT_EQ(samples.patch_extents.size(), samples.size());
  for (std::size_t k = 2; k < 4; ++k) {
    const PlaneNode& node = input.graph.nodes[k];
    EXPECT_TRUE(std::any_of(scene.bar.begin(), scene.bar.end(), [&](const Plane& side) {
      return angleBetween(node.plane, side) < degToRad(3.0);
    }));
    EXPECT_GT(node.moments.weight(), 0.0);
    EXPECT_TRUE(node.reach.contains(node.moments.mean().cast<float>()));
  }
}

TEST(AddNarrowPlanes, TakesThePlaceOfAPlaneThatItsRimsTurned) {
  const PrimitiveParams params;
  test::Random random(19);
  const Scene scene(0.06, 0.8);
  const PointCloud cloud = scene.seenThroughNoise(random);
  Input input(scene);
  // A side of the bar as patches of 2 cm see it, 8° off.
  const auto side = std::max_element(
      scene.bar.begin(), scene.bar.end(),
      [](const Plane& a, const Plane& b) { return -a.normal().x() < -b.normal().x(); });
  const Vector3d middle = side->project(Vector3d(1.6, 0.2, 0.2));
  PlaneNode node;
  node.plane = Plane::fromPointNormal(
      middle, Eigen::AngleAxisd(degToRad(8.0), Vector3d::UnitZ()) * side->normal());
  node.spacing = 0.02;
  const Vector3d across = node.plane.normal().cross(Vector3d::UnitZ()).normalized();
  for (const double up : {-0.3, 0.0, 0.3}) {
    for (const double along : {-0.02, 0.0, 0.02}) {
      const Vector3d point = middle + up * Vector3d::UnitZ() + along * across;
      node.moments.add(point);
      input.add(point.cast<float>(), node.plane);
    }
  }
  input.graph.nodes.push_back(node);
  input.graph.edges.push_back({{1, 2}, 3.0});
  addNarrowPlanes(cloud, gridOf(cloud, params), params, input.samples, input.graph);
  ASSERT_EQ(input.graph.nodes.size(), 4U);
  EXPECT_EQ(input.graph.edges.size(), 1U) << "that of the plane which is gone is gone, too";
  for (std::size_t k = 2; k < 4; ++k) {
    EXPECT_GT(angleBetween(input.graph.nodes[k].plane, node.plane), degToRad(5.0));
  }
  // The samples on it were those of patches astride of its edges.
  EXPECT_LT(input.samples.size() - input.samples.narrow_samples, 10U);
}

TEST(AddNarrowPlanes, OnlyInDepthImages) {
  const PrimitiveParams params;
  const Scene scene(0.06, 0.8);
  PointCloud cloud = scene.seen();
  Input input(scene);
  PointCloud turning = cloud;
  turning.columns_wrap = true;
  addNarrowPlanes(turning, gridOf(turning, params), params, input.samples, input.graph);
  cloud.rows = cloud.cols = 0;
  addNarrowPlanes(cloud, {}, params, input.samples, input.graph);
  addNarrowPlanes({}, {}, params, input.samples, input.graph);
  EXPECT_EQ(makeScanSurface(cloud, params.sensor, params.sampling).grid, nullptr);
  EXPECT_EQ(input.graph.nodes.size(), 2U);
  EXPECT_EQ(input.samples.size(), 1U);
}

}  // namespace
}  // namespace opp
