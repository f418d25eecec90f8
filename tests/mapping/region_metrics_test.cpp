// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/evaluation/region_metrics.h"

#include "support/random.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

/// Labels of points in runs: {{label, count}, ...}.
std::vector<int> runs(const std::vector<std::pair<int, int>>& label_counts) {
  std::vector<int> labels;
  for (const auto& [label, count] : label_counts) {
    labels.insert(labels.end(), static_cast<std::size_t>(count), label);
  }
  return labels;
}

RegionCounts at(const RegionMetrics& metrics, int percent) {
  for (const RegionCounts& counts : metrics.counts) {
    if (counts.threshold_percent == percent) return counts;
  }
  throw std::out_of_range("no such threshold");
}

void expectCounts(const RegionCounts& c, int correct, int over, int under, int missed, int noise) {
  EXPECT_EQ(c.correct, correct) << c.threshold_percent;
  EXPECT_EQ(c.over_segmented, over) << c.threshold_percent;
  EXPECT_EQ(c.under_segmented, under) << c.threshold_percent;
  EXPECT_EQ(c.missed, missed) << c.threshold_percent;
  EXPECT_EQ(c.noise, noise) << c.threshold_percent;
}

std::vector<int> randomLabels(test::Random& random, int points, int regions) {
  std::vector<int> labels;
  for (int k = 0; k < points; ++k) labels.push_back(random.integer(-1, regions - 1));
  return labels;
}

TEST(RegionMetrics, TruthAgainstItselfIsAllCorrect) {
  test::Random random(81);
  for (int k = 0; k < 50; ++k) {
    const std::vector<int> labels = randomLabels(random, 300, 6);
    const RegionMetrics metrics = regionMetrics(labels, labels);
    EXPECT_EQ(metrics.gt_regions, 6);
    EXPECT_EQ(metrics.mean_correct, 1.0);
    for (const RegionCounts& counts : metrics.counts) expectCounts(counts, 6, 0, 0, 0, 0);
  }
}

TEST(RegionMetrics, CorrectEndsWhereTheOverlapFallsBelowTheThreshold) {
  // 70 of 100 points found, nothing else labelled: correct up to 70 %, missed and noise above. The
  // estimated region lies fully in the true one but covers too little of it.
  const auto gt = runs({{0, 100}});
  const auto est = runs({{5, 70}, {-1, 30}});
  const RegionMetrics metrics = regionMetrics(gt, est);
  expectCounts(at(metrics, 70), 1, 0, 0, 0, 0);
  expectCounts(at(metrics, 75), 0, 0, 0, 1, 1);
  EXPECT_DOUBLE_EQ(metrics.mean_correct, 20.0 / 45.0);  // 51 to 70 of 51 to 95
}

TEST(RegionMetrics, RegionInTwoPartsIsOneOverSegmentation) {
  const auto gt = runs({{0, 100}, {1, 50}});
  const auto est = runs({{0, 50}, {1, 50}, {2, 50}});
  for (const RegionCounts& counts : regionMetrics(gt, est).counts) {
    expectCounts(counts, 1, 1, 0, 0, 0);
  }
}

TEST(RegionMetrics, TwoRegionsInOneAreOneUnderSegmentation) {
  const auto gt = runs({{0, 50}, {1, 50}, {2, 30}});
  const auto est = runs({{7, 100}, {8, 30}});
  for (const RegionCounts& counts : regionMetrics(gt, est).counts) {
    expectCounts(counts, 1, 0, 1, 0, 0);
  }
}

TEST(RegionMetrics, TakesTheBetterOfSeveralReadings) {
  // 80 + 15 of 100 points: correct with shares 0.8 and 1 (mean 0.9), over-segmented with 0.95
  // and 1.
  const auto gt = runs({{0, 100}});
  const auto est = runs({{0, 80}, {1, 15}, {-1, 5}});
  const RegionMetrics metrics = regionMetrics(gt, est);
  expectCounts(at(metrics, 80), 0, 1, 0, 0, 0);
  // A stray fifth of the small part's points drops it at T > 80 %: only the large part is left.
  const auto stray_gt = runs({{0, 100}, {-1, 10}});
  const auto stray_est = runs({{0, 85}, {1, 15}, {1, 10}});
  expectCounts(at(regionMetrics(stray_gt, stray_est), 85), 1, 0, 0, 0, 1);
}

