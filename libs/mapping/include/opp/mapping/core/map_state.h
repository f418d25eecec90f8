// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/keyframe.h"
#include "opp/mapping/core/landmark_map.h"
#include "opp/mapping/core/map_factors.h"

#include <vector>

namespace opp::mapping {

/// The map as it grows: keyframes, landmarks, and the measurements that tie them together.
struct MapState {
  std::vector<Keyframe> keyframes;
  LandmarkMap landmarks;
  MapFactors factors;
};

}  // namespace opp::mapping
