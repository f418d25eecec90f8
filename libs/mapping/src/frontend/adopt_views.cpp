// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/adopt_views.h"

#include "opp/mapping/frontend/insert_keyframe.h"
#include "opp/mapping/registration/plane_samples.h"

#include "frontend/landmark_support.h"

#include <algorithm>
#include <array>

namespace opp::mapping {
namespace {

using Index = std::size_t;

/// Samples of several scans share their error as those of one do.
PlaneFactor factorOf(int keyframe, const PlanePrimitive& seen, const SensorModel& sensor) {
  PlaneFactor factor{keyframe, -1, seen.moments, effectiveCount(seen.support, sensor)};
  factor.moments_in_body.scaleWeights(factor.effective_samples / seen.support);
  return factor;
}

/// A plane that no keyframe saw.
struct NewPlane {
  int view = 0;
  PlaneFactor factor;  ///< of no landmark yet
  LandmarkSupport support;
};

/// Finds or makes the landmarks of planes that no keyframe saw.
class Adopter {
 public:
  Adopter(const SensorModel& sensor, MapState& map)
      : sensor_(sensor),
        map_(map),
        supports_(supportsOf(map)),
        known_(map.landmarks.planes.size()) {}

  void adopt() {
    std::vector<NewPlane> planes;
    for (Index k = 0; k < map_.keyframes.size(); ++k) {
      const std::vector<PlaneView>& views = map_.keyframes[k].views.planes;
      for (Index v = 0; v < views.size(); ++v) {
        if (views[v].keyframe_plane >= 0) continue;
        const PlaneFactor factor = factorOf(static_cast<int>(k), views[v].seen, sensor_);
        planes.push_back({static_cast<int>(v), factor, supportOf(factor, map_)});
      }
    }
    std::stable_sort(planes.begin(), planes.end(), [](const NewPlane& a, const NewPlane& b) {
      return a.support.moments.weight() > b.support.moments.weight();
    });
    for (const NewPlane& plane : planes) adopt(plane);
  }

 private:
  void adopt(const NewPlane& plane) {
    Keyframe& keyframe = map_.keyframes[Index(plane.factor.keyframe)];
    PlaneView& view = keyframe.views.planes[Index(plane.view)];
    std::vector<PlanePrimitive>& planes = keyframe.features.primitives_in_body.planes;
    const int landmark = landmarkOf(plane, transformed(keyframe.map_from_body, view.seen.plane));
    view.keyframe_plane = static_cast<int>(planes.size());
    planes.push_back(view.seen);
    keyframe.landmark_of_plane.push_back(landmark);
    map_.factors.planes.push_back(plane.factor);
    map_.factors.planes.back().landmark = landmark;
  }

  /// The landmark that it is, or a new one.
  int landmarkOf(const NewPlane& plane, const Plane& in_map) {
    std::vector<PlaneLandmark>& landmarks = map_.landmarks.planes;
    Index best = landmarks.size();
    double least = 1.0;
    for (Index l = 0; l < supports_.size(); ++l) {
      const LandmarkSupport& support = supports_[l];
      if (support.moments.empty() || seenTogether(support, plane.support)) continue;
      const double excess =
          oneSurfaceExcess(landmarks[l].plane_in_map, support, in_map, plane.support);
      if (excess > least) continue;
      least = excess;
      best = l;
    }
    if (best == landmarks.size()) {
      landmarks.push_back({in_map, {}});
      supports_.push_back(plane.support);
    } else {
      supports_[best].merge(plane.support);
      // What is known is optimized, together with angles between planes.
      if (best >= known_) {
        const PointMoments& all = supports_[best].moments;
        landmarks[best].plane_in_map = all.fitPlane(all.mean() + in_map.normal());
      }
    }
    return static_cast<int>(best);
  }

  const SensorModel& sensor_;
  MapState& map_;
  std::vector<LandmarkSupport> supports_;  ///< by landmark
  Index known_;                            ///< landmarks that keyframes saw
};

template <std::size_t N>
std::array<int, N> keyframePlanes(const std::array<int, N>& of_views, const ScanViews& views) {
  std::array<int, N> result{};
  for (Index k = 0; k < N; ++k) result[k] = views.planes[Index(of_views[k])].keyframe_plane;
  return result;
}

template <typename Primitive>
void adopt(const std::vector<Primitive>& seen, const ScanViews& views,
           std::vector<Primitive>& primitives) {
  for (Primitive primitive : seen) {
    primitive.planes = keyframePlanes(primitive.planes, views);
    primitives.push_back(primitive);
  }
}

}  // namespace

int adoptViews(const SensorModel& sensor, MapState& map) {
  const std::size_t known = map.landmarks.planes.size();
  Adopter(sensor, map).adopt();
  for (Keyframe& keyframe : map.keyframes) {
    Primitives& primitives = keyframe.features.primitives_in_body;
    adopt(keyframe.views.edges, keyframe.views, primitives.edges);
    adopt(keyframe.views.lines, keyframe.views, primitives.lines);
    std::vector<Corner> corners;
    for (const CornerView& view : keyframe.views.corners) corners.push_back(view.seen);
    adopt(corners, keyframe.views, primitives.corners);
    keyframe.views.adopted = true;
  }
  relink(map);
  return static_cast<int>(map.landmarks.planes.size() - known);
}

}  // namespace opp::mapping
