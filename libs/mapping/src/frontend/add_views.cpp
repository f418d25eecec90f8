// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/add_views.h"

#include "opp/mapping/registration/plane_samples.h"

#include "frontend/landmark_support.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace opp::mapping {
namespace {

using Index = std::size_t;

LandmarkSupport supportOf(const PlanePrimitive& plane, const SensorModel& sensor) {
  LandmarkSupport support{plane.moments, effectiveCount(plane.support, sensor), 0.0, {}};
  support.moments.scaleWeights(support.effective_samples / plane.support);
  return support;
}

void merge(const PlanePrimitive& more, PlanePrimitive& plane) {
  const double count = plane.support + more.support;
  plane.rms = std::sqrt(
      (plane.support * plane.rms * plane.rms + more.support * more.rms * more.rms) / count);
  plane.support += more.support;
  plane.area = std::max(plane.area, more.area);
  plane.moments.merge(more.moments);
  plane.plane = plane.moments.fitPlane(plane.moments.mean() + plane.plane.normal());
}

PlanePrimitive transformed(const Eigen::Isometry3d& b_from_a, PlanePrimitive plane) {
  plane.plane = opp::transformed(b_from_a, plane.plane);
  plane.moments = opp::transformed(b_from_a, plane.moments);
  plane.family = -1;
  plane.covariance.setZero();
  return plane;
}

/// Adds one scan to the views of a keyframe.
class ViewAdder {
 public:
  ViewAdder(const ScanFeatures& scan, const Eigen::Isometry3d& keyframe_from_body,
            const SensorModel& sensor, Keyframe& keyframe)
      : scan_(scan),
        keyframe_from_body_(keyframe_from_body),
        sensor_(sensor),
        keyframe_(keyframe),
        view_of_plane_(planesOfScan().size(), -1) {}

  void add(const std::vector<PlaneAssociation>& known, double cell) {
    assign(known);
    addSupport(cell);
    addEdges();
    addLines();
    addCorners();
  }

 private:
  const std::vector<PlanePrimitive>& planesOfScan() const {
    return scan_.primitives_in_body.planes;
  }
  std::vector<PlaneView>& views() { return keyframe_.views.planes; }

