// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "seen_plane.h"

#include <algorithm>
#include <cmath>

namespace opp::mapping {
namespace {

constexpr double kOrthogonal = 1e-9;         ///< |cos| of planes built at right angles
constexpr double kShortest = 10.0 * kTouch;  ///< shorter stretches are rounding [m]

using Interval = std::array<double, 2>;

/// Where origin + s · direction comes as near as `gap` to the whole faces of a plane, ascending.
std::vector<Interval> touching(const Geos& geos, const SeenPlane& plane, const Seam& seam,
                               const Interval& range, double gap) {
  const auto h = geos.handle();
  const PlaneCoordinates coordinates = plane.coordinates();
  GEOSCoordSequence* ends = GEOSCoordSeq_create_r(h, 2, 2);
  for (unsigned k = 0; k < 2; ++k) {
    const Eigen::Vector2d uv = coordinates.uv(seam.origin + range[k] * seam.direction);
    GEOSCoordSeq_setXY_r(h, ends, k, uv.x(), uv.y());
  }
  const auto line = geos.checked(GEOSGeom_createLineString_r(h, ends));
  const auto grown = geos.checked(GEOSBufferWithStyle_r(
      h, plane.outline.get(), gap, 1, GEOSBUF_CAP_SQUARE, GEOSBUF_JOIN_MITRE, 2.0));
  const auto common = geos.checked(GEOSIntersection_r(h, line.get(), grown.get()));
  std::vector<Interval> result;
  for (int k = 0; k < GEOSGetNumGeometries_r(h, common.get()); ++k) {
    const GEOSGeometry* part = GEOSGetGeometryN_r(h, common.get(), k);
    if (GEOSGeomTypeId_r(h, part) != GEOS_LINESTRING || GEOSisEmpty_r(h, part) != 0) continue;
    Interval interval{};
    for (int end = 0; end < 2; ++end) {
      const auto point = geos.checked(end == 0 ? GEOSGeomGetStartPoint_r(h, part)
                                               : GEOSGeomGetEndPoint_r(h, part));
      Eigen::Vector2d uv;
      GEOSGeomGetX_r(h, point.get(), &uv.x());
      GEOSGeomGetY_r(h, point.get(), &uv.y());
      interval[static_cast<std::size_t>(end)] =
          seam.direction.dot(coordinates.point(uv) - seam.origin);
    }
    std::sort(interval.begin(), interval.end());
    if (interval[1] - interval[0] > kShortest) result.push_back(interval);
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<Interval> common(const std::vector<Interval>& a, const std::vector<Interval>& b) {
  std::vector<Interval> result;
  for (const Interval& i : a) {
    for (const Interval& j : b) {
      const Interval both{std::max(i[0], j[0]), std::min(i[1], j[1])};
      if (both[1] - both[0] > kShortest) result.push_back(both);
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// Parts of an interval where both planes were seen; gaps of up to three cells are closed, ends
/// within two cells of the interval's are taken to it.
std::vector<Interval> seenParts(const SeenPlane& a, const SeenPlane& b, const Seam& seam,
                                const Interval& interval, const GroundTruthParams& params) {
  const double cell = params.cell;
  const int steps =
      std::max(1, static_cast<int>(std::ceil((interval[1] - interval[0]) / cell * 2.0)));
  std::vector<Interval> parts;
  for (int k = 0; k <= steps; ++k) {
    const double s = interval[0] + (interval[1] - interval[0]) * k / steps;
    const Eigen::Vector3d point = seam.origin + s * seam.direction;
    if (!a.seenNear(point, params) || !b.seenNear(point, params)) continue;
    if (!parts.empty() && s - parts.back()[1] <= 3.0 * cell) {
      parts.back()[1] = s;
    } else {
      parts.push_back({s, s});
    }
  }
  if (parts.empty()) return parts;
  if (parts.front()[0] - interval[0] <= 2.0 * cell) parts.front()[0] = interval[0];
  if (interval[1] - parts.back()[1] <= 2.0 * cell) parts.back()[1] = interval[1];
  return parts;
}

/// Pixels of `plane` within reach of the part of the seam, by the side of `other` they lie on.
SplitCount pixelsNear(const SeenPlane& plane, const Plane& other, const Seam& seam,
                      const Interval& part, double reach) {
  SplitCount count;
  for (const Coverage* coverage : plane.coverages) {
    coverage->forEachSeen([&](const Eigen::Vector3d& centre, std::uint32_t pixels) {
      const double s = seam.direction.dot(centre - seam.origin);
      const double distance = other.signedDistance(centre);
      if (s < part[0] || s > part[1] || std::abs(distance) > reach) return;
      (distance > 0.0 ? count.positive : count.negative) += pixels;
    });
  }
  return count;
}

/// Concave: either plane has a visible strip in front of the other; convex: both strips lie behind.
LineKind kindOf(const SplitCount& a, const SplitCount& b) {
  const auto some = [](std::uint64_t part, const SplitCount& count) {
    return 5 * part >= count.total();
  };
  if (some(a.positive, a) && some(b.positive, b)) return LineKind::kConcave;
  if (some(a.negative, a) && some(b.negative, b)) return LineKind::kConvex;
  return LineKind::kUnknown;
}

Seam seamOf(const Geos& geos, const std::vector<SeenPlane>& planes, int i, int j, double gap) {
  const SeenPlane& a = planes[static_cast<std::size_t>(i)];
  const SeenPlane& b = planes[static_cast<std::size_t>(j)];
  Seam seam;
  seam.planes = {i, j};
  seam.direction = a.plane.normal().cross(b.plane.normal()).normalized();
  // The foot of the boxes' common centre on both planes; they are orthogonal, so one after the
  // other.
  seam.origin = b.plane.project(a.plane.project(0.5 * (a.box.center() + b.box.center())));
  const double half = 0.5 * (a.box.diagonal().norm() + b.box.diagonal().norm()) + 1.0;
  const Interval range{-half, half};
  seam.intervals = common(touching(geos, a, seam, range, gap), touching(geos, b, seam, range, gap));
  return seam;
}

}  // namespace

std::vector<Seam> seams(const Geos& geos, const std::vector<SeenPlane>& planes, double gap) {
  std::vector<Seam> result;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (std::size_t j = i + 1; j < planes.size(); ++j) {
      if (std::abs(planes[i].plane.normal().dot(planes[j].plane.normal())) > kOrthogonal) continue;
      Eigen::AlignedBox3d grown = planes[i].box;
      grown.extend(grown.max() + Eigen::Vector3d::Constant(2.0 * gap));
      grown.extend(grown.min() - Eigen::Vector3d::Constant(2.0 * gap));
      if (!grown.intersects(planes[j].box)) continue;
      Seam seam = seamOf(geos, planes, static_cast<int>(i), static_cast<int>(j), gap);
      if (!seam.intervals.empty()) result.push_back(std::move(seam));
    }
  }
  return result;
}

std::vector<SeenLine> seenLines(const std::vector<SeenPlane>& planes,
                                const std::vector<Seam>& seams, const GroundTruthParams& params) {
  std::vector<SeenLine> result;
  const auto enough = static_cast<std::uint64_t>(params.min_pixels);
  for (const Seam& seam : seams) {
    const SeenPlane& a = planes[static_cast<std::size_t>(seam.planes[0])];
    const SeenPlane& b = planes[static_cast<std::size_t>(seam.planes[1])];
    if (isBarelySeen(a, params) || isBarelySeen(b, params)) continue;
    for (const Interval& interval : seam.intervals) {
      for (const Interval& part : seenParts(a, b, seam, interval, params)) {
        const SplitCount on_a = pixelsNear(a, b.plane, seam, part, params.reach);
        const SplitCount on_b = pixelsNear(b, a.plane, seam, part, params.reach);
        if (on_a.total() + on_b.total() < enough) continue;
        if (3 * std::min(on_a.total(), on_b.total()) < enough) continue;
        const LineKind kind = kindOf(on_a, on_b);
        if (kind == LineKind::kUnknown) continue;  // faces touch, but form no edge that was seen
        result.push_back({seam.planes, seam.origin + part[0] * seam.direction,
                          seam.origin + part[1] * seam.direction, kind});
      }
    }
  }
  return result;
}

std::vector<SeenLine> restOfSeams(const std::vector<Seam>& seams,
                                  const std::vector<SeenLine>& lines,
                                  const GroundTruthParams& params) {
  std::vector<SeenLine> result;
  const double shortest = std::max(params.cell, params.near_gap) + kShortest;
  for (const Seam& seam : seams) {
    const auto add = [&](double from, double to) {
      if (to - from < shortest) return;
      result.push_back({seam.planes, seam.origin + from * seam.direction,
                        seam.origin + to * seam.direction, LineKind::kUnknown});
    };
    for (const Interval& interval : seam.intervals) {
      double from = interval[0];
      for (const SeenLine& line : lines) {  // ascending along each seam
        if (line.planes != seam.planes) continue;
        const double start = seam.direction.dot(line.start - seam.origin);
        const double end = seam.direction.dot(line.end - seam.origin);
        if (start < interval[0] - kTouch || end > interval[1] + kTouch) continue;
        add(from, start);
        from = end;
      }
      add(from, interval[1]);
    }
  }
  return result;
}

}  // namespace opp::mapping
