// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/primitives/find_lines.h"

#include "primitives/labelled_samples.h"
#include "primitives/sample_pitch.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace opp {
namespace {

/// A sample beside a line.
struct Beside {
  double along = 0.0;  ///< coordinate on the line [m]
  double pitch = 0.0;  ///< of the samples along the line, here [m]
  bool front = false;  ///< on the viewpoint's side of the other plane
};

struct Interval {
  double low = 0.0, high = 0.0;
};

struct Line {
  Eigen::Vector3d point, direction;
};

/// Common line of two planes, which are far from parallel; its origin is the point nearest `near`.
Line intersect(const Plane& a, const Plane& b, const Eigen::Vector3d& near) {
  const Eigen::Vector3d direction = a.normal().cross(b.normal()).normalized();
  Eigen::Matrix3d rows;
  rows << a.normal().transpose(), b.normal().transpose(), direction.transpose();
  const Eigen::Vector3d offset = rows.partialPivLu().solve(
      Eigen::Vector3d(-a.signedDistance(near), -b.signedDistance(near), 0));
  return {near + offset, direction};
}

/// A plane and its samples, as a line sees them.
struct Side {
  const Plane& plane;
  const std::vector<Eigen::Vector3d>& samples;
  double spacing;  ///< mean extent of the samples [m]
};

/// Samples of one side within `reach` spacings of the line, by ascending coordinate.
std::vector<Beside> besideLine(const Side& side, const Plane& other, const Line& line, double reach,
                               const Eigen::Vector3d& viewpoint) {
  std::vector<Beside> result;
  for (const Eigen::Vector3d& x : side.samples) {
    const double distance = other.signedDistance(x);
    if (std::abs(distance) > reach * side.spacing) continue;
    const double pitch = pitchAlong(line.direction, side.plane.normal(), x - viewpoint);
    result.push_back({line.direction.dot(x - line.point), pitch * side.spacing, distance > 0.0});
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const Beside& a, const Beside& b) { return a.along < b.along; });
  return result;
}

/// Where the samples leave no gap of more than `max_gap` pitches.
std::vector<Interval> stretches(const std::vector<Beside>& beside, double max_gap) {
  std::vector<Interval> result;
  for (const Beside& sample : beside) {
    if (result.empty() || sample.along - result.back().high > max_gap * sample.pitch) {
      result.push_back({sample.along, sample.along});
    }
    result.back().high = sample.along;
  }
  return result;
}

std::vector<Interval> common(const std::vector<Interval>& a, const std::vector<Interval>& b) {
  std::vector<Interval> result;
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    const Interval both{std::max(a[i].low, b[j].low), std::min(a[i].high, b[j].high)};
    if (both.low < both.high) result.push_back(both);
    a[i].high < b[j].high ? ++i : ++j;
  }
  return result;
}

/// On which sides of the other plane the samples of a stretch lie.
struct Sides {
  bool front = false, behind = false;
};

Sides sidesOf(const std::vector<Beside>& beside, const Interval& stretch, double min_share) {
  int front = 0, all = 0;
  for (const Beside& sample : beside) {
    if (sample.along < stretch.low || sample.along > stretch.high) continue;
    ++all;
    if (sample.front) ++front;
  }
  return {front > min_share * all, all - front > min_share * all};
}

LineKind kindOf(const Sides& a, const Sides& b) {
  if (a.front && b.front) return LineKind::kConcave;
  if (!a.front && !b.front && a.behind && b.behind) return LineKind::kConvex;
  return LineKind::kUnknown;
}

class LineFinder {
 public:
  LineFinder(const OrientedCloud& cloud, const Primitives& scan, const LineParams& params)
      : scan_(scan),
        params_(params),
        viewpoint_(cloud.viewpoint.cast<double>()),
        samples_(samplesByPlane(cloud, scan)),
        spacings_(spacingsOf(cloud, scan)) {}

  void addSegments(const OrthogonalityEdge& edge, std::vector<LineSegment>& segments) const {
    const auto a = static_cast<std::size_t>(edge.planes[0]);
    const auto b = static_cast<std::size_t>(edge.planes[1]);
    const PlanePrimitive &plane_a = scan_.planes.at(a), &plane_b = scan_.planes.at(b);
    const Eigen::Vector3d middle = 0.5 * (plane_a.moments.mean() + plane_b.moments.mean());
    const Line line = intersect(plane_a.plane, plane_b.plane, middle);
    const auto beside = [&](std::size_t own, const PlanePrimitive& plane, const Plane& other) {
      return besideLine({plane.plane, samples_[own], spacings_[own]}, other, line, params_.reach,
                        viewpoint_);
    };
    const auto beside_a = beside(a, plane_a, plane_b.plane);
    const auto beside_b = beside(b, plane_b, plane_a.plane);
    const auto on_a = stretches(beside_a, params_.max_gap);
    const auto on_b = stretches(beside_b, params_.max_gap);
    const double spacing = std::min(spacings_[a], spacings_[b]);
    for (Interval stretch : common(on_a, on_b)) {
      if (stretch.high - stretch.low < params_.min_length * spacing) continue;
      LineSegment segment;
      segment.planes = edge.planes;
      segment.kind = kindOf(sidesOf(beside_a, stretch, params_.min_side_share),
                            sidesOf(beside_b, stretch, params_.min_side_share));
      const double snap = params_.reach * std::max(spacings_[a], spacings_[b]);
      segment.start = endAt(line, stretch.low, edge.planes, snap);
      segment.end = endAt(line, stretch.high, edge.planes, snap);
      segments.push_back(segment);
    }
  }

 private:
  /// Point on the line, or the corner of both planes within reach of it.
  Eigen::Vector3d endAt(const Line& line, double along, const std::array<int, 2>& planes,
                        double nearest) const {
    const Eigen::Vector3d end = line.point + along * line.direction;
    Eigen::Vector3d result = end;
    for (const Corner& corner : scan_.corners) {
      const auto has = [&](int plane) {
        return std::find(corner.planes.begin(), corner.planes.end(), plane) != corner.planes.end();
      };
      const double distance = (corner.position - end).norm();
      if (!has(planes[0]) || !has(planes[1]) || distance > nearest) continue;
      nearest = distance;
      result = corner.position;
    }
    return result;
  }

  const Primitives& scan_;
  const LineParams& params_;
  Eigen::Vector3d viewpoint_;
  std::vector<std::vector<Eigen::Vector3d>> samples_;
  std::vector<double> spacings_;  ///< of each plane's samples [m]
};

}  // namespace

std::vector<LineSegment> findLines(const OrientedCloud& cloud, const Primitives& scan,
                                   const LineParams& params) {
  validate(params);
  const LineFinder finder(cloud, scan, params);
  std::vector<LineSegment> segments;
  for (const OrthogonalityEdge& edge : scan.edges) finder.addSegments(edge, segments);
  return segments;
}

}  // namespace opp
