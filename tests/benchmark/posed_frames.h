// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/scan_features.h"
#include "opp/mapping/evaluation/time_association.h"
#include "opp/params/primitive_params.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <string>
#include <vector>

namespace opp::mapping {

/// A scan with its true pose.
struct PosedFrame {
  ScanFeatures features;
  Eigen::Isometry3d map_from_body = Eigen::Isometry3d::Identity();
};

/// Each K-th scan of a rawlog that has a true pose, detected.
std::vector<PosedFrame> readPosedFrames(const std::string& rawlog, const std::string& poses,
                                        std::size_t every, const PrimitiveParams& primitives,
                                        const AssociationParams& association);

}  // namespace opp::mapping
