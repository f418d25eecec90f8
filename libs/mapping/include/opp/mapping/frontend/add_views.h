// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/mapping/core/keyframe.h"
#include "opp/mapping/registration/match_scan.h"

#include <vector>

namespace opp::mapping {

/// Adds what a registered scan that is no keyframe saw to the views of the keyframe it follows.
///
/// A plane of the scan is the keyframe's, or one that was seen since, if registration found the
/// same landmark in both, or if they face the same way, touch, and scatter about one plane no more
/// than noise explains; planes that the scan tells apart stay apart. Planes, lines and corners do
/// not tie poses: a keyframe follows where too little is known for that, and they wait for
/// `adoptViews`. Memory grows with what is new in view, not with the number of scans.
///
/// \param known the scan's planes that are landmarks, see MatchResult
/// \param cell edge of the cells of the views' rasters [m]
///
/// O(samples + planes² of the keyframe's views).
void addViews(const ScanFeatures& scan, const std::vector<PlaneAssociation>& known,
              const Eigen::Isometry3d& keyframe_from_body, const SensorModel& sensor, double cell,
              Keyframe& keyframe);

}  // namespace opp::mapping