  /// Which view each plane of the scan is, largest planes first.
  void assign(const std::vector<PlaneAssociation>& known) {
    std::vector<int> order, landmark(planesOfScan().size(), -1);
    for (const PlaneAssociation& a : known) landmark[Index(a.scan_plane)] = a.landmark;
    for (Index p = 0; p < planesOfScan().size(); ++p) order.push_back(static_cast<int>(p));
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
      return planesOfScan()[Index(a)].area > planesOfScan()[Index(b)].area;
    });
    for (const int p : order) {
      const PlanePrimitive plane = transformed(keyframe_from_body_, planesOfScan()[Index(p)]);
      if (plane.moments.empty()) continue;
      const int view = viewOf(plane, landmark[Index(p)]);
      view_of_plane_[Index(p)] = view;
      taken_.push_back(view);
    }
  }

  bool isTaken(int view) const {
    return std::find(taken_.begin(), taken_.end(), view) != taken_.end();
  }

  int newView(int keyframe_plane, const PlanePrimitive& plane) {
    PlaneView view;
    view.keyframe_plane = keyframe_plane;
    view.is_own = keyframe_plane >= 0;
    view.seen = plane;
    view.raster_plane = plane.plane;
    views().push_back(std::move(view));
    return static_cast<int>(views().size()) - 1;
  }

  /// The view of a plane of the keyframe; −1: none yet.
  int viewOfKeyframePlane(int keyframe_plane) {
    const auto found = std::find_if(views().begin(), views().end(), [&](const PlaneView& view) {
      return view.keyframe_plane == keyframe_plane;
    });
    return found == views().end() ? -1 : static_cast<int>(found - views().begin());
  }

  /// The view that a plane of the scan is: the one it scatters least apart from, a new one if noise
  /// does not explain that. \param landmark that it is; −1: unknown
  int viewOf(const PlanePrimitive& plane, int landmark) {
    int keyframe_plane = -1, view = -1;
    double least = 1.0;
    const std::vector<PlanePrimitive>& own = keyframe_.features.primitives_in_body.planes;
    for (Index q = 0; q < own.size(); ++q) {
      const int of_own = viewOfKeyframePlane(static_cast<int>(q));
      if (of_own >= 0 && isTaken(of_own)) continue;
      const bool same = landmark >= 0 && keyframe_.landmark_of_plane[q] == landmark;
      const double apart = same ? 0.0 : excess(plane, own[q]);
      if (apart >= least) continue;
      least = apart;
      keyframe_plane = static_cast<int>(q);
      view = of_own;
    }
    for (Index v = 0; v < views().size(); ++v) {
      if (views()[v].is_own || isTaken(static_cast<int>(v))) continue;
      const double apart = excess(plane, views()[v].seen);
      if (apart >= least) continue;
      least = apart;
      view = static_cast<int>(v);
    }
    if (view < 0) return newView(keyframe_plane, plane);
    merge(plane, views()[Index(view)].seen);
    return view;
  }

  double excess(const PlanePrimitive& a, const PlanePrimitive& b) const {
    if (b.moments.empty()) return std::numeric_limits<double>::infinity();
    return oneSurfaceExcess(a.plane, supportOf(a, sensor_), b.plane, supportOf(b, sensor_));
  }

  void addSupport(double cell) {
    const OrientedCloud& cloud = scan_.cloud_in_body;
    std::vector<PlaneExtent> extents;
    for (const PlaneView& view : views()) extents.emplace_back(rasterOf(view.raster_plane), cell);
    for (Index i = 0; i < cloud.size(); ++i) {
      const int label = scan_.primitives_in_body.labels[i];
      const int view = label < 0 ? -1 : view_of_plane_[Index(label)];
      if (view < 0) continue;
      extents[Index(view)].addSupport(keyframe_from_body_ * cloud.points[i].cast<double>(),
                                      cloud.extent(i));
    }
    for (const int view : taken_) {
      PlaneView& seen = views()[Index(view)];
      const std::vector<PlaneCell> cells = extents[Index(view)].supportCells();
      std::vector<PlaneCell> all;
      std::set_union(seen.support.begin(), seen.support.end(), cells.begin(), cells.end(),
                     std::back_inserter(all));
      seen.support = std::move(all);
      seen.timestamps.push_back(scan_.timestamp);
    }
  }

  /// Replaces planes of the scan by the views that they are; false if one has no samples.
  template <std::size_t N>
  bool toViews(std::array<int, N>& planes) const {
    for (int& plane : planes) plane = view_of_plane_[Index(plane)];
    return *std::min_element(planes.begin(), planes.end()) >= 0;
  }

  void addEdges() {
    std::vector<OrthogonalityEdge>& edges = keyframe_.views.edges;
    for (OrthogonalityEdge edge : scan_.primitives_in_body.edges) {
      if (!toViews(edge.planes)) continue;
      std::sort(edge.planes.begin(), edge.planes.end());
      const bool known = std::any_of(edges.begin(), edges.end(), [&](const auto& other) {
        return other.planes == edge.planes;
      });
      if (!known) edges.push_back(edge);
    }
  }

  void addLines() {
    for (LineSegment line : scan_.primitives_in_body.lines) {
      if (!toViews(line.planes)) continue;
      std::sort(line.planes.begin(), line.planes.end());
      line.start = keyframe_from_body_ * line.start;
      line.end = keyframe_from_body_ * line.end;
      std::vector<LineSegment>& lines = keyframe_.views.lines;
      const bool known = std::any_of(lines.begin(), lines.end(), [&](LineSegment& other) {
        return other.planes == line.planes && other.kind == line.kind && extend(line, other);
      });
      if (!known) lines.push_back(line);
    }
  }

  /// Whether two stretches of one line overlap; then `line` reaches over both.
  static bool extend(const LineSegment& more, LineSegment& line) {
    const Eigen::Vector3d direction = (line.end - line.start).normalized();
    const auto [first, last] =
        std::minmax({direction.dot(more.start - line.start), direction.dot(more.end - line.start)});
    const double length = (line.end - line.start).norm();
    if (last < 0.0 || first > length) return false;
    line.end = line.start + std::max(last, length) * direction;
    line.start += std::min(first, 0.0) * direction;
    return true;
  }

  void addCorners() {
    for (const Corner& in_scan : scan_.primitives_in_body.corners) {
      Corner corner = in_scan;
      if (!toViews(corner.planes)) continue;
      std::vector<CornerView>& corners = keyframe_.views.corners;
      auto view = std::find_if(corners.begin(), corners.end(), [&](const CornerView& known) {
        return std::is_permutation(known.seen.planes.begin(), known.seen.planes.end(),
                                   corner.planes.begin());
      });
      if (view == corners.end()) {
        const Eigen::Matrix3d turn = keyframe_from_body_.linear();
        corner.position = keyframe_from_body_ * corner.position;
        corner.cloud_from_corner = turn * corner.cloud_from_corner;
        corner.covariance = turn * corner.covariance * turn.transpose();
        view = corners.insert(view, {corner, {}});
      }
      view->timestamps.push_back(scan_.timestamp);
    }
  }

  const ScanFeatures& scan_;
  const Eigen::Isometry3d& keyframe_from_body_;
  const SensorModel& sensor_;
  Keyframe& keyframe_;
  std::vector<int> view_of_plane_;
  std::vector<int> taken_;  ///< views that are planes of the scan
};

}  // namespace

void addViews(const ScanFeatures& scan, const std::vector<PlaneAssociation>& known,
              const Eigen::Isometry3d& keyframe_from_body, const SensorModel& sensor, double cell,
              Keyframe& keyframe) {
  ViewAdder(scan, keyframe_from_body, sensor, keyframe).add(known, cell);
}

}  // namespace opp::mapping
