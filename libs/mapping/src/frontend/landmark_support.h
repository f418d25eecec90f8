// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/mapping/core/map_state.h"

#include <set>
#include <vector>

namespace opp::mapping {

/// All samples of a plane landmark, in the map's frame.
struct LandmarkSupport {
  PointMoments moments;  ///< weights 1/variance [1/m²]; empty: nothing was seen
  double effective_samples = 0.0;
  double mean_range = 0.0;  ///< from the keyframes to what they saw [m], weighted as the samples
  std::set<int> keyframes;  ///< that saw it

  void merge(const LandmarkSupport& other);
};

/// What one keyframe saw; its moments must not be empty.
LandmarkSupport supportOf(const PlaneFactor& factor, const MapState& map);

/// Of each plane landmark, by id. O(factors).
std::vector<LandmarkSupport> supportsOf(const MapState& map);

/// Whether two patches in one plane touch, or nearly so.
bool touch(const LandmarkSupport& a, const LandmarkSupport& b);

/// Whether the samples lie in a plane to within `gate_sigmas` of their noise (root mean square).
bool fits(const LandmarkSupport& part, const Plane& common, double gate_sigmas);

/// Whether the samples lie in the plane to within `gate_sigmas` of their noise and of distortion
/// (root mean square).
bool explains(const Plane& plane, const LandmarkSupport& part, const SensorModel& sensor,
              double gate_sigmas);

/// Whether distortion may be all that sets a landmark apart from a common plane.
bool fitsDistorted(const LandmarkSupport& part, const Plane& own, const Plane& common,
                   const SensorModel& sensor, double gate_sigmas);

/// Whether two planes roughly face the same way: surfaces that do not are two.
bool faceAlike(const Plane& a, const Plane& b);

/// How much more the samples of both scatter about a common plane than each about its own, in units
/// of what noise explains in 99.9 % of cases (chi-square): above 1, they are two planes.
double commonPlaneExcess(const LandmarkSupport& a, const LandmarkSupport& b, const Plane& common);

/// The same for two planes that may be parts of one surface: infinite unless they face alike and
/// touch.
double oneSurfaceExcess(const Plane& plane_a, const LandmarkSupport& a, const Plane& plane_b,
                        const LandmarkSupport& b);

/// Whether two landmarks, wherever they lie, are proven to be parts of one plane: their samples
/// scatter about a common plane no more than about their own (99.9 % point of chi-square), and each
/// is known so well that it tells where the plane passes at the other's place to within
/// `resolution` (standard deviation [m]).
bool coplanar(const LandmarkSupport& a, const LandmarkSupport& b, const Plane& common,
              double resolution);

/// Whether a keyframe saw both.
bool seenTogether(const LandmarkSupport& a, const LandmarkSupport& b);

}  // namespace opp::mapping
