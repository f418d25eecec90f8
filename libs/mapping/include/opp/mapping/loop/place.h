// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/core/scan_features.h"
#include "opp/mapping/registration/alignment_input.h"

#include <vector>

namespace opp::mapping {

/// Some keyframes of a map made one scan, in the body frame of the first of them: what a scan
/// without known pose is aligned with. It covers more of what the scan sees than any single
/// keyframe does, and knows more of what is free.
struct Place {
  int keyframe = 0;  ///< whose body frame it is in
  ScanFeatures features;
  std::vector<ScanView> views;  ///< of the map's keyframes, which must outlive the place

  /// Must not outlive the place.
  AlignmentInput input() const { return {features, views, true}; }
};

/// \param keyframe whose frame to use; \param keyframes ids of all that make up the place
Place placeOf(const MapState& map, int keyframe, const std::vector<int>& keyframes,
              const MapperParams& params);

}  // namespace opp::mapping
