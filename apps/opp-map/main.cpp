// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
// opp-map: rawlog in, map out.
#include "opp/mapping/export/planar_exports.h"
#include "opp/mapping/export/simplemap.h"
#include "opp/mapping/io/atomic_file.h"
#include "opp/mapping/io/output_folder.h"
#include "opp/mapping/io/parameters.h"
#include "opp/mapping/io/planar_map_json.h"
#include "opp/mapping/io/run_json.h"
#include "opp/mapping/io/tum_trajectory.h"
#include "opp/mapping/pipeline/build_occupancy_map.h"
#include "opp/mapping/pipeline/map_rawlog.h"
#include "opp/mapping/pipeline/mapper.h"
#include "opp/mapping/planar/planar_map_of_landmarks.h"

#include "common/progress.h"
#include "common/run_main.h"
#include "opp-map/options.h"

#include <chrono>
#include <filesystem>
#include <map>
#include <ostream>

namespace {

using opp::apps::MapOptions;

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

opp::mapping::Mapper buildMap(const MapOptions& options, opp::mapping::RunReport& report) {
  opp::mapping::MapRawlogOptions input;
  input.selection = options.selection;
  input.threads = options.threads;
  if (options.initial_poses)
    input.initial_poses = opp::mapping::readTumTrajectory(*options.initial_poses);
  opp::mapping::Mapper mapper(options.params);
  opp::apps::Progress progress("mapping", "frames", opp::apps::Progress::modeFor(options.quiet));
  opp::mapping::mapRawlog(
      options.rawlog, input, options.params.primitives,
      [&](double fraction, std::size_t frames) { progress.update(fraction, frames); }, mapper,
      report);
  progress.finish();
  for (const std::string& warning : report.warnings) progress.log("warning: " + warning);
  return mapper;
}

void writeOccupancyMap(const MapOptions& options, const opp::mapping::Mapper& mapper,
                       opp::mapping::RunReport& report, const std::filesystem::path& folder) {
  const auto start = std::chrono::steady_clock::now();
  opp::apps::Progress progress("octomap", "frames", opp::apps::Progress::modeFor(options.quiet));
  const opp::mapping::OccupancyMap map = opp::mapping::buildOccupancyMap(
      options.rawlog, options.selection, mapper.poses(), options.params.primitives.sensor,
      options.params.occupancy, options.threads,
      [&](double fraction, std::size_t frames) { progress.update(fraction, frames); });
  progress.finish();
  map.write(folder / "map.ot", folder / "map.bt");
  report.seconds["octomap"] = secondsSince(start);
}

void writePlanarMap(const MapOptions& options, const opp::mapping::Mapper& mapper,
                    opp::mapping::RunReport& report, const std::filesystem::path& folder) {
  const auto start = std::chrono::steady_clock::now();
  const opp::mapping::PlanarMap map =
      opp::mapping::planarMapOf(mapper.map(), options.params.planar);
  opp::mapping::writePlanarMap(folder / "planar_map.json", map);
  report.counts["planes"] = map.planes.size();
  report.counts["lines"] = map.lines.size();
  report.counts["corners"] = map.corners.size();
  report.counts["families"] = map.families.size();
  report.seconds["planar_map"] = secondsSince(start);
  const auto export_start = std::chrono::steady_clock::now();
  opp::mapping::writePlanarExports(folder, map, mapper.trajectory(), options.params.planar);
  report.seconds["export"] = secondsSince(export_start);
}

void writeKeyframes(const MapOptions& options, const opp::mapping::Mapper& mapper,
                    opp::mapping::RunReport& report, const std::filesystem::path& folder) {
  const auto start = std::chrono::steady_clock::now();
  std::map<std::size_t, Eigen::Isometry3d> keyframes;
  for (const opp::mapping::Keyframe& keyframe : mapper.map().keyframes) {
    keyframes[keyframe.features.scan_index] = keyframe.map_from_body;
  }
  opp::mapping::writeSimplemap(folder / "map.simplemap", options.rawlog, options.selection,
                               keyframes);
  report.seconds["simplemap"] = secondsSince(start);
}

void writeResults(const MapOptions& options, const opp::mapping::Mapper& mapper,
                  const opp::mapping::RunReport& report, const std::filesystem::path& folder) {
  opp::mapping::writeTumTrajectory(folder / "trajectory.tum", mapper.trajectory());
  opp::mapping::writeFileAtomically(folder / "effective.ini", [&](std::ostream& os) {
    opp::mapping::writeParameters(os, options.params);
  });
  opp::mapping::writeFileAtomically(folder / "run.json", [&](std::ostream& os) {
    opp::mapping::writeRunJson(os, report, options.params);
  });
}

void run(opp::apps::CommandLine& line) {
  const MapOptions options = opp::apps::parseOptions(line);
  opp::mapping::OutputFolder output(options.output, options.force);
  opp::mapping::RunReport report;
  const opp::mapping::Mapper mapper = buildMap(options, report);
  writePlanarMap(options, mapper, report, output.path());
  writeKeyframes(options, mapper, report, output.path());
  if (options.octomap) writeOccupancyMap(options, mapper, report, output.path());
  writeResults(options, mapper, report, output.path());
  output.commit();
}

}  // namespace

int main(int argc, char** argv) {
  return opp::apps::runMain(argc, argv, "opp-map",
                            "Builds a map of planes, lines and corners from a rawlog.", run);
}
