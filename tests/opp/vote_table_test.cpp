// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/detection/vote_table.h"

#include "opp/geometry/constants.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace opp {
namespace {

TEST(VoteTable, PeakIsTheMeanOfItsVotes) {
  VoteTable table(18, 25, 1.0);
  table.cast(0.50F, 0.30F, 7);
  table.cast(0.54F, 0.32F, 8);
  table.cast(2.00F, -0.60F, 9);
  VotePeak peak;
  ASSERT_TRUE(table.takePeak(2, peak));
  EXPECT_NEAR(peak.theta, 0.52, 1e-6);
  EXPECT_NEAR(peak.rho, 0.31, 1e-6);
  EXPECT_EQ(peak.voters, (std::vector<std::uint32_t>{7, 8}));
  EXPECT_EQ(table.votes(), 1U);
}

TEST(VoteTable, GivesAllPeaksOnceAndThenNothing) {
  VoteTable table(18, 25, 1.0);
  for (std::uint32_t k = 0; k < 5; ++k) table.cast(0.5F, 0.3F, k);
  for (std::uint32_t k = 5; k < 8; ++k) table.cast(2.0F, -0.6F, k);
  VotePeak peak;
  ASSERT_TRUE(table.takePeak(1, peak));
  EXPECT_EQ(peak.voters.size(), 5U);
  ASSERT_TRUE(table.takePeak(1, peak));
  EXPECT_EQ(peak.voters.size(), 3U);
  EXPECT_FALSE(table.takePeak(1, peak));
}

TEST(VoteTable, LeavesPeaksBelowTheThresholdInPlace) {
  VoteTable table(18, 25, 1.0);
  for (std::uint32_t k = 0; k < 5; ++k) table.cast(0.5F, 0.3F, k);
  VotePeak peak;
  EXPECT_FALSE(table.takePeak(6, peak));
  EXPECT_EQ(table.votes(), 5U);
  EXPECT_TRUE(table.takePeak(5, peak));
}

// Random votes, compared with counting the neighbours of every vote; also across the fold.
TEST(VoteTable, PeakIsTheWindowWithMostVotes) {
  constexpr int kThetaBins = 7, kRhoBins = 9;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    test::Random random(seed);
    VoteTable table(kThetaBins, kRhoBins, 1.0);
    std::vector<std::array<int, 2>> bins;
    for (std::uint32_t k = 0; k < 60; ++k) {
      bins.push_back({random.integer(0, kThetaBins - 1), random.integer(0, kRhoBins - 1)});
      table.cast(static_cast<float>((bins[k][0] + 0.5) * kPi / kThetaBins),
                 static_cast<float>((bins[k][1] + 0.5) * 2.0 / kRhoBins - 1.0), k);
    }
    std::size_t most = 0;
    for (const auto& center : bins) {
      std::size_t count = 0;
      for (const auto& bin : bins) {
        const int steps = std::abs(bin[0] - center[0]);
        const bool folded = steps == kThetaBins - 1;
        const int rho = folded ? kRhoBins - 1 - bin[1] : bin[1];
        count += (steps <= 1 || folded) && std::abs(rho - center[1]) <= 1 ? 1U : 0U;
      }
      most = std::max(most, count);
    }
    VotePeak peak;
    ASSERT_TRUE(table.takePeak(1, peak));
    EXPECT_EQ(peak.voters.size(), most);
    EXPECT_EQ(table.votes(), bins.size() - most);
  }
}

TEST(VoteTable, OppositeNormalsVoteForTheSamePlane) {
  test::Random random(3);
  VoteTable table(18, 25, 1.0);
  for (int k = 0; k < 200; ++k) {
    const double theta = random.uniform(-kPi, kPi), rho = random.uniform(-0.9, 0.9);
    table.clear();
    table.cast(static_cast<float>(theta), static_cast<float>(rho), 0);
    table.cast(static_cast<float>(theta + kPi), static_cast<float>(-rho), 1);
    VotePeak peak;
    ASSERT_TRUE(table.takePeak(2, peak)) << theta << " " << rho;
    // The same line in the reference plane: same normal up to sign, same signed offset.
    const double sign = std::cos(peak.theta - theta) > 0.0 ? 1.0 : -1.0;
    EXPECT_NEAR(std::cos(peak.theta), sign * std::cos(theta), 1e-5);
    EXPECT_NEAR(std::sin(peak.theta), sign * std::sin(theta), 1e-5);
    EXPECT_NEAR(peak.rho, sign * rho, 1e-5);
  }
}

