// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/open_passage.h"

#include "frontend/motion_smoother.h"
#include "registration/observability.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <utility>

namespace opp::mapping {
namespace {

using Index = std::size_t;

/// Scans after which a velocity is known about as well as accelerations allow.
constexpr Index kEnoughScans = 4;

/// So certain is a frame of itself [1/rad², 1/m²].
constexpr double kExact = 1e12;

std::vector<const MotionStep*> stepsOf(const std::vector<PassedScan>& scans) {
  std::vector<const MotionStep*> steps;
  for (const PassedScan& scan : scans) steps.push_back(&scan.step);
  return steps;
}

/// Of the keyframe where a leg begins. \param ends of all legs, in the frame where the passage
/// starts
Eigen::Isometry3d startFromFirst(const std::vector<MotionState>& ends, Index leg) {
  return leg > 0 ? ends[leg - 1].map_from_body : Eigen::Isometry3d::Identity();
}

/// What the legs would leave open if they were independent, in the frame where the passage starts.
/// \param own of each leg alone, in the frame of its first keyframe
Matrix6d composed(const std::vector<MotionState>& ends, const std::vector<MotionState>& own) {
  Matrix6d covariance = Matrix6d::Zero();
  for (Index k = 0; k < ends.size(); ++k) {
    const Eigen::Isometry3d start_from_first = startFromFirst(ends, k);
    const Matrix6d swing =
        movedBy(ends[k].map_from_body.translation() - start_from_first.translation());
    const Matrix6d turn = turned(start_from_first.linear());
    covariance =
        swing * covariance * swing.transpose() + turn * own[k].poseCovariance() * turn.transpose();
  }
  return covariance;
}

/// By how much the variances of legs must grow so that together they are as certain as the whole.
double inflation(const Matrix6d& whole, const Matrix6d& legs) {
  double factor = 1.0;
  for (const int kind : {0, 3})
    factor = std::max(factor,
                      whole.block<3, 3>(kind, kind).trace() / legs.block<3, 3>(kind, kind).trace());
  return factor;
}

void replaceMotion(const PosePrior& motion, PosePrior& tied, RelativePoseFactor& tie) {
  const auto pull = [&](const PosePrior& prior) -> Vector6d {
    return prior.information * difference(tie.first_from_second, prior.map_from_body);
  };
  const Vector6d change = pull(motion) - pull(tied);
  tie.information += motion.information - tied.information;
  tie.first_from_second = retract(tie.first_from_second, tie.information.ldlt().solve(change));
  tied = motion;
}

/// Places all scans but the last one. \param last of that one, in the frame of the keyframe before
/// \param next the keyframe that the last one is; −1: it is none
void smoothScans(const std::vector<PassedScan>& scans, const MotionState& last, int next,
                 MapState& map) {
  const std::vector<SmoothedState> smoothed = smoothedStates(stepsOf(scans), last);
  const PosePrior end = last.pose();
  for (Index k = 0; k + 1 < scans.size(); ++k) {
    if (!scans[k].scan) continue;
    LocalizedScan& scan = map.scans[*scans[k].scan];
    scan.keyframe_from_body = smoothed[k].state.map_from_body;
    OpenPose& open = scan.open.emplace();
    open.covariance = smoothed[k].state.poseCovariance();
    if (next < 0) continue;
    const Matrix6d shared = (smoothed[k].by_last * last.covariance).topLeftCorner<6, 6>();
    open.next = next;
    open.keyframe_from_next = end.map_from_body;
    open.gain = shared * end.information;
    open.covariance_between = open.covariance - open.gain * shared.transpose();
  }
}

}  // namespace

void settlePassed(std::vector<PassedScan> scans, const PassedScan& known, MapState& map) {
  scans.push_back(known);
  smoothScans(scans, known.step.found, -1, map);
}

void OpenPassage::reach(Leg leg) {
  later_.clear();
  legs_.push_back(std::move(leg));
}

void OpenPassage::follow(const StampedPose& later, const Matrix6d& information) {
  later_.push_back({later, information});
}

bool OpenPassage::isFollowed() const { return later_.size() >= kEnoughScans; }

/// Of the last keyframe in its own frame, by what followed.
std::optional<MotionState> OpenPassage::stateAfter(const FrontendParams& params) const {
  if (later_.empty()) return std::nullopt;
  // Time runs backwards from the last scan to the keyframe.
  MotionModel back(params);
  for (auto scan = later_.rbegin(); scan != later_.rend(); ++scan)
    back.update({-scan->pose.timestamp, scan->pose.map_from_body}, std::nullopt, scan->information);
  back.update({-legs_.back().timestamp, Eigen::Isometry3d::Identity()}, std::nullopt,
              kExact * Matrix6d::Identity());
  MotionState state = back.state();
  state.rate = (-state.rate).eval();
  return state;
}

/// Of the keyframes, in the frame where the passage starts.
std::vector<MotionState> OpenPassage::endsOfLegs(const std::optional<MotionState>& after) const {
  std::vector<MotionStep> chain(1);
  for (const Leg& leg : legs_) {
    // The last scan tells of its keyframe by itself, too.
    const MotionStep& last = leg.scans.back().step;
    const MotionWay way =
        wayOf(leg.begins, stepsOf(leg.scans), &leg == &legs_.back() ? last.predicted : last.found);
    if (&leg == &legs_.front()) {
      chain.front().found = way.begin;
      chain.push_back({way.end, way.shared, way.end});
    } else {
      chain.push_back(continued(leg.begins, way, chain.back().found));
    }
  }
  std::vector<const MotionStep*> steps;
  for (const MotionStep& step : chain) steps.push_back(&step);
  MotionState last = chain.back().predicted;
  if (after) last = givenRate(last, inFrame(last.map_from_body, *after));
  std::vector<MotionState> ends;
  for (const SmoothedState& smoothed : smoothedStates(steps, last)) ends.push_back(smoothed.state);
  ends.erase(ends.begin());
  return ends;
}

PosePrior OpenPassage::smoothed(const FrontendParams& params) const {
  return endsOfLegs(stateAfter(params)).back().pose();
}

void OpenPassage::tighten(const FrontendParams& params, MapState& map) {
  const std::optional<MotionState> after = stateAfter(params);
  const std::vector<MotionState> ends = endsOfLegs(after);
  std::vector<MotionState> own;
  for (Index k = 0; k < legs_.size(); ++k) {
    own.push_back(legs_[k].scans.back().step.predicted);
    if (!after) continue;
    const bool is_last = k + 1 == legs_.size();
    own.back() =
        givenRate(own.back(), is_last ? inFrame(own.back().map_from_body, *after)
                                      : inFrame(startFromFirst(ends, k).inverse(), ends[k]));
  }
  const double factor = inflation(ends.back().poseCovariance(), composed(ends, own));
  for (Index k = 0; k < legs_.size(); ++k) {
    smoothScans(legs_[k].scans, own[k], legs_[k].keyframe, map);
    const auto tie = std::find_if(
        map.factors.relative_poses.begin(), map.factors.relative_poses.end(),
        [&](const RelativePoseFactor& f) { return f.second == legs_[k].keyframe && !f.is_loop; });
    if (tie == map.factors.relative_poses.end()) continue;
    const PosePrior motion = {startFromFirst(ends, k).inverse() * ends[k].map_from_body,
                              inverse(factor * own[k].poseCovariance())};
    replaceMotion(motion, legs_[k].tied, *tie);
  }
}

}  // namespace opp::mapping
