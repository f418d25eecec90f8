// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
// opp-eval: how far an estimate is from the truth.
#include "opp/mapping/evaluation/primitive_error.h"
#include "opp/mapping/evaluation/trajectory_error.h"
#include "opp/mapping/io/tum_trajectory.h"

#include "common/flags.h"
#include "common/run_main.h"
#include "opp-eval/primitive_report.h"
#include "opp-eval/region_report.h"
#include "opp-eval/trajectory_report.h"

#include <filesystem>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>

namespace {

using opp::apps::CommandLine;
using opp::apps::UsageError;
using opp::mapping::Trajectory;
using Json = nlohmann::ordered_json;

/// All thresholds of the comparison, for -c and --set.
struct EvaluationParams {
  opp::mapping::TrajectoryErrorParams trajectory;
  opp::mapping::PrimitiveErrorParams primitives;

  template <typename Self, typename F>
  static void visitSections(Self&& p, F&& f) {
    f(p.trajectory.association);
    f(p.trajectory);
    f(p.primitives);
  }
};

/// A flag for the truth and one for the estimate, which go together.
struct PairFlags {
  PairFlags(CommandLine& line, const std::string& suffix, const std::string& what,
            const std::string& type)
      : gt("", "gt" + suffix, "True " + what, false, "", type, line),
        est("", "est" + suffix, "Estimated " + what, false, "", type, line) {}

  /// \throws UsageError if only one of the two is given.
  bool given() {
    if (gt.isSet() != est.isSet()) {
      throw UsageError("--" + gt.getName() + " and --" + est.getName() + " go together");
    }
    return gt.isSet();
  }

  TCLAP::ValueArg<std::string> gt;
  TCLAP::ValueArg<std::string> est;
};

Trajectory readPoses(const std::string& path) {
  Trajectory trajectory = opp::mapping::readTumTrajectory(std::filesystem::path(path));
  if (trajectory.empty()) throw std::runtime_error(path + ": holds no pose; nothing to compare");
  return trajectory;
}

/// Adds a result to the JSON or prints its table.
template <typename Result>
void report(const Result& result, const std::string& key, bool as_json, Json& json) {
  if (as_json) {
    json[key] = opp::mapping::toJson(result);
  } else {
    opp::mapping::print(std::cout, result);
  }
}

void run(CommandLine& line) {
  PairFlags poses(line, "", "trajectory (TUM text)", "FILE.tum");
  PairFlags planes(line, "-planes",
                   "planes, lines and corners, or a folder of such files; with --gt and --est they "
                   "are aligned as the trajectories are",
                   "FILE.json");
  PairFlags labels(line, "-labels", "labels of the same points", "FILE.{pcd,ply}");
  opp::apps::AtLeast not_negative(0);
  TCLAP::ValueArg<int> first_region(
      "", "first-region",
      "Smallest true label that is a region (default: 10 for .pcd, as in SynPEB, else 0)", false, 0,
      &not_negative, line);
  opp::apps::ParameterFlags parameters(line);
  // Every program takes these two; comparing is quick, silent and sequential.
  opp::apps::ThreadsFlag threads(line);
  opp::apps::QuietFlag quiet(line);
  TCLAP::SwitchArg list("", "list-parameters", "Print all thresholds and end", line);
  TCLAP::SwitchArg as_json("", "json", "Print JSON instead of tables", line);
  line.parse();

  EvaluationParams params;
  parameters.applyTo(params);
  if (list.getValue()) return opp::mapping::writeParameterTable(std::cout, params);
  const bool have_poses = poses.given();
  const bool have_planes = planes.given();
  const bool have_labels = labels.given();
  if (!have_poses && !have_planes && !have_labels) {
    throw UsageError("nothing to compare: give --gt and --est, or the same of planes or labels");
  }
  Json json;
  Eigen::Isometry3d gt_from_est = Eigen::Isometry3d::Identity();
  if (have_poses) {
    const auto error = opp::mapping::trajectoryError(
        readPoses(poses.gt.getValue()), readPoses(poses.est.getValue()), params.trajectory);
    gt_from_est = error.gt_map_from_est_map;
    report(error, "trajectory", as_json.getValue(), json);
  }
  if (have_planes) {
    const auto comparison = opp::mapping::compareFiles(planes.gt.getValue(), planes.est.getValue(),
                                                       params.primitives, gt_from_est);
    report(comparison, "primitives", as_json.getValue(), json);
  }
  if (have_labels) {
    const auto metrics = opp::mapping::compareLabels(
        labels.gt.getValue(), labels.est.getValue(),
        first_region.isSet() ? std::make_optional(first_region.getValue()) : std::nullopt);
    report(metrics, "regions", as_json.getValue(), json);
  }
  if (as_json.getValue()) std::cout << json.dump(2) << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  return opp::apps::runMain(argc, argv, "opp-eval",
                            "Compares an estimate with the truth and prints the errors.", run);
}
