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
#include "opp/mapping/pipeline/mapping_run.h"
#include "opp/mapping/pipeline/report_figures.h"
#include "opp/mapping/planar/planar_map_of_landmarks.h"
#include "opp/mapping/report/html_report.h"

#include "common/progress.h"
#include "common/run_main.h"
#include "opp-map/options.h"

#include <chrono>
#include <filesystem>
#include <ostream>
#include <vector>

namespace {

using opp::apps::MapOptions;

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

using opp::mapping::MappingRun;
using opp::mapping::MapState;
using opp::mapping::RunReport;

void buildMap(const MapOptions& options, MappingRun& run) {
  opp::mapping::MapRawlogOptions input;
  input.selection = options.selection;
  input.threads = options.threads;
  if (options.initial_poses)
    input.initial_poses = opp::mapping::readTumTrajectory(*options.initial_poses);
  opp::apps::Progress progress("mapping", "frames", opp::apps::Progress::modeFor(options.quiet));
  for (const std::filesystem::path& rawlog : options.rawlogs) {
    opp::mapping::mapRawlog(
        rawlog, input, options.params.primitives,
        [&](double fraction, std::size_t frames) { progress.update(fraction, frames); }, run);
  }
  opp::mapping::finishMapping(run);
  progress.finish();
  for (const std::string& warning : run.report.warnings) progress.log("warning: " + warning);
}

void writeOccupancyMap(const MapOptions& options, const MapState& map, RunReport& report,
                       const std::filesystem::path& folder) {
  const auto start = std::chrono::steady_clock::now();
  opp::apps::Progress progress("octomap", "frames", opp::apps::Progress::modeFor(options.quiet));
  opp::mapping::OccupancyMap octomap(options.params.occupancy);
  for (std::size_t session = 0; session < options.rawlogs.size(); ++session) {
    opp::mapping::insertRawlog(
        options.rawlogs[session], options.selection,
        opp::mapping::posesOf(map, static_cast<int>(session)), options.params.primitives.sensor,
        options.threads,
        [&](double fraction, std::size_t frames) { progress.update(fraction, frames); }, octomap);
  }
  progress.finish();
  octomap.write(folder / "map.ot", folder / "map.bt");
  report.seconds["octomap"] = secondsSince(start);
}

/// The files that tell of one map, as opposed to the run.
opp::mapping::PlanarMap writeMap(const MapOptions& options, const MapState& map,
                                 const std::filesystem::path& folder) {
  const opp::mapping::PlanarMap planar =
      opp::mapping::planarMapOf(map, options.params.primitives.sensor, options.params.planar);
  const opp::mapping::Trajectory trajectory = opp::mapping::trajectoryOf(map);
  opp::mapping::writeTumTrajectory(folder / "trajectory.tum", trajectory);
  opp::mapping::writePlanarMap(folder / "planar_map.json", planar);
  opp::mapping::writePlanarExports(folder, planar, trajectory, options.params.planar);
  return planar;
}

/// The planar maps of the parts, the main map first.
std::vector<opp::mapping::PlanarMap> writeMaps(const MapOptions& options, MappingRun& run,
                                               const std::filesystem::path& folder) {
  const auto start = std::chrono::steady_clock::now();
  const opp::mapping::Mapper& mapper = run.mapper;
  RunReport& report = run.report;
  std::vector<opp::mapping::PlanarMap> maps = {writeMap(options, mapper.map(), folder)};
  const opp::mapping::PlanarMap& map = maps.front();
  report.counts["planes"] = map.planes.size();
  report.counts["lines"] = map.lines.size();
  report.counts["corners"] = map.corners.size();
  report.counts["families"] = map.families.size();
  for (std::size_t p = 1; p < mapper.parts().size(); ++p) {
    const std::filesystem::path part = folder / "parts" / std::to_string(p);
    std::filesystem::create_directories(part);
    maps.push_back(writeMap(options, mapper.parts()[p].map, part));
  }
  report.seconds["export"] = secondsSince(start);
  return maps;
}

void writeKeyframes(const MapOptions& options, const MapState& map, RunReport& report,
                    const std::filesystem::path& folder) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<opp::mapping::SimplemapSource> sources;
  for (const std::filesystem::path& rawlog : options.rawlogs) sources.push_back({rawlog, {}});
  for (const opp::mapping::Keyframe& keyframe : map.keyframes) {
    sources[static_cast<std::size_t>(keyframe.features.session)]
        .keyframes[keyframe.features.scan_index] = keyframe.map_from_body;
  }
  opp::mapping::writeSimplemap(folder / "map.simplemap", sources, options.selection);
  report.seconds["simplemap"] = secondsSince(start);
}

void writeRun(const MapOptions& options, const RunReport& report,
              const std::filesystem::path& folder) {
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
  MappingRun mapped(options.params);
  buildMap(options, mapped);
  const auto maps = writeMaps(options, mapped, output.path());
  writeKeyframes(options, mapped.mapper.map(), mapped.report, output.path());
  if (options.octomap)
    writeOccupancyMap(options, mapped.mapper.map(), mapped.report, output.path());
  writeRun(options, mapped.report, output.path());
  opp::mapping::writeHtmlReport(
      output.path(),
      opp::mapping::reportFigures(mapped.mapper, mapped.report, maps, options.params.planar));
  output.commit();
}

}  // namespace

int main(int argc, char** argv) {
  return opp::apps::runMain(argc, argv, "opp-map",
                            "Builds a map of planes, lines and corners from rawlogs.", run);
}
