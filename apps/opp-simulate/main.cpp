// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/geometry/constants.h"
#include "opp/mapping/io/planar_map_json.h"
#include "opp/mapping/io/rawlog_writer.h"
#include "opp/mapping/io/tum_trajectory.h"
#include "opp/mapping/simulation/ground_truth.h"
#include "opp/mapping/simulation/simulator.h"
#include "opp/parallel/parallel_for.h"

#include "common/flags.h"
#include "common/progress.h"
#include "common/run_main.h"

#include <filesystem>
#include <iomanip>
#include <iostream>
#include <optional>
#include <sstream>

namespace {

namespace fs = std::filesystem;
using namespace opp::mapping;
using opp::apps::UsageError;

/// What the flags ask for.
struct Request {
  std::string scene;
  SimulationOptions simulation;
  RawlogWriterOptions rawlog;
  fs::path output;
  std::optional<fs::path> per_frame_truth;
  int min_pixels = GroundTruthParams().min_pixels;
  int threads = 0;
  bool quiet = false;
};

/// "x y z yaw pitch roll" in metres and degrees.
Eigen::Isometry3d poseFromText(const std::string& text) {
  std::istringstream words(text);
  double v[6];
  for (double& value : v) words >> value;
  std::string rest;
  if (!words || words >> rest) {
    throw UsageError("--sensor-pose needs six numbers: \"x y z yaw pitch roll\", m and degrees");
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << v[0], v[1], v[2];
  pose.linear() = (Eigen::AngleAxisd(opp::degToRad(v[3]), Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(opp::degToRad(v[4]), Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(opp::degToRad(v[5]), Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  return pose;
}

Request parse(opp::apps::CommandLine& line) {
  using TCLAP::SwitchArg;
  using TCLAP::ValueArg;
  const SimulationOptions none;
  opp::apps::AtLeast at_least_one(1);
  ValueArg<std::string> scene("", "scene", "Built-in scene or scene file (rawlogs/README.md)", true,
                              "", "NAME|FILE.ini", line);
  opp::apps::OutputFlag output(line, "Rawlog; FILE.gt.tum and FILE.gt.json go beside it",
                               "FILE.rawlog", true);
  ValueArg<std::string> sensor("", "sensor", "kinect, ideal, lidar16 or lidar64", false, "kinect",
                               "NAME", line);
  ValueArg<int> frames("", "frames",
                       "Number of frames, spread evenly over the path (default: the scene's)",
                       false, 0, &at_least_one, line);
  ValueArg<double> rate("", "rate", "Frames from the path's start at this rate instead [Hz]", false,
                        0.0, "HZ", line);
  ValueArg<int> passes("", "passes", "Rounds through a closed path", false, 1, &at_least_one, line);
  ValueArg<std::uint64_t> seed("", "seed", "Of noise and of the hand's unrest", false, none.seed,
                               "S", line);
  ValueArg<int> decimation("", "decimation", "Divides width and height of depth images", false, 1,
                           &at_least_one, line);
  ValueArg<std::string> sensor_pose("", "sensor-pose",
                                    "Of the sensor on the body, \"x y z yaw pitch roll\", m, deg",
                                    false, "0 0 0 0 0 0", "POSE", line);
  ValueArg<int> gzip("", "gzip-level", "Of the rawlog, 0 to 9", false, 1, "N", line);
  ValueArg<std::string> per_frame("", "per-frame-gt",
                                  "Folder for the truth of each frame alone, in the body frame",
                                  false, "", "FOLDER", line);
  ValueArg<int> min_pixels("", "min-pixels", "Valid pixels that make a primitive count as seen",
                           false, GroundTruthParams().min_pixels, &at_least_one, line);
  opp::apps::ThreadsFlag threads(line);
  opp::apps::QuietFlag quiet(line);
  line.parse();

  Request request;
  request.scene = scene.getValue();
  request.output = output.getValue();
  request.simulation.frames = frames.getValue();
  request.simulation.rate = rate.getValue();
  request.simulation.passes = passes.getValue();
  request.simulation.seed = seed.getValue();
  request.simulation.decimation = decimation.getValue();
  request.simulation.body_from_sensor = poseFromText(sensor_pose.getValue());
  request.rawlog.compression = gzip.getValue();
  if (per_frame.isSet()) request.per_frame_truth = per_frame.getValue();
  request.min_pixels = min_pixels.getValue();
  request.threads = threads.count();
  request.quiet = quiet.getValue();
  try {
    request.simulation.sensor = simulatedSensorFromName(sensor.getValue());
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  return request;
}

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
  return transformed(frame.map_from_body.inverse(), truth.map(), "sensor");
}

fs::path frameFile(const fs::path& folder, int index) {
  std::ostringstream name;
  name << std::setw(6) << std::setfill('0') << index << ".json";
  return folder / name.str();
}

/// Renders, a batch on all threads at a time, and writes in order.
class Run {
 public:
  Run(const Request& request, const Simulator& simulator)
      : request_(request),
        simulator_(simulator),
        params_(GroundTruthParams::forSensor(request.simulation.sensor)),
        truth_(simulator.scene().world, withPixels(params_, request.min_pixels)),
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
      writeFrame(frame, request_.simulation, rawlog);
      truth_.add(frame, request_.simulation.body_from_sensor);
      trajectory_.push_back({frame.timestamp, frame.map_from_body});
      progress_.update(static_cast<double>(trajectory_.size()) / simulator_.frames(),
                       trajectory_.size());
    }
  }

  const Request& request_;
  const Simulator& simulator_;
  GroundTruthParams params_;
  GroundTruth truth_;
  opp::apps::Progress progress_;
  Trajectory trajectory_;
};

void run(opp::apps::CommandLine& line) {
  const Request request = parse(line);
  const Simulator simulator(loadScene(request.scene), request.simulation);
  Run(request, simulator).write();
}

}  // namespace

int main(int argc, char** argv) {
  return opp::apps::runMain(argc, argv, "opp-simulate",
                            "Makes rawlogs with exact ground truth from simulated scenes.", run);
}
