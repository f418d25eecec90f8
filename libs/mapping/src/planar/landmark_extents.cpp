// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planar/landmark_extents.h"

#include <algorithm>
#include <set>

namespace opp::mapping {
namespace {

using Index = std::size_t;

/// The axis along which most of the other planes' normals lie gives outlines that follow the room's
/// edges.
Eigen::Vector3d rasterDirection(int landmark, const MapState& map) {
  for (const OrthogonalityFactor& f : map.factors.orthogonalities) {
    if (f.landmarks[0] == landmark)
      return map.landmarks.planes[Index(f.landmarks[1])].plane_in_map.normal();
    if (f.landmarks[1] == landmark)
      return map.landmarks.planes[Index(f.landmarks[0])].plane_in_map.normal();
  }
  return Eigen::Vector3d::UnitX();
}

/// A sample and the ray that it ends.
struct Ray {
  Eigen::Vector3d viewpoint;  ///< in the map
  Eigen::Vector3d point;
  int landmark = -1;  ///< that the sample is on; −1: none
  double footprint = 0.0;
  double sigma = 0.0;
};

template <typename F>
void forEachRay(const Keyframe& keyframe, F&& f) {
  const OrientedCloud& cloud = keyframe.features.cloud_in_body;
  Ray ray;
  ray.viewpoint = keyframe.map_from_body * cloud.viewpoint.cast<double>();
  for (Index i = 0; i < cloud.size(); ++i) {
    const int label = keyframe.features.primitives_in_body.labels[i];
    ray.point = keyframe.map_from_body * cloud.points[i].cast<double>();
    ray.landmark = label < 0 ? -1 : keyframe.landmark_of_plane[Index(label)];
    ray.footprint = cloud.extent(i);
    ray.sigma = static_cast<double>(cloud.sigmas[i]);
    f(ray);
  }
}

std::vector<PlaneExtent> emptyExtents(const MapState& map, double cell) {
  std::vector<PlaneExtent> extents;
  for (Index l = 0; l < map.landmarks.planes.size(); ++l) {
    extents.emplace_back(
        PlaneFrame(map.landmarks.planes[l].plane_in_map, rasterDirection(static_cast<int>(l), map)),
        cell);
  }
  return extents;
}

/// Those that merging left without observations have no extent.
std::vector<Index> observedLandmarks(const MapState& map) {
  std::vector<Index> ids;
  for (Index l = 0; l < map.landmarks.planes.size(); ++l) {
    if (!map.landmarks.planes[l].observations.empty()) ids.push_back(l);
  }
  return ids;
}

void addSamples(const Keyframe& keyframe, const std::vector<Index>& landmarks,
                std::vector<PlaneExtent>& extents) {
  // A ray counts as passing through a plane only if it ends clearly behind it.
  const double clearance = 2.0 * keyframe.features.cloud_in_body.spacing;
  forEachRay(keyframe, [&](const Ray& ray) {
    for (const Index l : landmarks) {
      if (static_cast<int>(l) == ray.landmark)
        extents[l].addSupport(ray.point, ray.footprint);
      else
        extents[l].addSightline(ray.viewpoint, ray.point, ray.footprint, clearance);
    }
  });
}

void addViews(const Keyframe& keyframe, double cell, std::vector<PlaneExtent>& extents) {
  if (!keyframe.views.adopted) return;
  for (const PlaneView& view : keyframe.views.planes) {
    const PlaneFrame raster = rasterOf(view.raster_plane);
    const int landmark = keyframe.landmark_of_plane[Index(view.keyframe_plane)];
    for (const PlaneCell& at : view.support) {
      const Eigen::Vector3d centre = raster.lift(cell * centreOf(at));
      extents[Index(landmark)].addSupport(keyframe.map_from_body * centre, cell);
    }
  }
}

/// The support of a landmark, to look up what rays meet.
class Target {
 public:
  explicit Target(const PlaneExtent& extent) : extent_(extent), cells_(extent.supportCells()) {}

