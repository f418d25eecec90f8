// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
// opp-eval: how far an estimate is from the truth.
#include "opp/mapping/core/version.h"
#include "opp/mapping/evaluation/trajectory_error.h"
#include "opp/mapping/io/tum_trajectory.h"

#include "opp-eval/trajectory_report.h"

#include <tclap/CmdLine.h>

#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace {

using opp::mapping::Trajectory;
using Json = nlohmann::ordered_json;

/// What the command line asks for.
struct Options {
  std::string gt;
  std::string est;
  opp::mapping::TrajectoryErrorParams trajectory;
  bool json = false;
};

/// \throws TCLAP::ArgException or TCLAP::ExitException
Options parse(int argc, char** argv) {
  TCLAP::CmdLine cmd("Compares an estimate with ground truth and prints the errors.", ' ',
                     std::string(opp::mapping::version()));
  cmd.setExceptionHandling(false);
  Options options;
  const auto& association = options.trajectory.association;
  TCLAP::ValueArg<std::string> gt("", "gt", "true trajectory (TUM text)", false, "", "FILE.tum",
                                  cmd);
  TCLAP::ValueArg<std::string> est("", "est", "estimated trajectory (TUM text)", false, "",
                                   "FILE.tum", cmd);
  TCLAP::ValueArg<double> max_gap("", "max-interpolation-gap",
                                  "true poses up to this far apart are interpolated between [s]",
                                  false, association.max_interpolation_gap, "seconds", cmd);
  TCLAP::ValueArg<double> max_difference("", "max-time-difference",
                                         "else the nearest true pose within this is taken [s]",
                                         false, association.max_time_difference, "seconds", cmd);
  TCLAP::ValueArg<double> rpe_distance(
      "", "rpe-distance", "path length over which the relative error per metre is taken [m]", false,
      options.trajectory.rpe_distance, "metres", cmd);
  TCLAP::SwitchArg json("", "json", "print JSON instead of a table", cmd);
  cmd.parse(argc, argv);
  if (gt.isSet() != est.isSet()) throw TCLAP::CmdLineParseException("--gt and --est go together");
  if (!gt.isSet()) throw TCLAP::CmdLineParseException("nothing to compare: give --gt and --est");
  options.gt = gt.getValue();
  options.est = est.getValue();
  options.trajectory.association = {max_gap.getValue(), max_difference.getValue()};
  options.trajectory.rpe_distance = rpe_distance.getValue();
  options.json = json.getValue();
  return options;
}

Trajectory readPoses(const std::string& path) {
  Trajectory trajectory = opp::mapping::readTumTrajectory(std::filesystem::path(path));
  if (trajectory.empty()) throw std::runtime_error(path + ": holds no pose; nothing to compare");
  return trajectory;
}

void run(const Options& options) {
  const Trajectory ground_truth = readPoses(options.gt);
  const Trajectory estimate = readPoses(options.est);
  const auto error = opp::mapping::trajectoryError(ground_truth, estimate, options.trajectory);
  if (options.json) {
    std::cout << Json{{"trajectory", opp::mapping::toJson(error)}}.dump(2) << '\n';
  } else {
    opp::mapping::print(std::cout, error);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(parse(argc, argv));
    return 0;
  } catch (const TCLAP::ExitException& exit) {
    return exit.getExitStatus();
  } catch (const TCLAP::ArgException& wrong) {
    std::cerr << "opp-eval: " << wrong.error() << " " << wrong.argId()
              << "\nopp-eval --help lists the flags\n";
    return 2;
  } catch (const std::exception& failure) {
    std::cerr << "opp-eval: " << failure.what() << '\n';
    return 1;
  }
}
