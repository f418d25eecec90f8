// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp-simulate/request.h"

#include "opp/geometry/constants.h"

#include "common/flags.h"

#include <array>
#include <sstream>
#include <stdexcept>

namespace opp::apps {
namespace {

using namespace mapping;

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

/// "FROM:TO" as two shares of the way.
std::array<double, 2> sharesFromText(const std::string& text) {
  std::istringstream words(text);
  std::array<double, 2> shares{};
  char colon = 0;
  std::string rest;
  if (!(words >> shares[0] >> colon >> shares[1]) || colon != ':' || words >> rest) {
    throw UsageError("--kidnap needs two shares of the way, as in 0.4:0.6");
  }
  return shares;
}

/// The flags of SPEC.md and the finer ones; each is a TCLAP argument that attaches itself.
struct Flags {
  explicit Flags(CommandLine& line)
      : scene("", "scene", "Built-in scene or scene file (see rawlogs/README.md)", true, "",
              "NAME|FILE.ini", line),
        output(line, "Rawlog; FILE.gt.tum and FILE.gt.json go beside it", "FILE.rawlog", true),
        sensor("", "sensor", "kinect (default), ideal, lidar16 or lidar64", false, "kinect", "NAME",
               line),
        frames("", "frames", "Number of frames, even over the path (default: the scene's)", false,
               0, &at_least_one, line),
        rate("", "rate", "Frames from the path's start on at this rate instead [Hz]", false, 0.0,
             "HZ", line),
        passes("", "passes", "Rounds through a closed path", false, 1, &at_least_one, line),
        seed("", "seed", "Of noise and of the hand's unrest", false, SimulationOptions().seed, "S",
             line),
        decimation("", "decimation", "Divides width and height of depth images", false, 1,
                   &at_least_one, line),
        odometry("", "odometry",
                 "Drifting odometry: planar readings, or increments in 3D with --format actions",
                 line),
        planar("", "planar", "The body drives on the floor, level; see --sensor-pose", line),
        sensor_pose("", "sensor-pose",
                    "Of the sensor on the body, \"x y z yaw pitch roll\" in m and degrees", false,
                    "0 0 0 0 0 0", "POSE", line),
        drop_rate("", "drop-rate", "Share of frames that get lost", false, 0.0, "P", line),
        kidnap("", "kidnap", "Carries the body unseen over this part of the way, as in 0.4:0.6",
               false, "", "FROM:TO", line),
        format("", "format", "observations (default) or actions (action, sensory frame pairs)",
               false, "observations", "NAME", line),
        gzip("", "gzip-level", "Of the rawlog, 0 to 9", false, 1, "N", line),
        per_frame("", "per-frame-gt", "Folder for the truth of each frame alone, in the body frame",
                  false, "", "FOLDER", line),
        min_pixels("", "min-pixels", "Valid pixels that make a primitive count as seen", false,
                   GroundTruthParams().min_pixels, &at_least_one, line),
        threads(line),
        quiet(line) {}

  SimulationOptions simulation() const;

  AtLeast at_least_one{1};
  mutable TCLAP::ValueArg<std::string> scene;  // mutable: getValue of TCLAP 1.2 is not const
  mutable OutputFlag output;
  mutable TCLAP::ValueArg<std::string> sensor;
  mutable TCLAP::ValueArg<int> frames;
  mutable TCLAP::ValueArg<double> rate;
  mutable TCLAP::ValueArg<int> passes;
  mutable TCLAP::ValueArg<std::uint64_t> seed;
  mutable TCLAP::ValueArg<int> decimation;
  mutable TCLAP::SwitchArg odometry;
  mutable TCLAP::SwitchArg planar;
  mutable TCLAP::ValueArg<std::string> sensor_pose;
  mutable TCLAP::ValueArg<double> drop_rate;
  mutable TCLAP::ValueArg<std::string> kidnap;
  mutable TCLAP::ValueArg<std::string> format;
  mutable TCLAP::ValueArg<int> gzip;
  mutable TCLAP::ValueArg<std::string> per_frame;
  mutable TCLAP::ValueArg<int> min_pixels;
  ThreadsFlag threads;
  mutable QuietFlag quiet;
};

SimulationOptions Flags::simulation() const {
  SimulationOptions options;
  try {
    options.sensor = simulatedSensorFromName(sensor.getValue());
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  options.frames = frames.getValue();
  options.rate = rate.getValue();
  options.passes = passes.getValue();
  options.seed = seed.getValue();
  options.decimation = decimation.getValue();
  options.planar = planar.getValue();
  options.body_from_sensor = poseFromText(sensor_pose.getValue());
  options.drop_rate = drop_rate.getValue();
  if (kidnap.isSet()) options.kidnap = sharesFromText(kidnap.getValue());
  return options;
}

}  // namespace

SimulateRequest parseRequest(CommandLine& line) {
  const Flags flags(line);
  line.parse();
  const std::string format = flags.format.getValue();
  if (format != "observations" && format != "actions") {
    throw UsageError("--format is observations or actions");
  }
  SimulateRequest request;
  request.scene = flags.scene.getValue();
  request.simulation = flags.simulation();
  request.rawlog.action_format = format == "actions";
  request.rawlog.compression = flags.gzip.getValue();
  request.output = flags.output.getValue();
  request.odometry = flags.odometry.getValue();
  if (flags.per_frame.isSet()) request.per_frame_truth = flags.per_frame.getValue();
  request.min_pixels = flags.min_pixels.getValue();
  request.threads = flags.threads.count();
  request.quiet = flags.quiet.getValue();
  return request;
}

}  // namespace opp::apps
