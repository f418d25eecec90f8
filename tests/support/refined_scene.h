// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/primitives/primitives.h"
#include "opp/refinement/refinement_params.h"

#include "support/random.h"
#include "support/synthetic_room.h"

namespace opp::test {

/// Parameters for samples without distortion, as synthetic scenes have.
RefinementParams undistortedSensor();

/// The six sides of a box that is seen from outside, from all around: each side is turned so that
/// it counts as seen from `viewpoint`.
Rectangles boxFromAllSides(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                           const Eigen::Vector3d& viewpoint);

/// Refines the scene's planes from a rough start (0.03 rad, 2 cm), finds corners and lines.
Primitives refinedScene(const SyntheticScene& scene, Random& random);

}  // namespace opp::test
