// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
// opp-detect: one cloud or one observation in, primitives out.
#include "opp/cloud/oriented_cloud.h"
#include "opp/detect_primitives.h"
#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/export/scene_file.h"
#include "opp/mapping/io/cloud_file.h"
#include "opp/mapping/io/planar_map_json.h"
#include "opp/mapping/planar/planar_map_of_scan.h"
#include "opp/primitives/label_points.h"

#include "common/flags.h"
#include "common/read_input.h"
#include "common/run_main.h"

#include <chrono>
#include <filesystem>

namespace {

using opp::apps::CommandLine;
using opp::mapping::MapperParams;

/// What the flags ask for.
struct Request {
  std::filesystem::path input, output, labels, scene;
  int index = 0;
  int threads = 0;
};

/// The cloud of one scan and all that was found in it.
struct Detection {
  opp::mapping::Scan scan;
  opp::OrientedCloud samples;
  opp::Primitives primitives;
  opp::mapping::DetectionSummary summary;
};

Request parse(CommandLine& line, opp::apps::ParameterFlags& parameters, MapperParams& params) {
  opp::apps::InputFlag input(line, "Cloud (.ply, .pcd, .xyz) or rawlog");
  opp::apps::OutputFlag output(line, "Planes, lines and corners", "FILE.json", true);
  opp::apps::AtLeast not_negative(0);
  TCLAP::ValueArg<int> index("", "index", "Which 3D observation of a rawlog (default: 0)", false, 0,
                             &not_negative, line);
  TCLAP::ValueArg<std::string> labels("", "labels",
                                      "Write the input's points with the id of their plane "
                                      "(-1: none)",
                                      false, "", "FILE.ply", line);
  TCLAP::ValueArg<std::string> scene("", "scene", "Write a scene for MRPT's SceneViewer3D", false,
                                     "", "FILE.3Dscene", line);
  opp::apps::ThreadsFlag threads(line);
  line.parse();
  Request request{input.getValue(), output.getValue(), labels.getValue(),
                  scene.getValue(), index.getValue(),  threads.count()};
  if (index.isSet() && !opp::apps::isRawlog(request.input)) {
    throw opp::apps::UsageError("--index is for rawlogs; a cloud file holds one cloud");
  }
  if (!opp::apps::isRawlog(request.input)) opp::apps::openRange(params.primitives.sensor);
  parameters.applyTo(params);
  return request;
}

double milliseconds(double seconds) { return 1e3 * seconds; }

Detection detect(opp::mapping::Scan scan, const MapperParams& params, int threads) {
  opp::StageTimings seconds;
  const auto start = std::chrono::steady_clock::now();
  const auto& primitive_params = params.primitives;
  opp::ScanSurface surface = opp::makeScanSurface(scan.cloud_in_body, primitive_params.sensor,
                                                  primitive_params.sampling, &seconds);
  opp::Primitives primitives =
      opp::detectPrimitives(scan.cloud_in_body, surface, primitive_params, threads, &seconds);
  const std::chrono::duration<double> total = std::chrono::steady_clock::now() - start;
  opp::mapping::DetectionSummary summary;
  summary.points = scan.cloud_in_body.size();
  summary.timings_ms = {
      {"normals", milliseconds(seconds.normals)}, {"sampling", milliseconds(seconds.sampling)},
      {"voting", milliseconds(seconds.voting)},   {"clustering", milliseconds(seconds.clustering)},
      {"narrow", milliseconds(seconds.narrow)},   {"refinement", milliseconds(seconds.refinement)},
      {"lines", milliseconds(seconds.lines)},     {"corners", milliseconds(seconds.corners)},
      {"total", milliseconds(total.count())}};
  return {std::move(scan), std::move(surface.samples), std::move(primitives), std::move(summary)};
}

void write(const Request& request, const MapperParams& params, const Detection& found) {
  const opp::mapping::PlanarMap map = opp::mapping::planarMapOfScan(
      found.samples, found.primitives, params.planar, found.scan.timestamp);
  if (!request.labels.empty()) {
    const opp::PointCloud& cloud = found.scan.cloud_in_body;
    opp::mapping::writeLabeledPly(
        request.labels, cloud,
        opp::labelPoints(cloud, found.samples, found.primitives, params.primitives));
  }
  if (!request.scene.empty()) opp::mapping::writeScene(request.scene, map, {});
  opp::mapping::writePlanarMap(request.output, map, &found.summary);
}

void run(CommandLine& line) {
  opp::apps::ParameterFlags parameters(line);
  MapperParams params;
  const Request request = parse(line, parameters, params);
  write(request, params,
        detect(opp::apps::readInput(request.input, request.index), params, request.threads));
}

}  // namespace

int main(int argc, char** argv) {
  return opp::apps::runMain(argc, argv, "opp-detect",
                            "Finds planes, lines and corners in one cloud or observation.", run);
}
