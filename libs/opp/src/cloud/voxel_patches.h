// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cloud/patches.h"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace opp {

/// Patches of an unorganized cloud: the points that share a cubic cell.
Patches makeVoxelPatches(const std::vector<Eigen::Vector3f>& points, double edge);

/// Windows of the (2·radius + 1)² nearest patches, as many as a window of a grid has. `patches`
/// must outlive it. O(log patches + window) each.
std::unique_ptr<PatchWindows> nearestPatches(const Patches& patches);

}  // namespace opp
