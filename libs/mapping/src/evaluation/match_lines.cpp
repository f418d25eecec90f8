// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/geometry/constants.h"

#include "evaluation/primitive_matching.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

namespace opp::mapping {
namespace {

using Interval = std::pair<double, double>;  ///< ascending [m]

/// The common line of two planes with all its segments.
struct SupportedLine {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> segments;
};

struct SharedStretch {
  double length = 0.0;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< on the true line
};

/// Lines in ascending order of their planes' ids. Segments without length have no direction and are
/// left out.
std::vector<SupportedLine> groupByPlanes(const std::vector<PlanarMapLine>& segments) {
  std::map<std::pair<int, int>, SupportedLine> lines;
  for (const PlanarMapLine& segment : segments) {
    const double length = (segment.end - segment.start).norm();
    if (!(length > 0.0)) continue;
    SupportedLine& line = lines[std::minmax(segment.planes[0], segment.planes[1])];
    double longest = 0.0;
    for (const auto& [start, end] : line.segments)
      longest = std::max(longest, (end - start).norm());
    if (length > longest) {
      line.origin = segment.start;
      line.direction = (segment.end - segment.start) / length;
    }
    line.segments.emplace_back(segment.start, segment.end);
  }
  std::vector<SupportedLine> result;
  for (auto& [planes, line] : lines) result.push_back(std::move(line));
  return result;
}

/// The segments as disjoint intervals along another line, ascending.
std::vector<Interval> intervalsAlong(const SupportedLine& axis, const SupportedLine& line) {
  std::vector<Interval> intervals;
  for (const auto& [start, end] : line.segments) {
    intervals.push_back(std::minmax(
        {axis.direction.dot(start - axis.origin), axis.direction.dot(end - axis.origin)}));
  }
  std::sort(intervals.begin(), intervals.end());
  std::vector<Interval> merged;
  for (const Interval& interval : intervals) {
    if (merged.empty() || interval.first > merged.back().second) {
      merged.push_back(interval);
    } else {
      merged.back().second = std::max(merged.back().second, interval.second);
    }
  }
  return merged;
}

double lengthOf(const std::vector<Interval>& intervals) {
  double length = 0.0;
  for (const auto& [from, to] : intervals) length += to - from;
  return length;
}

SharedStretch sharedStretch(const SupportedLine& gt, const std::vector<Interval>& gt_intervals,
                            const std::vector<Interval>& est_intervals) {
  SharedStretch shared;
  double moment = 0.0;
  for (const Interval& a : gt_intervals) {
    for (const Interval& b : est_intervals) {
      const double from = std::max(a.first, b.first);
      const double to = std::min(a.second, b.second);
      if (to <= from) continue;
      shared.length += to - from;
      moment += (to - from) * 0.5 * (from + to);
    }
  }
  if (shared.length > 0.0) shared.middle = gt.origin + moment / shared.length * gt.direction;
  return shared;
}

/// Angle between directions without sign, in [0, π/2] [rad].
double angleBetweenLines(const SupportedLine& a, const SupportedLine& b) {
  return std::atan2(a.direction.cross(b.direction).norm(), std::abs(a.direction.dot(b.direction)));
}

double distanceFrom(const SupportedLine& line, const Eigen::Vector3d& point) {
  return line.direction.cross(point - line.origin).norm();
}

/// Whether the extents of two lines along each other, of which they share a stretch, agree.
using ExtentsAgree = std::function<bool(double gt_length, double est_length, double shared)>;

std::vector<PrimitiveCandidate> sameLines(const std::vector<SupportedLine>& gt,
                                          const std::vector<SupportedLine>& est,
                                          const PrimitiveErrorParams& params,
                                          const ExtentsAgree& extents_agree) {
  std::vector<PrimitiveCandidate> candidates;
  for (std::size_t g = 0; g < gt.size(); ++g) {
    const std::vector<Interval> gt_intervals = intervalsAlong(gt[g], gt[g]);
    const double gt_length = lengthOf(gt_intervals);
    for (std::size_t e = 0; e < est.size(); ++e) {
      const double angle = angleBetweenLines(gt[g], est[e]);
      if (angle > params.max_angle) continue;
      const std::vector<Interval> est_intervals = intervalsAlong(gt[g], est[e]);
      const SharedStretch shared = sharedStretch(gt[g], gt_intervals, est_intervals);
      if (!(shared.length > 0.0)) continue;
      const double distance = distanceFrom(est[e], shared.middle);
      if (distance > params.max_distance) continue;
      if (!extents_agree(gt_length, lengthOf(est_intervals), shared.length)) continue;
      candidates.push_back({g, e, angle, distance,
                            angle / params.max_angle + distance / params.max_distance + 1.0 -
                                shared.length / gt_length});
    }
  }
  return candidates;
}

}  // namespace

PrimitiveMatching matchLines(const PlanarMap& gt_map, const PlanarMap& est_map,
                             const PrimitiveErrorParams& params) {
  const std::vector<SupportedLine> gt = groupByPlanes(gt_map.lines);
  const std::vector<SupportedLine> est = groupByPlanes(est_map.lines);
  const auto same = sameLines(gt, est, params, [&](double gt_length, double length, double shared) {
    return extentsAgree(gt_length, length, shared, params);
  });
  const auto barely_seen = sameLines(
      groupByPlanes(gt_map.barely_seen.lines), est, params,
      [&](double, double length, double shared) { return shared >= params.min_overlap * length; });
  std::vector<double> lengths;
  for (const SupportedLine& line : gt) lengths.push_back(lengthOf(intervalsAlong(line, line)));
  return matchPrimitives(lengths, est.size(), same, barely_seen, [&](std::size_t a, std::size_t b) {
    return angleBetweenLines(gt[a], gt[b]) <= kSameAngle &&
           distanceFrom(gt[a], gt[b].origin) <= kSameDistance;
  });
}

}  // namespace opp::mapping
