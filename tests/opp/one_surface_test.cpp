// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "graph/one_surface.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <functional>

namespace opp {
namespace {

constexpr double kSigma = 0.002;
constexpr double kAlike = 0.1;

/// Samples 2 cm apart of a rectangle in x and y, at heights z(x, y).
PointMoments samplesOf(double left, double right, double low, double high,
                       const std::function<double(double, double)>& z) {
  constexpr double kSpacing = 0.02;
  PointMoments moments;
  for (double x = left + 0.5 * kSpacing; x < right; x += kSpacing) {
    for (double y = low + 0.5 * kSpacing; y < high; y += kSpacing) {
      moments.add({x, y, z(x, y)}, 1.0 / (kSigma * kSigma));
    }
  }
  return moments;
}

bool areOneSurface(const PointMoments& a, const PointMoments& b) {
  const Eigen::Vector3d viewpoint(0.0, 0.0, 2.0);
  PointMoments both = a;
  both.merge(b);
  return isOneSurface(both.fitPlane(viewpoint), {a, a.fitPlane(viewpoint)},
                      {b, b.fitPlane(viewpoint)}, kAlike);
}

TEST(IsOneSurface, OfTwoHeightsSideBySideIsWrongHoweverWellASlantFits) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    test::Random random(seed);
    // A step s between two squares: the slant through both leaves s/4 (root mean square), 1.25 σ.
    const double step = 5.0 * kSigma;
    const auto low = [&](double, double) { return random.normal(kSigma); };
    const auto high = [&](double, double) { return step + random.normal(kSigma); };
    EXPECT_FALSE(
        areOneSurface(samplesOf(0.0, 0.2, 0.0, 0.2, low), samplesOf(0.2, 0.4, 0.0, 0.2, high)))
        << seed;
  }
}

TEST(IsOneSurface, OfPiecesSideBySideIsRight) {
  int one = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    test::Random random(seed);
    const auto flat = [&](double, double) { return random.normal(kSigma); };
    const double cut = random.uniform(0.1, 0.3);
    one += areOneSurface(samplesOf(0.0, cut, 0.0, 0.2, flat), samplesOf(cut, 0.4, 0.0, 0.2, flat));
  }
  EXPECT_EQ(one, 100);  // by chance alone it would be wrong once in 370
}

TEST(IsOneSurface, OfHalvesThatNoiseCutIsRight) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    test::Random random(seed);
    PointMoments upper, lower;
    for (int k = 0; k < 400; ++k) {
      const Eigen::Vector3d point(random.uniform(0.0, 0.4), random.uniform(0.0, 0.2),
                                  random.normal(kSigma));
      (point.z() > 0.0 ? upper : lower).add(point, 1.0 / (kSigma * kSigma));
    }
    EXPECT_TRUE(areOneSurface(upper, lower)) << seed;
  }
}

TEST(IsOneSurface, OfLayersUponEachOtherIsWrong) {
  const auto lower =
      samplesOf(0.0, 0.2, 0.0, 0.2, [](double x, double) { return x < 0.1 ? kSigma : -kSigma; });
  const auto upper = samplesOf(0.0, 0.2, 0.0, 0.2, [](double x, double) {
    return 8.0 * kSigma + (x < 0.1 ? kSigma : -kSigma);
  });
  EXPECT_FALSE(areOneSurface(lower, upper));
}

TEST(SideBySide, MeansThatEvenRectanglesDoNotOverlap) {
  const auto flat = [](double, double) { return 0.0; };
  const Plane plane = Plane::fromPointNormal({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  const PointMoments a = samplesOf(0.0, 0.2, 0.0, 0.4, flat);
  const PointMoments beside = samplesOf(0.22, 0.4, 0.0, 0.4, flat);
  const PointMoments over = samplesOf(0.1, 0.4, 0.0, 0.4, flat);
  EXPECT_TRUE(sideBySide({a, plane}, {beside, plane}));
  EXPECT_FALSE(sideBySide({a, plane}, {over, plane}));
  EXPECT_FALSE(sideBySide({a, plane}, {a, plane}));  // no direction from mean to mean
}

TEST(SideBySide, HoldsForSinglePointsApart) {
  const Plane plane = Plane::fromPointNormal({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  PointMoments a, b;
  a.add({0.0, 0.0, 0.0});
  b.add({0.1, 0.0, 0.0});
  EXPECT_TRUE(sideBySide({a, plane}, {b, plane}));
}

}  // namespace
}  // namespace opp
