// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/planar_map_json.h"
#include "opp/mapping/io/rawlog_reader.h"
#include "opp/mapping/io/tum_trajectory.h"
#include "opp/mapping/simulation/scene.h"

#include "support/planar_map_schema.h"
#include "support/run_command.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

using test::readFile;
using test::runApp;
using test::TempFolder;

TEST(OppSimulate, WritesARawlogWithItsTruth) {
  const TempFolder folder;
  const auto result =
      runApp("opp-simulate",
             {"--scene", "room", "--frames", "4", "--decimation", "4", "--quiet", "-o", "a.rawlog"},
             folder.path());
  ASSERT_EQ(result.exit_code, 0) << result;
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(folder.contents(), (std::vector<std::string>{"a.gt.json", "a.gt.tum", "a.rawlog"}));
  const Trajectory truth = readTumTrajectory(folder / "a.gt.tum");
  RawlogReader reader(folder / "a.rawlog");
  for (const StampedPose& pose : truth) {
    const auto scan = reader.nextScan();
    ASSERT_TRUE(scan.has_value());
    EXPECT_NEAR(scan->timestamp, pose.timestamp, 1e-6);
    EXPECT_EQ(scan->cloud_in_body.cols, 160);
  }
  EXPECT_EQ(truth.size(), 4U);
  EXPECT_GE(readPlanarMap(folder / "a.gt.json").planes.size(), 10U);
}

TEST(OppSimulate, GivesTheSameBytesForEveryNumberOfThreads) {
  const TempFolder folder;
  for (const auto* sensor : {"kinect", "lidar16"}) {
    for (const auto* threads : {"1", "2", "5"}) {
      const auto result =
          runApp("opp-simulate",
                 {"--scene", "hall", "--frames", "7", "--decimation", "8", "--sensor", sensor,
                  "--odometry", "--drop-rate", "0.2", "--threads", threads, "--quiet", "-o",
                  std::string("t") + threads + ".rawlog"},
                 folder.path());
      ASSERT_EQ(result.exit_code, 0) << result;
    }
    for (const auto* other : {"t2", "t5"}) {
      for (const auto* suffix : {".rawlog", ".gt.tum", ".gt.json"}) {
        EXPECT_EQ(readFile(folder / (std::string("t1") + suffix)),
                  readFile(folder / (std::string(other) + suffix)));
      }
    }
  }
}

TEST(OppSimulate, SeedsDiffer) {
  const TempFolder folder;
  for (const auto* seed : {"1", "2"}) {
    ASSERT_EQ(runApp("opp-simulate",
                     {"--scene", "cube", "--frames", "1", "--decimation", "8", "--seed", seed,
                      "--quiet", "-o", std::string(seed) + ".rawlog"},
                     folder.path())
                  .exit_code,
              0);
  }
  EXPECT_NE(readFile(folder / "1.rawlog"), readFile(folder / "2.rawlog"));
}

TEST(OppSimulate, StatesTheTruthOfEachFrameInTheBodyFrame) {
  const TempFolder folder;
  ASSERT_EQ(runApp("opp-simulate",
                   {"--scene", "room", "--frames", "2", "--sensor", "ideal", "--per-frame-gt",
                    "frames", "--quiet", "-o", "a.rawlog"},
                   folder.path())
                .exit_code,
            0);
  const Trajectory poses = readTumTrajectory(folder / "a.gt.tum");
  const PlanarMap whole = readPlanarMap(folder / "a.gt.json");
  for (std::size_t k = 0; k < 2; ++k) {
    const PlanarMap map = readPlanarMap(folder / ("frames/00000" + std::to_string(k) + ".json"));
    EXPECT_EQ(map.frame, "sensor");
    ASSERT_GE(map.planes.size(), 5U);
    for (const PlanarMapPlane& plane : map.planes) {
      EXPECT_GT(plane.plane.d(), 0.0);  // the normal looks at the sensor in the origin
      const Plane in_map = opp::transformed(poses[k].map_from_body, plane.plane);
      double least = 1.0;
      for (const PlanarMapPlane& other : whole.planes) {
        least = std::min(least, (other.plane.coefficients() - in_map.coefficients()).norm());
      }
      EXPECT_LT(least, 1e-6);  // 9 digits of the trajectory's text
    }
  }
}

