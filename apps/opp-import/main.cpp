// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
// opp-import: folders of public data sets to rawlogs.
#include "opp/mapping/importing/import_plan.h"
#include "opp/mapping/importing/run_import.h"
#include "opp/mapping/io/tum_trajectory.h"

#include "common/flags.h"
#include "common/progress.h"
#include "common/run_main.h"

#include <filesystem>
#include <iostream>

namespace {

namespace fs = std::filesystem;
using opp::apps::UsageError;
using opp::mapping::ImportOptions;
using opp::mapping::ImportPlan;

struct Request {
  opp::mapping::DatasetFormat format{};
  fs::path folder;
  fs::path rawlog;
  ImportOptions options;
  bool quiet = false;
};

std::string presetNames() {
  std::string names;
  for (const auto& preset : opp::mapping::cameraPresets()) names += std::string(preset.name) + ", ";
  return names;
}

Request parse(opp::apps::CommandLine& line) {
  using Text = TCLAP::ValueArg<std::string>;
  using Number = TCLAP::ValueArg<double>;
  Text format("", "format", "tum, icl-nuim, 7scenes, redwood, kitti, pcd or ply", true, "",
              "FORMAT", line);
  opp::apps::InputFlag input(line, "Folder of the data set");
  opp::apps::OutputFlag output(line, "Rawlog; FILE.gt.tum goes beside it if the set has poses",
                               "FILE.rawlog", true);
  Text intrinsics("", "intrinsics",
                  "Of the depth camera: " + presetNames() +
                      "or fx,fy,cx,cy [px]; a negative fy means that rows run upward (default: "
                      "those of the set)",
                  false, "", "NAME|fx,fy,cx,cy", line);
  Number unit("", "depth-unit", "Of a depth count [m] (default: that of the set)", false, 0.0,
              "metres", line);
  Number rate("", "rate", "Of the frames where the set has no times [Hz]", false, 0.0, "HZ", line);
  Text poses("", "poses", "File of true poses (default: where the set has it)", false, "", "FILE",
             line);
  TCLAP::SwitchArg skip("", "skip-missing", "Leave out frames whose file is missing", line);
  opp::apps::ThreadsFlag threads(line);  // every program takes it; reading is sequential
  opp::apps::QuietFlag quiet(line);
  line.parse();

  Request request;
  request.folder = input.getValue();
  request.rawlog = output.getValue();
  request.quiet = quiet.getValue();
  request.options.poses = poses.getValue();
  request.options.skip_missing = skip.getValue();
  if (unit.isSet()) request.options.range_unit = unit.getValue();
  if (rate.isSet()) request.options.rate = rate.getValue();
  try {
    request.format = opp::mapping::datasetFormatFromName(format.getValue());
    if (intrinsics.isSet()) {
      request.options.intrinsics = opp::mapping::intrinsicsFromText(intrinsics.getValue());
    }
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  return request;
}

void run(opp::apps::CommandLine& line) {
  const Request request = parse(line);
  opp::apps::Progress progress("importing", "frames", opp::apps::Progress::modeFor(request.quiet));
  const ImportPlan plan = opp::mapping::planImport(request.format, request.folder, request.options);
  for (const std::string& note : plan.notes) progress.log(note);
  for (const std::string& file : plan.missing) progress.log("left out: " + file);
  if (plan.ground_truth.empty()) progress.log("no true poses: no .gt.tum is written");
  const auto total = static_cast<double>(plan.frames.size());
  opp::mapping::runImport(plan, request.rawlog, [&](std::size_t done) {
    progress.update(static_cast<double>(done) / total, done);
  });
  if (!plan.ground_truth.empty()) {
    fs::path truth = request.rawlog;
    opp::mapping::writeTumTrajectory(truth.replace_extension(".gt.tum"), plan.ground_truth);
  }
  progress.finish();
}

}  // namespace

int main(int argc, char** argv) {
  return opp::apps::runMain(argc, argv, "opp-import",
                            "Turns folders of public data sets into rawlogs with ground truth.",
                            run);
}
