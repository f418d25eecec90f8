// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/tum_trajectory.h"

#include "support/random.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <sstream>

namespace opp::mapping {
namespace {

Trajectory read(const std::string& text) {
  std::istringstream stream(text);
  return readTumTrajectory(stream, "a.tum");
}

std::string messageOf(const std::string& text) {
  try {
    read(text);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

TEST(TumTrajectory, ReadsTimePositionAndQuaternionInScalarLastOrder) {
  // A quarter turn about z: x goes to y.
  const Trajectory t = read("# a comment\n\n  12.5\t1 2 3 0 0 0.70710678 0.70710678 # end\r\n");
  ASSERT_EQ(t.size(), 1u);
  EXPECT_EQ(t[0].timestamp, 12.5);
  EXPECT_EQ(t[0].map_from_body.translation(), Eigen::Vector3d(1, 2, 3));
  const Eigen::Vector3d turned = t[0].map_from_body.linear() * Eigen::Vector3d::UnitX();
  EXPECT_TRUE(turned.isApprox(Eigen::Vector3d::UnitY(), 1e-12)) << turned.transpose();
}

TEST(TumTrajectory, SortsByTimeAndDropsRepeatedLines) {
  const Trajectory t = read("2 5 0 0 0 0 0 1\n1 4 0 0 0 0 0 1\n2 5 0 0 0 0 0 1\n");
  ASSERT_EQ(t.size(), 2u);
  EXPECT_EQ(t[0].map_from_body.translation().x(), 4.0);
  EXPECT_EQ(t[1].map_from_body.translation().x(), 5.0);
}

TEST(TumTrajectory, NoPosesAreAnEmptyTrajectory) {
  EXPECT_TRUE(read("").empty());
  EXPECT_TRUE(read("# nothing\n\n").empty());
}

TEST(TumTrajectory, ErrorsNameFileLineAndCause) {
  const std::string good = "1 0 0 0 0 0 0 1\n";
  EXPECT_NE(messageOf(good + "2 0 0 0 0 0 1\n").find("a.tum:2: expected 8 numbers"),
            std::string::npos);
  EXPECT_NE(messageOf(good + "2 0 x 0 0 0 0 1\n").find("a.tum:2: 'x' is no number"),
            std::string::npos);
  EXPECT_NE(messageOf("1,5 0 0 0 0 0 0 1\n").find("'1,5' is no number"), std::string::npos);
  EXPECT_NE(messageOf("nan 0 0 0 0 0 0 1\n").find("'nan' is not finite"), std::string::npos);
  EXPECT_NE(messageOf("1 inf 0 0 0 0 0 1\n").find("'inf' is not finite"), std::string::npos);
  EXPECT_NE(messageOf("1 0 0 0 0 0 0 0\n").find("quaternion of length 0.0"), std::string::npos);
  EXPECT_NE(messageOf("1 0 0 0 0 0 0 1.02\n").find("quaternion of length 1.02"), std::string::npos);
  EXPECT_NE(messageOf(good + "\n1 9 0 0 0 0 0 1\n")
                .find("a.tum:3: another pose for the moment of "
                      "line 1"),
            std::string::npos);
}

TEST(TumTrajectory, NormalizesRoundedQuaternions) {
  const Trajectory t = read("1 0 0 0 0 0 0 1.009\n");
  EXPECT_TRUE(t.at(0).map_from_body.linear().isIdentity(1e-15));
}

TEST(TumTrajectory, WritesSixDecimalsOfTimeAndNineDigits) {
  StampedPose pose;
  pose.timestamp = 1600000000.0333331;
  pose.map_from_body.translation() = Eigen::Vector3d(1.0 / 3.0, -0.0, 123456.7894);
  EXPECT_EQ(formatTumTrajectory({pose}),
            "# timestamp tx ty tz qx qy qz qw\n"
            "1600000000.033333 0.333333333 0 123456.789 0 0 0 1\n");
  EXPECT_EQ(formatTumTrajectory({}), "# timestamp tx ty tz qx qy qz qw\n");
}

TEST(TumTrajectory, RefusesToWriteWhatIsNotFinite) {
  Trajectory t(1);
  t[0].timestamp = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(formatTumTrajectory(t), std::invalid_argument);
  t[0].timestamp = 0.0;
  t[0].map_from_body.translation().x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(formatTumTrajectory(t), std::invalid_argument);
}

TEST(TumTrajectory, ReadsBackWhatItWrote) {
  test::Random random(31);
  Trajectory t;
  for (int k = 0; k < 200; ++k) t.push_back({1.6e9 + 0.1 * k, random.pose(100.0)});
  const Trajectory back = read(formatTumTrajectory(t));
  ASSERT_EQ(back.size(), t.size());
  for (std::size_t k = 0; k < t.size(); ++k) {
    // Half a unit of the last written digit: 6 decimals of time (the double itself
    // resolves 2.4e-7), 9 digits of at most 100 m, 9 digits of a quaternion's coefficients (times
    // 2√2 in the matrix).
    EXPECT_NEAR(back[k].timestamp, t[k].timestamp, 5e-7 + 2.4e-7);
    EXPECT_LT((back[k].map_from_body.translation() - t[k].map_from_body.translation())
                  .lpNorm<Eigen::Infinity>(),
              5.1e-8);
    EXPECT_LT(
        (back[k].map_from_body.linear() - t[k].map_from_body.linear()).lpNorm<Eigen::Infinity>(),
        3e-9);
  }
}

TEST(TumTrajectory, FilesAreWrittenWholeAndReadBack) {
  const test::TempFolder folder;
  const Trajectory t(1);
  writeTumTrajectory(folder / "t.tum", t);
  EXPECT_EQ(test::readFile(folder / "t.tum"), formatTumTrajectory(t));
  EXPECT_EQ(folder.contents(), std::vector<std::string>{"t.tum"});
  EXPECT_EQ(readTumTrajectory(folder / "t.tum").size(), 1u);
}

TEST(TumTrajectory, FilesThatCannotBeUsedAreNamed) {
  const test::TempFolder folder;
  EXPECT_THROW(readTumTrajectory(folder / "missing.tum"), std::runtime_error);
  EXPECT_THROW(readTumTrajectory(folder.path()), std::runtime_error);
  EXPECT_THROW(writeTumTrajectory(folder / "no/such/folder.tum", {}), std::runtime_error);
}

TEST(TumTrajectory, RandomBytesAreAnErrorAndNothingElse) {
  test::Random random(33);
  for (int k = 0; k < 100; ++k) {
    std::string bytes = "1 ";
    for (int i = 0; i < 200; ++i) bytes += static_cast<char>(random.integer(0, 255));
    bytes.erase(std::remove(bytes.begin(), bytes.end(), '#'), bytes.end());
    EXPECT_NE(messageOf(bytes), "no error");
  }
}

}  // namespace
}  // namespace opp::mapping