TEST(OppSimulate, TruthFollowsTheSchemaInEachScene) {
  for (const auto scene : builtInScenes()) {
    for (const std::string sensor : {"kinect", "lidar16"}) {
      const TempFolder folder;
      const auto result = runApp(
          "opp-simulate",
          {"--scene", std::string(scene), "--sensor", sensor, "--frames", "3", "--decimation", "4",
           "--min-pixels", "100", "--per-frame-gt", "frames", "--quiet", "-o", "a.rawlog"},
          folder.path());
      ASSERT_EQ(result.exit_code, 0) << result;
      std::vector<std::filesystem::path> files{folder / "a.gt.json"};
      for (const char* name : {"000000", "000001", "000002"}) {
        files.push_back(folder / (std::string("frames/") + name + ".json"));
      }
      EXPECT_GE(readPlanarMap(files[0]).planes.size(), 3U);
      const auto check = test::validatePlanarMaps(files);
      EXPECT_EQ(check.exit_code, 0) << scene << ' ' << sensor << ' ' << check;
    }
  }
}

TEST(OppSimulate, ReadsASceneFile) {
  const TempFolder folder;
  test::writeFile(folder / "mine.ini", builtInSceneText("cube"));
  const auto result = runApp(
      "opp-simulate",
      {"--scene", "mine.ini", "--frames", "1", "--decimation", "8", "--quiet", "-o", "a.rawlog"},
      folder.path());
  EXPECT_EQ(result.exit_code, 0) << result;
}

TEST(OppSimulate, WrongUsageEndsWithTwoAndBadInputWithOneAndNothingIsWritten) {
  const TempFolder folder;
  const auto code = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--quiet", "-o", "a.rawlog"});
    const auto result = runApp("opp-simulate", arguments, folder.path());
    EXPECT_NE(result.err, "");
    return result.exit_code;
  };
  EXPECT_EQ(code({}), 2);
  EXPECT_EQ(code({"--scene", "room", "--frames", "0"}), 2);
  EXPECT_EQ(code({"--scene", "room", "--sensor", "eye"}), 2);
  EXPECT_EQ(code({"--scene", "room", "--kidnap", "half"}), 2);
  EXPECT_EQ(code({"--scene", "room", "--sensor-pose", "1 2 3"}), 2);
  EXPECT_EQ(code({"--scene", "room", "--format", "text"}), 2);
  EXPECT_EQ(code({"--scene", "moon"}), 1);
  EXPECT_EQ(code({"--scene", "blank", "--passes", "2"}), 1);
  EXPECT_EQ(code({"--scene", "room", "--drop-rate", "1"}), 1);
  EXPECT_EQ(code({"--scene", "room", "--gzip-level", "12"}), 1);
  EXPECT_TRUE(folder.contents().empty());
  test::writeFile(folder / "bad.ini", "[box]\nsize = 1 1\n");
  EXPECT_EQ(code({"--scene", "bad.ini"}), 1);
  EXPECT_EQ(folder.contents(), std::vector<std::string>{"bad.ini"});
}

TEST(OppSimulate, TheRecipeOfTheDemoMakesTheDemo) {
  const TempFolder folder;
  ASSERT_EQ(runApp("opp-simulate",
                   {"--scene", "room", "--frames", "60", "--sensor", "kinect", "--seed", "1",
                    "--odometry", "--planar", "--sensor-pose", "0.1 0 0.9 0 10 0", "--decimation",
                    "2", "--gzip-level", "9", "--quiet", "-o", "demo.rawlog"},
                   folder.path())
                .exit_code,
            0);
  const std::filesystem::path rawlogs = std::filesystem::path(OPP_SOURCE_FOLDER) / "rawlogs";
  for (const auto* name : {"demo.rawlog", "demo.gt.tum", "demo.gt.json"}) {
    EXPECT_TRUE(readFile(folder / name) == readFile(rawlogs / name)) << name;
  }
}

}  // namespace
}  // namespace opp::mapping