// The paper's public code decodes a bin's lower edge: −5° and −4 cm of bias at the paper's bins.
TEST(VoteTable, DecodedPeaksAreUnbiased) {
  test::Random random(4);
  VoteTable table(18, 25, 1.0);
  double theta_error = 0.0, rho_error = 0.0;
  constexpr int kTrials = 400, kVotes = 20;
  for (int trial = 0; trial < kTrials; ++trial) {
    const double theta = random.uniform(0.0, kPi), rho = random.uniform(-0.8, 0.8);
    table.clear();
    for (std::uint32_t k = 0; k < kVotes; ++k) {
      table.cast(static_cast<float>(theta + random.normal(degToRad(3.0))),
                 static_cast<float>(rho + random.normal(0.02)), k);
    }
    VotePeak peak;
    ASSERT_TRUE(table.takePeak(1, peak));
    const bool same = std::cos(peak.theta - theta) > 0.0;
    theta_error += std::remainder(peak.theta - theta, kPi);
    rho_error += same ? peak.rho - rho : -peak.rho - rho;
  }
  // Standard deviations of the two means over 8000 votes: 3°/89 = 0.034° and 0.02 m/89 = 0.2 mm;
  // four of them are allowed.
  EXPECT_NEAR(theta_error / kTrials, 0.0, degToRad(0.14));
  EXPECT_NEAR(rho_error / kTrials, 0.0, 0.0009);
}

TEST(VoteTable, PeakOnABinEdgeIsNotSplit) {
  VoteTable table(18, 25, 1.0);
  const auto edge = static_cast<float>(5.0 * kPi / 18.0);
  for (std::uint32_t k = 0; k < 10; ++k) {
    table.cast(edge + (k % 2 == 0 ? 0.01F : -0.01F), k < 5 ? 0.119F : 0.121F, k);
  }
  VotePeak peak;
  ASSERT_TRUE(table.takePeak(1, peak));
  EXPECT_EQ(peak.voters.size(), 10U);
}

TEST(SignificantVotes, GrowsWithClutterAndIsNeverBelowThree) {
  EXPECT_EQ(significantVotes(0.0, 450.0, 1e-3), 3);
  EXPECT_GT(significantVotes(1.0, 450.0, 1e-3), significantVotes(0.1, 450.0, 1e-3));
  EXPECT_GT(significantVotes(1.0, 450.0, 1e-6), significantVotes(1.0, 450.0, 1e-3));
}

TEST(SignificantVotes, AKnownLowerBoundChangesNothing) {
  for (double mean = 0.0; mean < 20.0; mean += 0.1) {
    const int least = significantVotes(mean, 450.0, 1e-3);
    EXPECT_EQ(significantVotes(mean + 0.1, 450.0, 1e-3, least),
              significantVotes(mean + 0.1, 450.0, 1e-3));
  }
}

TEST(SignificantVotes, AccidentalVotesRarelyReachIt) {
  test::Random random(5);
  constexpr int kWindows = 100;
  const int needed = significantVotes(2.0, kWindows, 0.5);
  int alarms = 0;
  for (int trial = 0; trial < 200; ++trial) {
    for (int window = 0; window < kWindows; ++window) {
      int votes = 0;  // binomial(200, 1 %): nearly Poisson with mean 2
      for (int k = 0; k < 200; ++k) votes += random.uniform(0.0, 1.0) < 0.01 ? 1 : 0;
      alarms += votes >= needed ? 1 : 0;
    }
  }
  // At most 0.5 per 100 windows are allowed by the bound: 100 of 20000; it is conservative.
  EXPECT_LT(alarms, 100);
}

}  // namespace
}  // namespace opp
