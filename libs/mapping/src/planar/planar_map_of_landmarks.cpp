// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/planar/planar_map_of_landmarks.h"

#include "opp/geometry/line.h"
#include "opp/graph/union_find.h"
#include "opp/mapping/planar/build_polygons.h"
#include "opp/mapping/planar/line_intervals.h"
#include "opp/mapping/planar/plane_kinds.h"
#include "opp/mapping/planar/snap_polygons.h"

#include "planar/landmark_covariance.h"
#include "planar/landmark_extents.h"

#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace opp::mapping {
namespace {

using Index = std::size_t;

/// What a landmark's keyframes tell of it.
PlanarMapPlane describe(const PlaneLandmark& landmark, const MapState& map,
                        const SensorModel& sensor) {
  PlanarMapPlane plane;
  plane.plane = landmark.plane_in_map;
  double squared_distances = 0.0;
  long samples = 0;
  for (const PrimitiveObservation& observation : landmark.observations) {
    const Keyframe& keyframe = map.keyframes[Index(observation.keyframe)];
    const PlanePrimitive& seen =
        keyframe.features.primitives_in_body.planes[Index(observation.primitive)];
    squared_distances += seen.support * seen.rms * seen.rms;
    samples += seen.support;
  }
  plane.observations = timesOf(landmark, map);
  plane.points = samples;
  plane.rms = samples > 0 ? std::sqrt(squared_distances / static_cast<double>(samples)) : 0.0;
  plane.covariance = landmarkCovariance(landmark, map, sensor);
  return plane;
}

/// Plane landmarks with polygons; `id_of_landmark` gives −1 for the others.
void addPlanes(const MapState& map, const SensorModel& sensor, const PlanarParams& params,
               std::vector<int>& id_of_landmark, PlanarMap& result) {
  const std::vector<PlaneExtent> extents = landmarkExtents(map, params);
  const std::vector<double> shares = seenShares(map, extents, params);
  id_of_landmark.assign(extents.size(), -1);
  for (Index l = 0; l < extents.size(); ++l) {
    if (shares[l] < params.min_seen_share) continue;
    std::vector<PlanarPolygon> polygons = buildPolygons(extents[l], params);
    if (polygons.empty()) continue;
    PlanarMapPlane plane = describe(map.landmarks.planes[l], map, sensor);
    plane.centroid = centroidOf(polygons, plane.plane.normal());
    if (positionDeviation(plane.centroid, plane.plane, plane.covariance) >
        params.max_position_error)
      continue;
    plane.area = areaOf(polygons, plane.plane.normal());
    if (plane.observations.size() < 2 && map.scans.size() > 1 &&
        plane.area < params.single_scan_area)
      continue;
    plane.id = static_cast<int>(result.planes.size());
    plane.polygons = std::move(polygons);
    id_of_landmark[l] = plane.id;
    result.planes.push_back(std::move(plane));
  }
  for (const OrthogonalityFactor& f : map.factors.orthogonalities) {
    const int a = id_of_landmark[Index(f.landmarks[0])];
    const int b = id_of_landmark[Index(f.landmarks[1])];
    if (a < 0 || b < 0) continue;
    result.planes[Index(a)].orthogonal_to.push_back(b);
    result.planes[Index(b)].orthogonal_to.push_back(a);
  }
  for (PlanarMapPlane& plane : result.planes)
    std::sort(plane.orthogonal_to.begin(), plane.orthogonal_to.end());
}

using LandmarkPair = std::pair<int, int>;

/// Lines of all keyframes, by pair of landmarks, as intervals along the landmarks' common line.
std::map<LandmarkPair, std::vector<LineInterval>> lineIntervals(const MapState& map,
                                                                double& spacing) {
  std::map<LandmarkPair, std::vector<LineInterval>> intervals;
  for (const Keyframe& keyframe : map.keyframes) {
    spacing = std::max(spacing, keyframe.features.cloud_in_body.spacing);
    for (const LineSegment& seen : keyframe.features.primitives_in_body.lines) {
      const int a = keyframe.landmark_of_plane[Index(seen.planes[0])];
      const int b = keyframe.landmark_of_plane[Index(seen.planes[1])];
      if (a == b) continue;
      const LandmarkPair pair = std::minmax(a, b);
      const std::optional<Line> line =
          intersect(map.landmarks.planes[Index(pair.first)].plane_in_map,
                    map.landmarks.planes[Index(pair.second)].plane_in_map);
      if (!line) continue;
      const double start = line->parameterOf(keyframe.map_from_body * seen.start);
      const double end = line->parameterOf(keyframe.map_from_body * seen.end);
      intervals[pair].push_back({std::min(start, end), std::max(start, end), seen.kind});
    }
  }
  return intervals;
}

void addLines(const MapState& map, const std::vector<int>& id_of_landmark, PlanarMap& result) {
  double spacing = 0.0;
  for (const auto& [pair, intervals] : lineIntervals(map, spacing)) {
    const int a = id_of_landmark[Index(pair.first)];
    const int b = id_of_landmark[Index(pair.second)];
    if (a < 0 || b < 0) continue;
    const std::optional<Line> line =
        intersect(map.landmarks.planes[Index(pair.first)].plane_in_map,
                  map.landmarks.planes[Index(pair.second)].plane_in_map);
    for (const LineInterval& interval : joinedIntervals(intervals, 2.0 * spacing)) {
      result.lines.push_back({static_cast<int>(result.lines.size()),
                              {a, b},
                              line->at(interval.begin),
                              line->at(interval.end),
                              interval.kind});
    }
  }
}

/// The rotation nearest to the three normals; the last axis is turned where they are left-handed.
Eigen::Quaterniond cornerOrientation(const CornerLandmark& corner, const LandmarkMap& landmarks) {
  Eigen::Matrix3d normals;
  for (int k = 0; k < 3; ++k) {
    normals.col(k) = landmarks.planes[Index(corner.planes[Index(k)])].plane_in_map.normal();
  }
  if (normals.determinant() < 0.0) normals.col(2) *= -1.0;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(normals, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return Eigen::Quaterniond(Eigen::Matrix3d(svd.matrixU() * svd.matrixV().transpose()));
}

void addCorners(const MapState& map, const std::vector<int>& id_of_landmark, PlanarMap& result) {
  for (const CornerLandmark& landmark : map.landmarks.corners) {
    PlanarMapCorner corner;
    corner.id = static_cast<int>(result.corners.size());
    for (Index k = 0; k < 3; ++k) corner.planes[k] = id_of_landmark[Index(landmark.planes[k])];
    if (*std::min_element(corner.planes.begin(), corner.planes.end()) < 0) continue;
    corner.position = landmark.position_in_map;
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    std::set<double> times;
    for (const PrimitiveObservation& observation : landmark.observations) {
      const Keyframe& keyframe = map.keyframes[Index(observation.keyframe)];
      const Corner& seen =
          keyframe.features.primitives_in_body.corners[Index(observation.primitive)];
      const Eigen::Matrix3d map_from_body = keyframe.map_from_body.linear();
      information += (map_from_body * seen.covariance * map_from_body.transpose()).inverse();
      const std::vector<double> seen_at = timesOfCorner(keyframe, observation.primitive);
      times.insert(seen_at.begin(), seen_at.end());
      corner.kind = seen.kind;
    }
    corner.observations.assign(times.begin(), times.end());
    corner.covariance = information.inverse();
    corner.orientation = cornerOrientation(landmark, map.landmarks);
    result.corners.push_back(std::move(corner));
  }
}

/// Landmarks whose planes some scan found to share a normal.
void addFamilies(const MapState& map, const std::vector<int>& id_of_landmark, PlanarMap& result) {
  UnionFind parallel(map.landmarks.planes.size());
  for (const Keyframe& keyframe : map.keyframes) {
    for (const ParallelFamily& family : keyframe.features.primitives_in_body.families) {
      const int first = keyframe.landmark_of_plane[Index(family.planes.front())];
      for (const int plane : family.planes) {
        parallel.join(Index(first), Index(keyframe.landmark_of_plane[Index(plane)]));
      }
    }
  }
  std::map<Index, PlanarMapFamily> families;  // by representative landmark
  for (Index l = 0; l < id_of_landmark.size(); ++l) {
    if (id_of_landmark[l] >= 0) families[parallel.root(l)].planes.push_back(id_of_landmark[l]);
  }
  for (auto& [representative, family] : families) {
    family.id = static_cast<int>(result.families.size());
    const Eigen::Vector3d& reference = result.planes[Index(family.planes.front())].plane.normal();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int id : family.planes) {
      PlanarMapPlane& plane = result.planes[Index(id)];
      plane.family = family.id;
      sum += std::copysign(plane.area, plane.plane.normal().dot(reference)) * plane.plane.normal();
    }
    family.normal = sum.normalized();
    result.families.push_back(std::move(family));
  }
}

}  // namespace

PlanarMap planarMapOf(const MapState& map, const SensorModel& sensor, const PlanarParams& params) {
  PlanarMap result;
  std::vector<int> id_of_landmark;
  addPlanes(map, sensor, params, id_of_landmark, result);
  addFamilies(map, id_of_landmark, result);
  addLines(map, id_of_landmark, result);
  addCorners(map, id_of_landmark, result);
  snapPolygons(result, params);
  // Without a gravity sensor the first body frame's z axis is roughly up: see estimateUp.
  const auto up = estimateUp(result, Eigen::Vector3d::UnitZ(), params);
  if (up) classifyPlanes(result, *up, params);
  return result;
}

}  // namespace opp::mapping
