// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud/sample_blocks.h"

#include "support/degenerate_clouds.h"
#include "support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace opp {
namespace {

TEST(SampleBlocks, VisitsWhateverLiesNearAPlane) {
  test::Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const OrientedCloud cloud = test::randomCloud(static_cast<std::uint64_t>(trial), 500);
    const SampleBlocks blocks(cloud.points);
    const Plane plane = Plane::fromPointNormal(random.vector(1.0), random.unitVector());
    Eigen::AlignedBox3f box(random.vector(1.0).cast<float>());
    box.extend(random.vector(1.0).cast<float>());
    const double distance = random.uniform(0.0, 0.3);
    std::vector<bool> visited(cloud.size(), false);
    std::size_t last = 0;
    blocks.visitNear(plane, box, distance, [&](std::size_t begin, std::size_t end) {
      EXPECT_GE(begin, last);
      EXPECT_GT(end, begin);
      last = end;
      for (std::size_t k = begin; k < end; ++k) visited[blocks.order()[k]] = true;
    });
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const double offset = plane.signedDistance(cloud.points[i].cast<double>());
      // Rounding of float coordinates of 1 m.
      if (std::abs(offset) > distance - 1e-6 || !box.contains(cloud.points[i])) continue;
      EXPECT_TRUE(visited[i]);
    }
    // A plane and a box meet few of 16³ blocks; without blocks all would be visited.
    EXPECT_LT(std::count(visited.begin(), visited.end(), true), 450);
  }
}

TEST(SampleBlocks, HoldEverySampleOnce) {
  for (const auto& [name, cloud] : test::degenerateClouds()) {
    SCOPED_TRACE(name);
    std::vector<std::uint32_t> order = SampleBlocks(cloud.points).order();
    std::sort(order.begin(), order.end());
    std::vector<std::uint32_t> all(cloud.size());
    std::iota(all.begin(), all.end(), 0U);
    EXPECT_EQ(order, all);
  }
}

}  // namespace
}  // namespace opp
