// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/core/move_planar_map.h"
#include "opp/mapping/core/trajectory.h"
#include "opp/mapping/io/cloud_file.h"
#include "opp/mapping/io/planar_map_json.h"
#include "opp/mapping/io/tum_trajectory.h"

#include "support/random.h"
#include "support/run_command.h"
#include "support/shared_data.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace opp::mapping {
namespace {

using test::CommandResult;
using test::runApp;

Trajectory randomWalk(std::uint64_t seed) {
  test::Random random(seed);
  Trajectory path;
  Eigen::Isometry3d pose = random.pose(2.0);
  for (int k = 0; k < 60; ++k) {
    path.push_back({100.0 + k / 30.0, pose});
    pose = pose * random.motion(0.05, 0.1);
  }
  return path;
}

/// A floor and a wall of 2 m by 2 m that meet in a line.
PlanarMap floorAndWall() {
  PlanarMap map;
  map.planes.resize(2);
  map.planes[0].polygons = {{{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, {}}};
  map.planes[0].orthogonal_to = {1};
  map.planes[1].id = 1;
  map.planes[1].plane = Plane::fromCoefficients({1, 0, 0}, 0.0);
  map.planes[1].polygons = {{{{0, 0, 0}, {0, 2, 0}, {0, 2, 2}, {0, 0, 2}}, {}}};
  map.planes[1].orthogonal_to = {0};
  map.lines.resize(1);
  map.lines[0].planes = {0, 1};
  map.lines[0].end = {0, 2, 0};
  return map;
}

class OppEval : public testing::Test {
 protected:
  std::string write(const std::string& name, const Trajectory& trajectory) {
    writeTumTrajectory(folder_ / name, trajectory);
    return (folder_ / name).string();
  }
  std::string write(const std::string& name, const PlanarMap& map) {
    std::filesystem::create_directories((folder_ / name).parent_path());
    writePlanarMap(folder_ / name, map);
    return (folder_ / name).string();
  }
  std::string writeText(const std::string& name, const std::string& text) {
    test::writeFile(folder_ / name, text);
    return (folder_ / name).string();
  }
  test::TempFolder folder_;
};

TEST_F(OppEval, TruthAgainstItselfHasNoError) {
  const std::string gt = write("gt.tum", randomWalk(1));
  const CommandResult result = runApp("opp-eval", {"--gt", gt, "--est", gt, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result;
  const auto json = nlohmann::json::parse(result.out).at("trajectory");
  EXPECT_EQ(json.at("matched"), 60);
  EXPECT_EQ(json.at("coverage"), 1.0);
  EXPECT_LT(json.at("ate").at("translation_m").at("rmse"), 1e-12);
  EXPECT_LT(json.at("ate").at("rotation_rad").at("max"), 1e-7);
  EXPECT_LT(json.at("rpe_per_frame").at("translation_m").at("max"), 1e-12);
  EXPECT_LT(json.at("rpe_per_metre").at("translation_m_per_m").at("max"), 1e-12);
}

TEST_F(OppEval, TablePrintsEveryMeasureOnStdout) {
  const std::string gt = write("gt.tum", randomWalk(2));
  const CommandResult result = runApp("opp-eval", {"--gt", gt, "--est", gt});
  ASSERT_EQ(result.exit_code, 0) << result;
  for (const char* row :
       {"ATE translation [m]", "ATE rotation [deg]", "RPE per frame, rotation [rad]",
        "RPE per metre, translation [m/m]", "coverage"}) {
    EXPECT_NE(result.out.find(row), std::string::npos) << row;
  }
  EXPECT_EQ(result.err, "");
}

TEST_F(OppEval, NothingToCompareEndsWithOne) {
  const std::string gt = write("gt.tum", randomWalk(3));
  Trajectory later = randomWalk(3);
  for (auto& pose : later) pose.timestamp += 1000.0;
  for (const std::string& est : {write("later.tum", later), write("empty.tum", Trajectory())}) {
    const CommandResult result = runApp("opp-eval", {"--gt", gt, "--est", est});
    EXPECT_EQ(result.exit_code, 1) << result;
    EXPECT_NE(result.err.find("nothing to compare"), std::string::npos) << result;
    EXPECT_EQ(result.out, "");
  }
}

TEST_F(OppEval, BadFilesEndWithOneAndNameTheFile) {
  const std::string gt = write("gt.tum", randomWalk(4));
  for (const std::string& est :
       {(folder_ / "missing.tum").string(), folder_.path().string(),
        writeText("nan.tum", "1 nan 0 0 0 0 0 1\n"), writeText("bytes.tum", "\x01\xff\x00 \n8")}) {
    const CommandResult result = runApp("opp-eval", {"--gt", gt, "--est", est});
    EXPECT_EQ(result.exit_code, 1) << result;
    EXPECT_NE(result.err.find(est), std::string::npos) << result;
    EXPECT_EQ(result.out, "");
  }
}

TEST_F(OppEval, TruePlanesAgainstThemselvesArePerfect) {
  const std::string gt = write("gt.json", floorAndWall());
  const CommandResult result =
      runApp("opp-eval", {"--gt-planes", gt, "--est-planes", gt, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result;
  const auto json = nlohmann::json::parse(result.out).at("primitives");
  EXPECT_EQ(json.at("planes").at("precision"), 1.0);
  EXPECT_EQ(json.at("planes").at("recall"), 1.0);
  EXPECT_EQ(json.at("planes").at("offset_m").at("max"), 0.0);
  EXPECT_EQ(json.at("lines").at("recall"), 1.0);
  EXPECT_TRUE(json.at("corners").at("recall").is_null());
  EXPECT_EQ(json.at("orthogonality").at("false_rate"), 0.0);
}

TEST_F(OppEval, TrajectoriesAlignThePlanes) {
  const Trajectory gt_path = randomWalk(6);
  test::Random random(7);
  const Eigen::Isometry3d est_from_gt = random.pose(5.0);
  Trajectory est_path = gt_path;
  for (auto& pose : est_path) pose.map_from_body = est_from_gt * pose.map_from_body;
  const std::vector<std::string> planes{
      "--gt-planes", write("gt.json", floorAndWall()), "--est-planes",
      write("est.json", movedPlanarMap(est_from_gt, floorAndWall())), "--json"};
  std::vector<std::string> all{"--gt", write("gt.tum", gt_path), "--est",
                               write("est.tum", est_path)};
  all.insert(all.end(), planes.begin(), planes.end());
  const auto recall = [](const CommandResult& result) {
    return nlohmann::json::parse(result.out).at("primitives").at("planes").at("recall");
  };
  EXPECT_EQ(recall(runApp("opp-eval", planes)), 0.0);
  EXPECT_EQ(recall(runApp("opp-eval", all)), 1.0);
}

TEST_F(OppEval, FoldersAreAddedUpByFileName) {
  write("gt/000.gt.json", floorAndWall());
  write("gt/001.gt.json", floorAndWall());
  write("est/000.json", floorAndWall());
  write("est/777.json", floorAndWall());
  const CommandResult result =
      runApp("opp-eval", {"--gt-planes", "gt", "--est-planes", "est", "--json"}, folder_.path());
  ASSERT_EQ(result.exit_code, 0) << result;
  const auto json = nlohmann::json::parse(result.out).at("primitives");
  EXPECT_EQ(json.at("maps"), 2);
  EXPECT_EQ(json.at("maps_without_estimate"), 1);
  EXPECT_EQ(json.at("maps_without_truth"), 1);
  EXPECT_EQ(json.at("planes").at("recall"), 0.5);
  EXPECT_EQ(json.at("planes").at("precision"), 1.0);
}

TEST_F(OppEval, FoldersWithoutACommonNameAndMixedPathsEndWithOne) {
  const std::string gt = write("gt/a.json", floorAndWall());
  write("est/b.json", floorAndWall());
  for (const std::vector<std::string>& paths :
       std::vector<std::vector<std::string>>{{"gt", "est"}, {"gt", "est/b.json"}, {"gt", "no"}}) {
    const CommandResult result =
        runApp("opp-eval", {"--gt-planes", paths[0], "--est-planes", paths[1]}, folder_.path());
    EXPECT_EQ(result.exit_code, 1) << result;
    EXPECT_NE(result.err, "");
  }
}

TEST_F(OppEval, LabelsOfTheSamePointsAreComparedInAnyOrder) {
  PointCloud cloud;
  std::vector<int> labels;
  for (int k = 0; k < 60; ++k) {
    cloud.points.emplace_back(0.1F * static_cast<float>(k), 0.0F, 1.0F);
    labels.push_back(k / 20);
  }
  writeLabeledPly(folder_ / "gt.ply", cloud, labels);
  std::reverse(cloud.points.begin(), cloud.points.end());
  std::reverse(labels.begin(), labels.end());
  for (int& label : labels) label = label == 2 ? 1 : label;  // two regions in one
  writeLabeledPly(folder_ / "est.ply", cloud, labels);
  const CommandResult result = runApp(
      "opp-eval", {"--gt-labels", "gt.ply", "--est-labels", "est.ply", "--json"}, folder_.path());
  ASSERT_EQ(result.exit_code, 0) << result;
  const auto json = nlohmann::json::parse(result.out).at("regions");
  EXPECT_EQ(json.at("gt_regions"), 3);
  for (const auto& counts : json.at("thresholds")) {
    EXPECT_EQ(counts.at("correct"), 1);
    EXPECT_EQ(counts.at("under_segmented"), 1);
  }
  EXPECT_EQ(runApp("opp-eval",
                   {"--gt-labels", "gt.ply", "--est-labels", "est.ply", "--first-region", "5"},
                   folder_.path())
                .exit_code,
            1);
}

TEST_F(OppEval, SynpebAgainstItselfIsAllCorrectAndMergedPlanesAreOneUnderSegmentation) {
  OPP_SKIP_WITHOUT_SHARED_DATA();
  const std::string gt = test::sharedData("fixtures/synpeb_test_500.pcd").string();
  const auto evaluate = [&](const std::string& est) {
    const CommandResult result =
        runApp("opp-eval", {"--gt-labels", gt, "--est-labels", est, "--json"});
    EXPECT_EQ(result.exit_code, 0) << result;
    return nlohmann::json::parse(result.out).at("regions");
  };
  const auto itself = evaluate(gt);
  const int regions = itself.at("gt_regions");
  EXPECT_EQ(regions, 38);
  EXPECT_EQ(itself.at("mean_correct"), 1.0);
  for (const auto& counts : itself.at("thresholds")) EXPECT_EQ(counts.at("correct"), regions);

  LabeledCloud merged = readLabeledCloudFile(gt);
  std::vector<int> sizes(256, 0);
  for (const int label : merged.labels) {
    if (label >= 10) ++sizes.at(static_cast<std::size_t>(label));
  }
  const auto largest = std::max_element(sizes.begin(), sizes.end()) - sizes.begin();
  sizes[static_cast<std::size_t>(largest)] = 0;
  const auto second = std::max_element(sizes.begin(), sizes.end()) - sizes.begin();
  for (int& label : merged.labels) {
    if (label == second) label = static_cast<int>(largest);
  }
  writeLabeledPly(folder_ / "merged.ply", merged.cloud, merged.labels);
  const auto of_merged = evaluate((folder_ / "merged.ply").string());
  for (const auto& counts : of_merged.at("thresholds")) {
    EXPECT_EQ(counts.at("correct"), regions - 2);
    EXPECT_EQ(counts.at("under_segmented"), 1);
    EXPECT_EQ(counts.at("over_segmented"), 0);
    EXPECT_EQ(counts.at("missed"), 0);
  }
}

TEST_F(OppEval, ThresholdsCanBeSetAndListed) {
  PlanarMap est = floorAndWall();
  est.planes[0].plane = Plane::fromCoefficients({0, 0, 1}, -0.04);
  const std::vector<std::string> planes{"--gt-planes", write("gt.json", floorAndWall()),
                                        "--est-planes", write("est.json", est)};
  std::vector<std::string> strict = planes;
  strict.insert(strict.end(), {"--set", "primitive_error.max_offset=0.03"});
  EXPECT_NE(runApp("opp-eval", planes).out, runApp("opp-eval", strict).out);
  const CommandResult list = runApp("opp-eval", {"--list-parameters"});
  EXPECT_EQ(list.exit_code, 0) << list;
  for (const char* name : {"max_time_difference", "rpe_distance", "max_offset"}) {
    EXPECT_NE(list.out.find(name), std::string::npos) << name;
  }
}

TEST_F(OppEval, WrongUsageEndsWithTwo) {
  const std::string gt = write("gt.tum", randomWalk(5));
  EXPECT_EQ(runApp("opp-eval", {}).exit_code, 2);
  EXPECT_EQ(runApp("opp-eval", {"--gt", gt}).exit_code, 2);
  EXPECT_EQ(runApp("opp-eval", {"--gt", gt, "--est", gt, "--no-such-flag"}).exit_code, 2);
  EXPECT_EQ(
      runApp("opp-eval", {"--gt", gt, "--est", gt, "--set", "trajectory_error.rpe_distance=far"})
          .exit_code,
      2);
  EXPECT_EQ(runApp("opp-eval", {"--gt", gt, "--est", gt, "--quiet", "--threads", "1"}).exit_code,
            0);
  EXPECT_EQ(runApp("opp-eval", {"--help"}).exit_code, 0);
  EXPECT_EQ(runApp("opp-eval", {"--version"}).exit_code, 0);
}

}  // namespace
}  // namespace opp::mapping