TEST(RegionMetrics, UnknownPointsDoNotCountAndBackgroundDoes) {
  const auto gt = runs({{10, 100}, {3, 50}, {-1, 100}});
  const auto est = runs({{0, 150}, {-1, 100}});
  const RegionMetrics ignored = regionMetrics(gt, est, 10);
  EXPECT_EQ(ignored.points, 200);
  EXPECT_EQ(ignored.gt_regions, 1);
  EXPECT_EQ(ignored.mean_correct, 1.0);
  const auto on_background = runs({{0, 150}, {0, 100}});
  expectCounts(at(regionMetrics(gt, on_background, 10), 51), 0, 0, 0, 1, 1);
}

TEST(RegionMetrics, NothingFoundIsAllMissedAndNothingTrueIsAllNoise) {
  const auto labels = runs({{0, 10}, {1, 10}});
  const auto none = runs({{-1, 20}});
  expectCounts(at(regionMetrics(labels, none), 80), 0, 0, 0, 2, 0);
  expectCounts(at(regionMetrics(none, labels), 80), 0, 0, 0, 0, 2);
  EXPECT_EQ(regionMetrics(none, labels).mean_correct, 0.0);
  EXPECT_EQ(regionMetrics({}, {}).gt_regions, 0);
}

TEST(RegionMetrics, EachRegionIsCountedOnceForRandomLabels) {
  test::Random random(82);
  for (int k = 0; k < 100; ++k) {
    const int regions = random.integer(1, 6);
    const std::vector<int> gt = randomLabels(random, 200, regions);
    std::vector<int> est = gt;
    // Merge some, split some, spoil some.
    for (int& label : est) {
      if (label == 1) label = 0;
      if (label == 2) label = random.integer(2, 3) * 10;
      if (random.uniform(0.0, 1.0) < 0.1) label = random.integer(-1, 40);
    }
    const RegionMetrics metrics = regionMetrics(gt, est);
    for (const RegionCounts& c : metrics.counts) {
      EXPECT_LE(c.correct + c.over_segmented + 2 * c.under_segmented + c.missed,
                metrics.gt_regions);
      EXPECT_LE(c.correct + 2 * c.over_segmented + c.under_segmented + c.noise,
                metrics.est_regions);
    }
  }
}

TEST(RegionMetrics, DependsOnNeitherLabelValuesNorPointOrder) {
  test::Random random(83);
  for (int k = 0; k < 50; ++k) {
    const std::vector<int> gt = randomLabels(random, 120, 4);
    std::vector<int> est = gt;
    for (int& label : est) {
      if (random.uniform(0.0, 1.0) < 0.2) label = random.integer(-1, 5);
    }
    std::vector<int> gt_other, est_other;
    for (std::size_t i = gt.size(); i-- > 0;) {
      gt_other.push_back(gt[i] < 0 ? -7 : 100 - 3 * gt[i]);
      est_other.push_back(est[i] < 0 ? -2 : 50 - est[i]);
    }
    const RegionMetrics a = regionMetrics(gt, est);
    const RegionMetrics b = regionMetrics(gt_other, est_other);
    EXPECT_EQ(a.mean_correct, b.mean_correct);
  }
}

TEST(RegionMetrics, RejectsUnequalSizesAndANegativeFirstRegion) {
  EXPECT_THROW(regionMetrics({0, 1}, {0}), std::invalid_argument);
  EXPECT_THROW(regionMetrics({0}, {0}, -1), std::invalid_argument);
}

}  // namespace
}  // namespace opp::mapping
