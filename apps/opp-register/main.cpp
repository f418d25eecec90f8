// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
// opp-register: two clouds or observations in, the pose between them out.
#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/core/scan_features.h"
#include "opp/mapping/io/atomic_file.h"
#include "opp/mapping/registration/register_scans.h"

#include "common/flags.h"
#include "common/read_input.h"
#include "common/run_main.h"
#include "opp-register/read_pose.h"
#include "opp-register/registration_json.h"

#include <filesystem>
#include <iostream>
#include <map>
#include <optional>

namespace {

using opp::apps::CommandLine;
using opp::mapping::MapperParams;
using opp::mapping::RegistrationMode;

/// A cloud file, or one observation of a rawlog.
struct Place {
  std::filesystem::path file;
  int index = 0;
};

/// What the flags ask for.
struct Request {
  Place target, source;
  std::filesystem::path initial, output;
  RegistrationMode mode = RegistrationMode::kAuto;
  int threads = 0;
};

/// A cloud as it was read, and what was found in it.
struct Side {
  opp::PointCloud raw;
  opp::mapping::ScanFeatures features;
  bool known_view = true;

  opp::mapping::AlignmentInput input() const {
    return known_view ? opp::mapping::AlignmentInput(features)
                      : opp::mapping::inputOfUnknownView(features, raw);
  }
};

const std::map<std::string, RegistrationMode> kModes = {{"auto", RegistrationMode::kAuto},
                                                        {"corners", RegistrationMode::kCorners},
                                                        {"icp", RegistrationMode::kIcp}};

Request parse(CommandLine& line, opp::apps::ParameterFlags& parameters, MapperParams& params) {
  TCLAP::ValueArg<std::string> target("", "target", "Cloud (.ply, .pcd, .xyz) or rawlog that stays",
                                      true, "", "FILE", line);
  TCLAP::ValueArg<std::string> source("", "source", "Cloud or rawlog that is moved onto the target",
                                      true, "", "FILE", line);
  opp::apps::AtLeast not_negative(0);
  TCLAP::ValueArg<int> target_index("", "target-index",
                                    "Which 3D observation, if the target is a rawlog (default: 0)",
                                    false, 0, &not_negative, line);
  TCLAP::ValueArg<int> source_index("", "source-index", "The same for the source (default: 0)",
                                    false, 0, &not_negative, line);
  TCLAP::ValueArg<std::string> initial("", "initial",
                                       "First guess of target_from_source: a text file with the "
                                       "16 numbers of a 4x4 matrix, row by row",
                                       false, "", "FILE", line);
  std::vector<std::string> names = {"auto", "corners", "icp"};
  TCLAP::ValuesConstraint<std::string> allowed(names);
  TCLAP::ValueArg<std::string> mode(
      "", "mode",
      "icp: from the initial guess; corners: corner-assisted ICP, with or without a guess; auto "
      "(default): near the guess if there is one, else or if that fails anywhere",
      false, "auto", &allowed, line);
  opp::apps::OutputFlag output(line, "The answer (default: standard output)", "FILE.json", false);
  opp::apps::ThreadsFlag threads(line);
  line.parse();
  const auto check = [](const TCLAP::ValueArg<int>& flag, const std::string& file) {
    if (!flag.isSet() || opp::apps::isRawlog(file)) return;
    throw opp::apps::UsageError("--" + flag.getName() +
                                " is for rawlogs; a cloud file holds one cloud");
  };
  check(target_index, target.getValue());
  check(source_index, source.getValue());
  if (!opp::apps::isRawlog(target.getValue()) && !opp::apps::isRawlog(source.getValue())) {
    opp::apps::openRange(params.primitives.sensor);
  }
  parameters.applyTo(params);
  return {{target.getValue(), target_index.getValue()},
          {source.getValue(), source_index.getValue()},
          initial.getValue(),
          output.getValue(),
          kModes.at(mode.getValue()),
          threads.count()};
}

Side detect(const Place& place, const MapperParams& params, int threads) {
  Side side;
  side.raw = opp::apps::readInput(place.file, place.index).cloud_in_body;
  side.known_view = opp::apps::isRawlog(place.file);
  side.features = opp::mapping::detectFeatures(side.raw, params.primitives, threads);
  return side;
}

void run(CommandLine& line) {
  opp::apps::ParameterFlags parameters(line);
  MapperParams params;
  const Request request = parse(line, parameters, params);
  std::optional<Eigen::Isometry3d> initial;
  if (!request.initial.empty()) initial = opp::apps::readPose(request.initial);
  const Side target = detect(request.target, params, request.threads);
  const Side source = detect(request.source, params, request.threads);
  const std::string json = opp::apps::formatRegistration(
      opp::mapping::registerScans(target.input(), source.input(), initial, request.mode,
                                  params.primitives.sensor, params.global_alignment,
                                  params.corner_icp),
      target.features.primitives_in_body, source.features.primitives_in_body);
  if (request.output.empty()) {
    std::cout << json;
  } else {
    opp::mapping::writeFileAtomically(request.output, [&](std::ostream& os) { os << json; });
  }
}

}  // namespace

int main(int argc, char** argv) {
  return opp::apps::runMain(argc, argv, "opp-register",
                            "Finds the pose that moves one cloud or observation onto another.",
                            run);
}
