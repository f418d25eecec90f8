// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/core/scan_features.h"
#include "opp/mapping/registration/match_scan.h"

#include <vector>

namespace opp::mapping {

/// A scan that was not localized, and where motion expected the body.
struct LostScan {
  ScanFeatures scan;
  PosePrior predicted;  ///< map_from_body
};

/// Whether scans that were `lost` just before `found` (oldest first) deny that the latter was made
/// at `map_from_body`. They are registered with it one after the other, the newest first, as far as
/// they show the same; that puts the body at their times, too, and the earlier the time, the better
/// motion knows it. A body that was carried off may be where a scan resembles the map near the
/// place that it left; but to have been there right after it was last seen it must have leapt. What
/// only hid the map shows nothing of this, and denies nothing. O(lost scans), one registration
/// each.
bool deniedByLostScans(const std::vector<LostScan>& lost, const ScanFeatures& found,
                       const Eigen::Isometry3d& map_from_body, const MapperParams& params);

}  // namespace opp::mapping
