// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/insert_keyframe.h"

#include "opp/mapping/registration/plane_samples.h"

#include "registration/observability.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <map>
#include <set>
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

/// Makes what follows from which landmark each plane of a keyframe is. Knows what is there already:
/// a search through all of it for each pair would make `relink` quadratic.
class Linker {
 public:
  explicit Linker(MapState& map) : map_(map) {
    for (const auto& f : map.factors.orthogonalities) orthogonal_.insert(f.landmarks);
    for (const auto& f : map.factors.parallelisms) parallel_.insert(f.landmarks);
    auto& corners = map.landmarks.corners;
    for (std::size_t c = 0; c < corners.size(); ++c) corner_of_planes_[corners[c].planes] = c;
  }

  void link(int id) {
    addObservations(id);
    addAngles(keyframe(id));
    addCorners(id);
  }

 private:
  using Pair = std::array<int, 2>;

  const Keyframe& keyframe(int id) const { return map_.keyframes[static_cast<std::size_t>(id)]; }

  void addObservations(int id) {
    const std::vector<int>& landmarks = keyframe(id).landmark_of_plane;
    for (std::size_t p = 0; p < landmarks.size(); ++p) {
      map_.landmarks.planes[static_cast<std::size_t>(landmarks[p])].observations.push_back(
          {id, static_cast<int>(p)});
    }
  }

  /// Adds the pair of landmarks unless it is there or is one landmark twice.
  template <typename Factor>
  static void addPair(const Keyframe& keyframe, int plane_a, int plane_b, std::set<Pair>& known,
                      std::vector<Factor>& factors) {
    Pair pair = {keyframe.landmark_of_plane[static_cast<std::size_t>(plane_a)],
                 keyframe.landmark_of_plane[static_cast<std::size_t>(plane_b)]};
    std::sort(pair.begin(), pair.end());
    if (pair[0] != pair[1] && known.insert(pair).second) factors.push_back({pair});
  }

  void addAngles(const Keyframe& keyframe) {
    const Primitives& primitives = keyframe.features.primitives_in_body;
    for (const OrthogonalityEdge& edge : primitives.edges) {
      addPair(keyframe, edge.planes[0], edge.planes[1], orthogonal_, map_.factors.orthogonalities);
    }
    for (const ParallelFamily& family : primitives.families) {
      // To the largest of the family: planes that are parallel to it are so to each other.
      const auto area = [&](int p) { return primitives.planes[static_cast<std::size_t>(p)].area; };
      const int largest = *std::max_element(family.planes.begin(), family.planes.end(),
                                            [&](int a, int b) { return area(a) < area(b); });
      for (const int plane : family.planes)
        addPair(keyframe, largest, plane, parallel_, map_.factors.parallelisms);
    }
  }

  void addCorners(int id) {
    const std::vector<Corner>& corners = keyframe(id).features.primitives_in_body.corners;
    for (std::size_t c = 0; c < corners.size(); ++c) {
      std::array<int, 3> planes{};
      for (std::size_t k = 0; k < 3; ++k) {
        planes[k] = keyframe(id).landmark_of_plane[static_cast<std::size_t>(corners[c].planes[k])];
      }
      std::sort(planes.begin(), planes.end());
      if (planes[0] == planes[1] || planes[1] == planes[2]) continue;
      auto& landmarks = map_.landmarks.corners;
      const auto [known, is_new] = corner_of_planes_.try_emplace(planes, landmarks.size());
      if (is_new)
        landmarks.push_back({planes, keyframe(id).map_from_body * corners[c].position, {}});
      landmarks[known->second].observations.push_back({id, static_cast<int>(c)});
    }
  }

  MapState& map_;
  std::set<Pair> orthogonal_, parallel_;
  std::map<std::array<int, 3>, std::size_t> corner_of_planes_;
};

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
  Keyframe keyframe{match.map_from_body, std::move(features), {}, view_centre, {}};
  keyframe.landmark_of_plane = assignLandmarks(keyframe, match.planes, map.landmarks);
  map.keyframes.push_back(std::move(keyframe));
  addPlaneFactors(id, sensor, map);
  Linker(map).link(id);
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
  Linker linker(map);
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) linker.link(static_cast<int>(k));
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
