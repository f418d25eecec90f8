// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/place.h"

#include "opp/mapping/registration/plane_samples.h"
#include "opp/mapping/registration/surfel_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace opp::mapping {
namespace {

using Index = std::size_t;

class PlaceBuilder {
 public:
  PlaceBuilder(const MapState& map, int keyframe, const std::vector<int>& keyframes,
               const MapperParams& params)
      : map_(map),
        keyframes_(keyframes),
        params_(params),
        place_from_map_(map.keyframes[Index(keyframe)].map_from_body.inverse()) {
    place_.keyframe = keyframe;
  }

  Place build() {
    addSamples();
    addPlanes();
    for (const int id : keyframes_) {
      const Keyframe& keyframe = map_.keyframes[Index(id)];
      place_.views.push_back({&keyframe.features.cloud_in_body, placeFrom(keyframe)});
      addCorners(keyframe);
    }
    return std::move(place_);
  }

 private:
  Eigen::Isometry3d placeFrom(const Keyframe& keyframe) const {
    return place_from_map_ * keyframe.map_from_body;
  }

  /// Index among the place's planes; −1 for no landmark.
  int planeOf(int landmark) {
    if (landmark < 0) return -1;
    const auto next = static_cast<int>(plane_of_landmark_.size());
    return plane_of_landmark_.try_emplace(landmark, next).first->second;
  }

  /// The keyframes' samples, averaged where they lie in one cell of the centre's spacing.
  void addSamples() {
    OrientedCloud& cloud = place_.features.cloud_in_body;
    const OrientedCloud& centre = map_.keyframes[Index(place_.keyframe)].features.cloud_in_body;
    cloud.spacing = centre.spacing;
    cloud.viewpoint = centre.viewpoint;
    SurfelMap surfels(cloud.spacing, params_.registration.normal_gate);
    for (const int id : keyframes_) insertInto(surfels, map_.keyframes[Index(id)]);
    surfels.forEach([&](const Surfel& surfel) {
      cloud.points.push_back(surfel.mean);
      cloud.normals.push_back(surfel.normal);
      cloud.sigmas.push_back(1.0F / std::sqrt(surfel.weight));
      cloud.weights.push_back(1.0F);
      place_.features.primitives_in_body.labels.push_back(planeOf(surfel.landmark));
    });
  }

  void insertInto(SurfelMap& surfels, const Keyframe& keyframe) const {
    const Eigen::Isometry3f place_from_body = placeFrom(keyframe).cast<float>();
    const OrientedCloud& cloud = keyframe.features.cloud_in_body;
    for (Index i = 0; i < cloud.size(); ++i) {
      const int label = keyframe.features.primitives_in_body.labels[i];
      surfels.insert(place_from_body * cloud.points[i], place_from_body.linear() * cloud.normals[i],
                     sampleVariance(cloud, i, params_.primitives.sensor),
                     label < 0 ? -1 : keyframe.landmark_of_plane[Index(label)]);
    }
  }

  void addPlanes() {
    std::vector<PlanePrimitive>& planes = place_.features.primitives_in_body.planes;
    planes.resize(plane_of_landmark_.size());
    for (const auto& [landmark, p] : plane_of_landmark_) {
      planes[Index(p)].plane =
          transformed(place_from_map_, map_.landmarks.planes[Index(landmark)].plane_in_map);
    }
    const double cell = std::pow(place_.features.cloud_in_body.spacing, 2);
    for (const int label : place_.features.primitives_in_body.labels) {
      if (label < 0) continue;
      ++planes[Index(label)].support;
      planes[Index(label)].area += cell;
    }
    const std::set<int> members(keyframes_.begin(), keyframes_.end());
    for (const PlaneFactor& f : map_.factors.planes) {
      const auto known = plane_of_landmark_.find(f.landmark);
      if (known == plane_of_landmark_.end() || members.count(f.keyframe) == 0) continue;
      planes[Index(known->second)].moments.merge(
          transformed(placeFrom(map_.keyframes[Index(f.keyframe)]), f.moments_in_body));
    }
  }

  /// Corners that no keyframe before has shown.
  void addCorners(const Keyframe& keyframe) {
    const Eigen::Isometry3d place_from_body = placeFrom(keyframe);
    for (Corner corner : keyframe.features.primitives_in_body.corners) {
      std::array<int, 3> landmarks{};
      for (Index k = 0; k < 3; ++k) {
        landmarks[k] = keyframe.landmark_of_plane[Index(corner.planes[k])];
        corner.planes[k] = planeOf(landmarks[k]);
      }
      std::sort(landmarks.begin(), landmarks.end());
      const auto planes = place_.features.primitives_in_body.planes.size();
      const bool complete = std::all_of(corner.planes.begin(), corner.planes.end(),
                                        [&](int p) { return p >= 0 && Index(p) < planes; });
      if (!complete || !corners_.insert(landmarks).second) continue;
      corner.position = place_from_body * corner.position;
      corner.cloud_from_corner = place_from_body.linear() * corner.cloud_from_corner;
      corner.covariance =
          place_from_body.linear() * corner.covariance * place_from_body.linear().transpose();
      place_.features.primitives_in_body.corners.push_back(corner);
    }
  }

  const MapState& map_;
  const std::vector<int>& keyframes_;
  const MapperParams& params_;
  Eigen::Isometry3d place_from_map_;
  std::map<int, int> plane_of_landmark_;
  std::set<std::array<int, 3>> corners_;
  Place place_;
};

}  // namespace

Place placeOf(const MapState& map, int keyframe, const std::vector<int>& keyframes,
              const MapperParams& params) {
  return PlaceBuilder(map, keyframe, keyframes, params).build();
}

}  // namespace opp::mapping
