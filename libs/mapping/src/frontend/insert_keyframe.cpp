// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/insert_keyframe.h"

#include "opp/mapping/registration/plane_samples.h"

#include "registration/observability.h"

#include <Eigen/LU>

#include <algorithm>
#include <utility>

namespace opp::mapping {
namespace {

/// Landmark of each plane of the new keyframe; landmarks are made for planes that are not known
/// yet.
std::vector<int> assignLandmarks(const Keyframe& keyframe,
                                 const std::vector<PlaneAssociation>& known,
                                 LandmarkMap& landmarks) {
  std::vector<int> landmark_of_plane(keyframe.features.primitives_in_body.planes.size(), -1);
  for (const PlaneAssociation& a : known) {
    landmark_of_plane[static_cast<std::size_t>(a.scan_plane)] = a.landmark;
  }
  for (std::size_t p = 0; p < landmark_of_plane.size(); ++p) {
    if (landmark_of_plane[p] >= 0) continue;
    landmark_of_plane[p] = static_cast<int>(landmarks.planes.size());
    const Plane& in_body = keyframe.features.primitives_in_body.planes[p].plane;
    landmarks.planes.push_back({transformed(keyframe.map_from_body, in_body), {}});
  }
  return landmark_of_plane;
}

Eigen::Vector3d meanPoint(const OrientedCloud& cloud) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& point : cloud.points) sum += point.cast<double>();
  return cloud.size() > 0 ? Eigen::Vector3d(sum / static_cast<double>(cloud.size())) : sum;
}

void addPlaneFactors(int id, const SensorModel& sensor, MapState& map) {
  const Keyframe& keyframe = map.keyframes[static_cast<std::size_t>(id)];
  const std::vector<PlaneSamples> planes = planeSamples(keyframe.features, sensor);
  for (std::size_t p = 0; p < planes.size(); ++p) {
    map.factors.planes.push_back(
        {id, keyframe.landmark_of_plane[p], planes[p].moments_in_body, planes[p].effective_count});
  }
}

void addObservations(int id, MapState& map) {
  const std::vector<int>& landmarks = map.keyframes[static_cast<std::size_t>(id)].landmark_of_plane;
  for (std::size_t p = 0; p < landmarks.size(); ++p) {
    map.landmarks.planes[static_cast<std::size_t>(landmarks[p])].observations.push_back(
        {id, static_cast<int>(p)});
  }
}

/// Adds the pair of landmarks unless it is there or is one landmark twice.
template <typename Factor>
void addPair(const Keyframe& keyframe, int plane_a, int plane_b, std::vector<Factor>& factors) {
  std::array<int, 2> pair = {keyframe.landmark_of_plane[static_cast<std::size_t>(plane_a)],
                             keyframe.landmark_of_plane[static_cast<std::size_t>(plane_b)]};
  std::sort(pair.begin(), pair.end());
  const bool known = std::any_of(factors.begin(), factors.end(),
                                 [&](const Factor& f) { return f.landmarks == pair; });
  if (!known && pair[0] != pair[1]) factors.push_back({pair});
}

void addAngles(const Keyframe& keyframe, MapFactors& factors) {
  const Primitives& primitives = keyframe.features.primitives_in_body;
  for (const OrthogonalityEdge& edge : primitives.edges) {
    addPair(keyframe, edge.planes[0], edge.planes[1], factors.orthogonalities);
  }
  for (const ParallelFamily& family : primitives.families) {
    // To the largest of the family: planes that are parallel to it are so to each other.
    const auto area = [&](int p) { return primitives.planes[static_cast<std::size_t>(p)].area; };
    const int largest = *std::max_element(family.planes.begin(), family.planes.end(),
                                          [&](int a, int b) { return area(a) < area(b); });
    for (const int plane : family.planes) addPair(keyframe, largest, plane, factors.parallelisms);
  }
}

void addCorners(int id, MapState& map) {
  const Keyframe& keyframe = map.keyframes[static_cast<std::size_t>(id)];
  const std::vector<Corner>& corners = keyframe.features.primitives_in_body.corners;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    std::array<int, 3> planes{};
    for (std::size_t k = 0; k < 3; ++k) {
      planes[k] = keyframe.landmark_of_plane[static_cast<std::size_t>(corners[c].planes[k])];
    }
    std::sort(planes.begin(), planes.end());
    if (planes[0] == planes[1] || planes[1] == planes[2]) continue;
    auto& landmarks = map.landmarks.corners;
    auto landmark = std::find_if(landmarks.begin(), landmarks.end(),
                                 [&](const CornerLandmark& l) { return l.planes == planes; });
    if (landmark == landmarks.end()) {
      landmark = landmarks.insert(landmarks.end(),
                                  {planes, keyframe.map_from_body * corners[c].position, {}});
    }
    landmark->observations.push_back({id, static_cast<int>(c)});
  }
}

/// What follows from which landmark each of a keyframe's planes is.
void link(int id, MapState& map) {
  addObservations(id, map);
  addAngles(map.keyframes[static_cast<std::size_t>(id)], map.factors);
  addCorners(id, map);
}

void addRelativePose(int id, const Matrix6d& point_information, MapState& map) {
  if (id == 0) return;
  const Eigen::Isometry3d& first = map.keyframes[static_cast<std::size_t>(id - 1)].map_from_body;
  const Eigen::Isometry3d& second = map.keyframes[static_cast<std::size_t>(id)].map_from_body;
  map.factors.relative_poses.push_back(
      {id - 1, id, first.inverse() * second, informationIn(first.linear(), point_information)});
}

}  // namespace

int insertKeyframe(ScanFeatures features, const MatchResult& match, const SensorModel& sensor,
                   MapState& map) {
  const int id = static_cast<int>(map.keyframes.size());
  const Eigen::Vector3d view_centre = meanPoint(features.cloud_in_body);
  Keyframe keyframe{match.map_from_body, std::move(features), {}, view_centre};
  keyframe.landmark_of_plane = assignLandmarks(keyframe, match.planes, map.landmarks);
  map.keyframes.push_back(std::move(keyframe));
  addPlaneFactors(id, sensor, map);
  link(id, map);
  addRelativePose(id, match.point_information, map);
  return id;
}

void relink(MapState& map) {
  std::vector<std::size_t> planes(map.keyframes.size());
  for (PlaneFactor& factor : map.factors.planes) {
    const auto k = static_cast<std::size_t>(factor.keyframe);
    factor.landmark = map.keyframes[k].landmark_of_plane[planes[k]++];
  }
  for (PlaneLandmark& landmark : map.landmarks.planes) landmark.observations.clear();
  map.factors.orthogonalities.clear();
  map.factors.parallelisms.clear();
  map.landmarks.corners.clear();
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) link(static_cast<int>(k), map);
}

void updateCorners(LandmarkMap& landmarks) {
  for (CornerLandmark& corner : landmarks.corners) {
    Eigen::Matrix3d normals;
    Eigen::Vector3d offsets;
    for (int k = 0; k < 3; ++k) {
      const Plane& plane =
          landmarks.planes[static_cast<std::size_t>(corner.planes[static_cast<std::size_t>(k)])]
              .plane_in_map;
      normals.row(k) = plane.normal().transpose();
      offsets[k] = -plane.d();
    }
    // The planes meet at right angles up to noise, so the matrix is far from singular.
    corner.position_in_map = normals.partialPivLu().solve(offsets);
  }
}

}  // namespace opp::mapping
