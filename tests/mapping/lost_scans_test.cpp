// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/lost_scans.h"

#include "support/synthetic_features.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

constexpr double kTimeStep = test::kTimeStep;

Eigen::Isometry3d at(double x) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(x, 0.1, 1.2);
  return pose;
}

/// The body stood at x = 0 when it was last seen; it is expected there, ever less certainly.
LostScan lostScan(std::uint64_t room, int step, double x) {
  PosePrior predicted;
  predicted.map_from_body = at(0.0);
  const double sigma = 0.06 * step;
  predicted.information.diagonal().setConstant(1.0 / (sigma * sigma));
  return {test::scanOfRoom(room, step, at(x)), predicted};
}

constexpr int kRooms = 10;

TEST(LostScans, DenyThatABodyLeaptAsSoonAsItWasLost) {
  for (std::uint64_t room = 0; room < kRooms; ++room) {
    // What is found at 0.4 m stood there all the time, 0.1 s after it was seen at 0.
    std::vector<LostScan> lost;
    for (int step = 1; step <= 4; ++step) lost.push_back(lostScan(room, step, 0.4));
    EXPECT_TRUE(
        deniedByLostScans(lost, test::scanOfRoom(room, 5, at(0.4)), at(0.4), MapperParams()))
        << "room " << room;
    // The last of them alone cannot tell.
    lost.erase(lost.begin(), lost.begin() + 3);
    EXPECT_FALSE(
        deniedByLostScans(lost, test::scanOfRoom(room, 5, at(0.4)), at(0.4), MapperParams()))
        << "room " << room;
  }
}

TEST(LostScans, AllowTheWayThatABodyTakes) {
  for (std::uint64_t room = 0; room < kRooms; ++room) {
    std::vector<LostScan> lost;
    for (int step = 1; step <= 4; ++step) lost.push_back(lostScan(room, step, 0.08 * step));
    EXPECT_FALSE(
        deniedByLostScans(lost, test::scanOfRoom(room, 5, at(0.4)), at(0.4), MapperParams()))
        << "room " << room;
  }
}

TEST(LostScans, WhatShowsSomethingElseDeniesNothing) {
  for (std::uint64_t room = 0; room < kRooms; ++room) {
    std::vector<LostScan> lost;
    for (int step = 1; step <= 4; ++step) {
      lost.push_back(lostScan(room, step, 0.4));
      // A hand before the sensor.
      for (Eigen::Vector3f& point : lost.back().scan.cloud_in_body.points)
        point = 0.3F * point.normalized();
    }
    EXPECT_FALSE(
        deniedByLostScans(lost, test::scanOfRoom(room, 5, at(0.4)), at(0.4), MapperParams()))
        << "room " << room;
  }
}

TEST(LostScans, NoneDenyNothing) {
  EXPECT_FALSE(deniedByLostScans({}, test::scanOfRoom(1, 1, at(0.0)), at(0.0), MapperParams()));
}

}  // namespace
}  // namespace opp::mapping