  /// Whether the ray meets the support, or passes it.
  bool isMetBy(const Ray& ray) const {
    const Plane& plane = extent_.frame().plane();
    const double at_viewpoint = plane.signedDistance(ray.viewpoint);
    const double at_point = plane.signedDistance(ray.point);
    if (at_viewpoint <= 0.0 || at_point > kOn * ray.sigma) return false;
    // A sample that noise put before the plane is where it is: its ray need not cross at all.
    const double part = at_viewpoint / (at_viewpoint - std::min(at_point, 0.0));
    const Eigen::Vector3d crossing = ray.viewpoint + part * (ray.point - ray.viewpoint);
    return std::binary_search(cells_.begin(), cells_.end(),
                              extent_.frame().cellAt(crossing, extent_.cell()));
  }

 private:
  static constexpr double kOn = 3.0;  ///< samples this near are on a plane [standard deviations]
  const PlaneExtent& extent_;
  std::vector<PlaneCell> cells_;
};

/// Whether at least `enough` rays meet the target.
bool areMeeting(const std::vector<Ray>& rays, int enough, const Target& target) {
  return std::any_of(rays.begin(), rays.end(),
                     [&](const Ray& ray) { return target.isMetBy(ray) && --enough <= 0; });
}

}  // namespace

std::vector<double> timesOf(const PlaneLandmark& landmark, const MapState& map) {
  std::set<double> times;
  for (const PrimitiveObservation& o : landmark.observations) {
    const std::vector<double> seen = timesOfPlane(map.keyframes[Index(o.keyframe)], o.primitive);
    times.insert(seen.begin(), seen.end());
  }
  return {times.begin(), times.end()};
}

std::vector<PlaneExtent> landmarkSupports(const MapState& map, double cell) {
  std::vector<PlaneExtent> extents = emptyExtents(map, cell);
  for (const Keyframe& keyframe : map.keyframes) {
    forEachRay(keyframe, [&](const Ray& ray) {
      if (ray.landmark >= 0) extents[Index(ray.landmark)].addSupport(ray.point, ray.footprint);
    });
    addViews(keyframe, cell, extents);
  }
  return extents;
}

std::vector<PlaneExtent> landmarkExtents(const MapState& map, const PlanarParams& params) {
  std::vector<PlaneExtent> extents = emptyExtents(map, params.cell);
  const std::vector<Index> observed = observedLandmarks(map);
  for (const Keyframe& keyframe : map.keyframes) {
    addSamples(keyframe, observed, extents);
    addViews(keyframe, params.cell, extents);
  }
  return extents;
}

std::vector<double> seenShares(const MapState& map, const std::vector<PlaneExtent>& extents,
                               const PlanarParams& params) {
  const std::vector<PlaneLandmark>& landmarks = map.landmarks.planes;
  const std::vector<Index> observed = observedLandmarks(map);
  const std::vector<Target> targets(extents.begin(), extents.end());
  std::vector<double> scans(map.keyframes.size());
  for (const LocalizedScan& scan : map.scans) scans[Index(scan.keyframe)] += 1.0;
  std::vector<std::set<int>> saw(landmarks.size());
  for (const Index l : observed) {
    for (const PrimitiveObservation& o : landmarks[l].observations) saw[l].insert(o.keyframe);
  }
  std::vector<double> looked(landmarks.size());
  for (Index k = 0; k < map.keyframes.size(); ++k) {
    std::vector<Ray> rays;
    forEachRay(map.keyframes[k], [&](const Ray& ray) { rays.push_back(ray); });
    for (const Index l : observed) {
      if (saw[l].count(static_cast<int>(k)) > 0 || areMeeting(rays, params.min_rays, targets[l]))
        looked[l] += scans[k];
    }
  }
  std::vector<double> shares(landmarks.size());
  for (const Index l : observed) {
    if (looked[l] > 0.0)
      shares[l] = static_cast<double>(timesOf(landmarks[l], map).size()) / looked[l];
  }
  return shares;
}

}  // namespace opp::mapping
