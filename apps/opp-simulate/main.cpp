// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/core/move_planar_map.h"
#include "opp/mapping/io/planar_map_json.h"
#include "opp/mapping/io/rawlog_writer.h"
#include "opp/mapping/io/tum_trajectory.h"
#include "opp/mapping/simulation/ground_truth.h"
#include "opp/mapping/simulation/odometry.h"
#include "opp/mapping/simulation/simulator.h"
#include "opp/parallel/parallel_for.h"

#include "common/progress.h"
#include "common/run_main.h"
#include "opp-simulate/request.h"

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <sstream>

namespace {

namespace fs = std::filesystem;
using namespace opp::mapping;
using opp::apps::SimulateRequest;

RawlogDepthImage rawlogImage(const DepthImage& image) {
  const PinholeCamera& camera = image.camera;
  return {camera.width, camera.height,    camera.fx,       camera.fy,   camera.cx,
          camera.cy,    image.range_unit, image.max_range, image.counts};
}

void writeFrame(const SimulatedFrame& frame, const SimulationOptions& options,
                RawlogWriter& rawlog) {
  if (const auto* image = std::get_if<DepthImage>(&frame.data)) {
    rawlog.write({frame.timestamp, "DEPTH", options.body_from_sensor}, rawlogImage(*image));
  } else {
    const auto& scan = std::get<LidarScan>(frame.data);
    rawlog.write({frame.timestamp, "LIDAR", options.body_from_sensor}, scan.points);
  }
}

/// Truth of one frame alone, in the body frame.
PlanarMap truthOf(const Simulator& simulator, const GroundTruthParams& params,
                  const SimulatedFrame& frame) {
  GroundTruth truth(simulator.scene().world, params);
  truth.add(frame, simulator.options().body_from_sensor);
  PlanarMap map = movedPlanarMap(frame.map_from_body.inverse(), truth.map());
  map.frame = "sensor";
  return map;
}

fs::path frameFile(const fs::path& folder, int index) {
  std::ostringstream name;
  name << std::setw(6) << std::setfill('0') << index << ".json";
  return folder / name.str();
}

/// Renders, a batch on all threads at a time, and writes in order.
class Run {
 public:
  Run(const SimulateRequest& request, const Simulator& simulator)
      : request_(request),
        simulator_(simulator),
        params_(GroundTruthParams::forSensor(request.simulation.sensor)),
        truth_(simulator.scene().world, withPixels(params_, request.min_pixels)),
        odometry_({}, request.simulation.planar, request.simulation.seed),
        progress_("simulating " + simulator.scene().name, "frames",
                  opp::apps::Progress::modeFor(request.quiet)) {}

  void write() {
    if (request_.per_frame_truth) fs::create_directories(*request_.per_frame_truth);
    RawlogWriter rawlog(request_.output, request_.rawlog);
    const int batch = opp::resolveThreads(request_.threads);
    for (int first = 0; first < simulator_.frames(); first += batch) {
      writeBatch(first, std::min(batch, simulator_.frames() - first), rawlog);
    }
    fs::path stem = request_.output;
    stem.replace_extension();
    writeTumTrajectory(stem.string() + ".gt.tum", trajectory_);
    writePlanarMap(stem.string() + ".gt.json", truth_.map());
    rawlog.close();
    progress_.finish();
  }

 private:
  static GroundTruthParams& withPixels(GroundTruthParams& params, int min_pixels) {
    params.min_pixels = min_pixels;
    return params;
  }

  void writeBatch(int first, int count, RawlogWriter& rawlog) {
    std::vector<SimulatedFrame> frames(static_cast<std::size_t>(count));
    opp::parallelFor(frames.size(), request_.threads, [&](std::size_t i) {
      frames[i] = simulator_.frame(first + static_cast<int>(i));
      if (!request_.per_frame_truth) return;
      writePlanarMap(frameFile(*request_.per_frame_truth, first + static_cast<int>(i)),
                     truthOf(simulator_, params_, frames[i]));
    });
    for (const SimulatedFrame& frame : frames) {
      if (request_.odometry) writeOdometry(frame, rawlog);
      writeFrame(frame, request_.simulation, rawlog);
      truth_.add(frame, request_.simulation.body_from_sensor);
      trajectory_.push_back({frame.timestamp, frame.map_from_body});
      progress_.update(static_cast<double>(trajectory_.size()) / simulator_.frames(),
                       trajectory_.size());
    }
  }

  /// What wheels would say; they do not feel a kidnapping.
  void writeOdometry(const SimulatedFrame& frame, RawlogWriter& rawlog) {
    const int index = static_cast<int>(trajectory_.size());
    if (index > 0 && !simulator_.kidnappedBefore(index)) {
      odometry_.move(trajectory_.back().map_from_body.inverse() * frame.map_from_body);
    }
    rawlog.writeOdometry(frame.timestamp, odometry_.odomFromBody());
  }

  const SimulateRequest& request_;
  const Simulator& simulator_;
  GroundTruthParams params_;
  GroundTruth truth_;
  DriftingOdometry odometry_;
  opp::apps::Progress progress_;
  Trajectory trajectory_;
};

void run(opp::apps::CommandLine& line) {
  const SimulateRequest request = opp::apps::parseRequest(line);
  const Simulator simulator(loadScene(request.scene), request.simulation);
  Run(request, simulator).write();
}

}  // namespace

int main(int argc, char** argv) {
  return opp::apps::runMain(argc, argv, "opp-simulate",
                            "Makes rawlogs with exact ground truth from simulated scenes.", run);
}
