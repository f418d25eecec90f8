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

/// The session that is read next, or the rest of it.
SessionReport& openSession(const std::filesystem::path& rawlog, FeatureStream& stream,
                           MappingRun& run) {
  std::vector<SessionReport>& sessions = run.report.sessions;
  if (sessions.size() > run.sessions_read) {
    stream.skip(sessions.back().frames_read);
  } else {
    sessions.emplace_back().path = rawlog.string();
    run.mapper.startSession();
  }
  return sessions.back();
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

void addWarnings(const RawlogReader& reader, const std::string& path, RunReport& report) {
  if (!reader.damage().empty()) report.warnings.push_back(reader.damage());
  for (const auto& [reason, count] : reader.counts().skipped) {
    report.warnings.push_back(path + ": " + std::to_string(count) +
                              " observations without 3D data: " + reason);
  }
}

std::size_t scansOf(const MapState& map, int session) {
  return static_cast<std::size_t>(
      std::count_if(map.scans.begin(), map.scans.end(),
                    [&](const LocalizedScan& scan) { return scan.session == session; }));
}

double pathLength(const std::map<std::size_t, Eigen::Isometry3d>& poses) {
  double length = 0.0;
  for (auto pose = poses.begin(); pose != poses.end(); ++pose) {
    const auto next = std::next(pose);
    if (next == poses.end()) break;
    length += (next->second.translation() - pose->second.translation()).norm();
  }
  return length;
}

std::size_t loopsOf(const MapState& map, int session) {
  const auto& factors = map.factors.relative_poses;
  const auto isOf = [&](int keyframe) {
    return map.keyframes[static_cast<std::size_t>(keyframe)].features.session == session;
  };
  return static_cast<std::size_t>(std::count_if(
      factors.begin(), factors.end(),
      [&](const RelativePoseFactor& f) { return f.is_loop && (isOf(f.first) || isOf(f.second)); }));
}

void describe(const Mapper& mapper, int id, SessionReport& session) {
  session.frames_used = scansOf(mapper.map(), id);
  for (const MapPart& part : mapper.parts()) session.frames_apart += scansOf(part.map, id);
  session.frames_apart -= session.frames_used;
  session.frames_lost = session.frames_read - session.frames_used - session.frames_apart;
  for (const Keyframe& keyframe : mapper.map().keyframes) {
    if (keyframe.features.session == id) ++session.keyframes;
  }
  session.path_length = pathLength(posesOf(mapper.map(), id));
  session.loop_closures = loopsOf(mapper.map(), id);
}

void warn(const SessionReport& session, std::vector<std::string>& warnings) {
  const std::string of_all = " of " + std::to_string(session.frames_read) + " scans ";
  if (session.frames_lost > 0) {
    warnings.push_back(session.path + ": " + std::to_string(session.frames_lost) + of_all +
                       "could not be localized and are in no map");
  }
  if (session.frames_apart > 0) {
    warnings.push_back(session.path + ": " + std::to_string(session.frames_apart) + of_all +
                       "are in maps of their own (folder parts): nothing proved where they belong");
  }
}

}  // namespace

void mapRawlog(const std::filesystem::path& rawlog, const MapRawlogOptions& options,
               const PrimitiveParams& params, const ProgressCallback& progress, MappingRun& run) {
  RawlogReader reader(rawlog, options.selection);
  FeatureStream stream(reader, params, options.threads);
  Clock::time_point start = Clock::now();
  const int id = static_cast<int>(run.sessions_read);
  SessionReport& session = openSession(rawlog, stream, run);
  while (std::optional<FeatureFrame> frame = stream.next()) {
    const Clock::time_point start_tracking = Clock::now();
    frame->features.session = id;
    session.scans.push_back({frame->features.scan_index, frame->features.timestamp});
    const auto given = poseNear(options.initial_poses, frame->features.timestamp);
    if (given && id == 0 && session.frames_read == 0) run.mapper.setInitialPose(*given);
    run.mapper.add(std::move(frame->features), given ? given : frame->odom_from_body);
    run.report.seconds["registration"] += secondsSince(start_tracking);
    run.report.seconds["frames"] += secondsSince(start);
    ++session.frames_read;
    if (progress) progress(reader.progress(), session.frames_read);
    start = Clock::now();
  }
  session.bytes = std::filesystem::file_size(rawlog);
  session.sha256 = sha256OfFile(rawlog);
  addWarnings(reader, session.path, run.report);
  ++run.sessions_read;
}

void finishMapping(MappingRun& run, int threads) {
  const Clock::time_point start = Clock::now();
  run.mapper.finish(threads);
  run.report.seconds["optimization"] += secondsSince(start);
  int id = 0;
  for (SessionReport& session : run.report.sessions) {
    describe(run.mapper, id++, session);
    warn(session, run.report.warnings);
  }
  run.report.counts["maps"] = run.mapper.parts().size();
  run.report.counts["keyframes"] = run.mapper.map().keyframes.size();
  run.report.counts["loop_closures"] = run.mapper.map().loop_closures;
  run.finished = true;
}

}  // namespace opp::mapping
