// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/scan_features.h"

#include "support/synthetic_room.h"

namespace opp::test {

/// What perfect detection would make of a synthetic scene: its true planes, families, edges, the
/// lines and corners that have samples on all their planes, signatures from the samples. For tests
/// of what comes after detection. Position covariances are those of corners known to 1 mm.
Primitives truePrimitives(const SyntheticScene& scene);

/// A scan with its cloud and `truePrimitives`.
mapping::ScanFeatures trueFeatures(const SyntheticScene& scene);

constexpr double kTimeStep = 0.1;  ///< of `scanOfScene` [s]

/// The `step`-th scan of a body that sees all around in a scene; `sigma`: its noise [m].
mapping::ScanFeatures scanOfScene(const Rectangles& scene, int step,
                                  const Eigen::Isometry3d& scene_from_body, double sigma = 0.003);

/// The same in `furnishedRoom(room)`.
mapping::ScanFeatures scanOfRoom(std::uint64_t room, int step,
                                 const Eigen::Isometry3d& scene_from_body, double sigma = 0.003);

/// A body that walks a circle and sees all around, at its `step`-th scan.
Eigen::Isometry3d poseOnCircle(int step);

}  // namespace opp::test
