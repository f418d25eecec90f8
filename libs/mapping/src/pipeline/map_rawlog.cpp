// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/pipeline/map_rawlog.h"

#include "opp/mapping/io/sha256.h"
#include "opp/mapping/pipeline/feature_stream.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

namespace opp::mapping {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double pathLength(const Trajectory& trajectory) {
  double length = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    length +=
        (trajectory[i].map_from_body.translation() - trajectory[i - 1].map_from_body.translation())
            .norm();
  }
  return length;
}

/// Predictions are for a scan if their stamps agree this well [s]: text files round stamps.
constexpr double kSameTime = 1e-3;

std::optional<Eigen::Isometry3d> poseNear(const Trajectory& trajectory, double timestamp) {
  const auto pose =
      std::lower_bound(trajectory.begin(), trajectory.end(), timestamp - kSameTime,
                       [](const StampedPose& p, double time) { return p.timestamp < time; });
  if (pose == trajectory.end() || pose->timestamp > timestamp + kSameTime) return std::nullopt;
  return pose->map_from_body;
}

void addWarnings(const RawlogReader& reader, const SessionReport& session, RunReport& report) {
  if (!reader.damage().empty()) report.warnings.push_back(reader.damage());
  for (const auto& [reason, count] : reader.counts().skipped) {
    report.warnings.push_back(session.path + ": " + std::to_string(count) +
                              " observations without 3D data: " + reason);
  }
  if (session.frames_lost > 0) {
    report.warnings.push_back(session.path + ": " + std::to_string(session.frames_lost) + " of " +
                              std::to_string(session.frames_read) +
                              " scans could not be localized and are not in the map");
  }
}

}  // namespace

void mapRawlog(const std::filesystem::path& rawlog, const MapRawlogOptions& options,
               const PrimitiveParams& params, const ProgressCallback& progress, Mapper& mapper,
               RunReport& report) {
  RawlogReader reader(rawlog, options.selection);
  FeatureStream stream(reader, params, options.threads);
  SessionReport session;
  session.path = rawlog.string();
  const Clock::time_point start = Clock::now();
  double seconds_tracking = 0.0;
  while (std::optional<FeatureFrame> frame = stream.next()) {
    const Clock::time_point start_tracking = Clock::now();
    const auto given = poseNear(options.initial_poses, frame->features.timestamp);
    if (given && session.frames_read == 0) mapper.setInitialPose(*given);
    const FrameResult result =
        mapper.add(std::move(frame->features), given ? given : frame->odom_from_body);
    seconds_tracking += secondsSince(start_tracking);
    ++session.frames_read;
    ++(result.localized ? session.frames_used : session.frames_lost);
    if (progress) progress(reader.progress(), session.frames_read);
  }
  const Clock::time_point start_finish = Clock::now();
  mapper.finish();
  report.seconds["optimization"] += secondsSince(start_finish);
  report.seconds["registration"] += seconds_tracking;
  report.seconds["frames"] += secondsSince(start);
  session.bytes = std::filesystem::file_size(rawlog);
  session.sha256 = sha256OfFile(rawlog);
  session.keyframes = mapper.map().keyframes.size();
  session.path_length = pathLength(mapper.trajectory());
  addWarnings(reader, session, report);
  report.sessions.push_back(std::move(session));
}

}  // namespace opp::mapping
