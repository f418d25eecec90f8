// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/same_surface.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace opp {
namespace {

constexpr double kExtent = 0.05;
constexpr double kSigma = 0.0025;

/// Two planes about x = 3.4 m, seen from the origin, and their samples.
class TwoPieces {
 public:
  /// Adds a square grid of samples over y in [left, right) and z in [low, high) of plane `label`.
  void add(int label, double left, double right, double low, double high,
           const std::function<double(double y, double z)>& x, double extent = kExtent) {
    const auto columns = std::lround((right - left) / extent);
    const auto rows = std::lround((high - low) / extent);
    for (long row = 0; row < rows; ++row) {
      for (long column = 0; column < columns; ++column) {
        const double y = left + (static_cast<double>(column) + 0.5) * extent;
        const double z = low + (static_cast<double>(row) + 0.5) * extent;
        const double area = extent * extent;
        samples_.push_back(
            {{x(y, z), y, z}, -Eigen::Vector3d::UnitX(), kSigma * kSigma, area, area});
        labels_.push_back(label);
      }
    }
  }

  bool areOneSurface() const {
    std::vector<PlaneFit> fits(2);
    for (std::size_t k = 0; k < 2; ++k) {
      fits[k].sums.origin = {3.4, 0.0, 0.0};
      for (std::size_t i = 0; i < samples_.size(); ++i) {
        if (labels_[i] == static_cast<int>(k)) fits[k].sums.add(samples_[i], 0.0, 0.0, 0.0);
      }
      fits[k].moments = fits[k].sums.moments();
      fits[k].plane = fits[k].moments.fitPlane(Eigen::Vector3d::Zero());
    }
    const SensorModel sensor;
    const RefinementParams params;
    return SameSurface(fits, samples_, labels_, Eigen::Vector3d::Zero(), sensor, params)(0, 1);
  }

 private:
  std::vector<WeightedSample> samples_;
  std::vector<int> labels_;
};

TEST(SameSurface, IsABentWallCutInTwo) {
  for (int trial = 0; trial < 50; ++trial) {
    test::Random random(static_cast<std::uint64_t>(trial));
    // A bow of 2 to 4 cm on 2.4 m; distortion is 23 mm (one standard deviation) at 3.4 m.
    const double bow = random.uniform(0.02, 0.04);
    const auto bent = [&](double y, double) {
      return 3.4 + bow * (y / 1.2) * (y / 1.2) + random.normal(kSigma);
    };
    TwoPieces pieces;
    pieces.add(0, -1.2, 0.3, -1.0, 1.0, bent);
    pieces.add(1, 0.3, 1.2, -1.0, 1.0, bent);
    EXPECT_TRUE(pieces.areOneSurface()) << trial;
  }
}

TEST(SameSurface, IsNoLayerBesideAnother) {
  for (int trial = 0; trial < 50; ++trial) {
    test::Random random(static_cast<std::uint64_t>(trial));
    const double step = random.uniform(0.025, 0.04);
    TwoPieces pieces;
    pieces.add(0, -1.2, 0.3, -1.0, 1.0,
               [&](double, double) { return 3.4 + random.normal(kSigma); });
    pieces.add(1, 0.3, 1.2, -1.0, 1.0,
               [&](double, double) { return 3.4 - step + random.normal(kSigma); });
    EXPECT_FALSE(pieces.areOneSurface()) << trial;
  }
}

TEST(SameSurface, IsNoLayerThatTouchesAnotherInOnePlace) {
  // The back of a shelf, 2 cm before the wall and 10 cm beside what is seen of it. In one place of
  // 3 × 3 samples, at a board's end, averages lie between the two and count for the wall.
  int apart = 0;
  for (int trial = 0; trial < 50; ++trial) {
    test::Random random(static_cast<std::uint64_t>(trial));
    const auto back = [&](double, double) { return 3.38 + random.normal(kSigma); };
    TwoPieces pieces;
    pieces.add(0, 0.1, 1.5, -1.0, 1.0, [&](double, double) { return 3.4 + random.normal(kSigma); });
    pieces.add(1, -1.0, -0.6, -1.0, 1.0, back);
    pieces.add(1, -0.45, 0.0, -1.0, 1.0, back);
    pieces.add(1, -0.6, -0.45, -1.0, 0.0, back);
    pieces.add(0, -0.6, -0.45, 0.0, 0.15,
               [&](double, double) { return random.uniform(3.37, 3.4); });
    pieces.add(1, -0.6, -0.45, 0.15, 1.0, back);
    apart += pieces.areOneSurface() ? 0 : 1;
  }
  EXPECT_GE(apart, 40) << "of 50; means of nine samples may lie between the two by chance";
}

TEST(SameSurface, IsNoFrameBehindADoor) {
  // The frame's samples are closer: around those of the door beside it they prevail.
  for (int trial = 0; trial < 50; ++trial) {
    test::Random random(static_cast<std::uint64_t>(trial));
    const double step = random.uniform(0.018, 0.025);
    TwoPieces pieces;
    pieces.add(0, -1.2, 0.3, -1.0, 1.0,
               [&](double, double) { return 3.4 + random.normal(kSigma); });
    pieces.add(
        1, 0.3, 0.34, -1.0, 1.0, [&](double, double) { return 3.4 + step + random.normal(kSigma); },
        0.02);
    EXPECT_FALSE(pieces.areOneSurface()) << trial;
  }
}

}  // namespace
}  // namespace opp
