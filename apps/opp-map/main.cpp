// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
// opp-map: rawlog in, map out.
#include "opp/mapping/checkpoint/checkpointer.h"
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
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using opp::apps::MapOptions;
using opp::apps::Progress;

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

using opp::mapping::Checkpointer;
using opp::mapping::MappingRun;
using opp::mapping::MapState;
using opp::mapping::RunReport;

/// Takes up what an interrupted run came to, if there is any.
void resume(const MapOptions& options, const Checkpointer& checkpoints, MappingRun& run) {
  Progress progress("resuming", "frames", Progress::modeFor(options.quiet));
  if (!checkpoints.restore(run)) {
    progress.log("nothing to resume in " + options.output.string() +
                 ": starting from the beginning");
  } else if (run.finished) {
    progress.log("resuming: all is mapped, results are to be written");
  } else {
    const opp::mapping::SessionReport& session = run.report.sessions.back();
    progress.log("resuming after " + std::to_string(session.frames_read) + " frames of " +
                 session.path);
  }
}

/// Without a checkpoint, for want of space say, the run does its work all the same.
template <typename Write>
void tryCheckpoint(Progress& progress, const Write& write) {
  try {
    write();
  } catch (const std::runtime_error& error) {
    progress.log(std::string("warning: no checkpoint for --resume: ") + error.what());
  }
}

void buildMap(const MapOptions& options, Checkpointer& checkpoints, MappingRun& run) {
  if (run.finished) return;
  opp::mapping::MapRawlogOptions input;
  input.selection = options.selection;
  input.threads = options.threads;
  if (options.initial_poses)
    input.initial_poses = opp::mapping::readTumTrajectory(*options.initial_poses);
  Progress progress("mapping", "frames", Progress::modeFor(options.quiet));
  const auto after_scan = [&](double fraction, std::size_t frames) {
    progress.update(fraction, frames);
    tryCheckpoint(progress, [&] { checkpoints.update(run); });
  };
  while (run.sessions_read < options.rawlogs.size()) {
    opp::mapping::mapRawlog(options.rawlogs[run.sessions_read], input, options.params.primitives,
                            after_scan, run);
  }
  opp::mapping::finishMapping(run, options.threads);
  tryCheckpoint(progress, [&] { checkpoints.save(run); });
  progress.finish();
  for (const std::string& warning : run.report.warnings) progress.log("warning: " + warning);
}

void writeOccupancyMap(const MapOptions& options, const MapState& map, RunReport& report,
                       const std::filesystem::path& folder) {
  const auto start = std::chrono::steady_clock::now();
  Progress progress("octomap", "frames", Progress::modeFor(options.quiet));
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

void writeResults(const MapOptions& options, MappingRun& run, const std::filesystem::path& folder) {
  const auto maps = writeMaps(options, run, folder);
  writeKeyframes(options, run.mapper.map(), run.report, folder);
  if (options.octomap) writeOccupancyMap(options, run.mapper.map(), run.report, folder);
  writeRun(options, run.report, folder);
  opp::mapping::writeHtmlReport(
      folder, opp::mapping::reportFigures(run.mapper, run.report, maps, options.params.planar));
}

void run(opp::apps::CommandLine& line) {
  const MapOptions options = opp::apps::parseOptions(line);
  opp::mapping::OutputFolder output(options.output, options.force, options.resume);
  MappingRun mapped(options.params);
  Checkpointer checkpoints(output.checkpoint(),
                           opp::mapping::identityOf(options.rawlogs, options.initial_poses,
                                                    options.selection, options.params),
                           options.params.checkpoint);
  if (options.resume) resume(options, checkpoints, mapped);
  try {
    buildMap(options, checkpoints, mapped);
    writeResults(options, mapped, output.path());
    output.commit();
  } catch (const std::exception& error) {
    if (!std::filesystem::exists(output.checkpoint())) throw;
    throw std::runtime_error(
        opp::apps::userMessage(error) +
        "; when that is mended, the same call with --resume goes on from here");
  }
}

}  // namespace

int main(int argc, char** argv) {
  return opp::apps::runMain(argc, argv, "opp-map",
                            "Builds a map of planes, lines and corners from rawlogs.", run);
}
