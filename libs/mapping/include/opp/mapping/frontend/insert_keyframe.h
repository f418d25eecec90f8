// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/mapping/core/map_state.h"
#include "opp/mapping/registration/match_scan.h"

#include <vector>

namespace opp::mapping {

/// Makes a registered scan a keyframe: its planes become observations of the landmarks that `match`
/// associated them with or new landmarks, its corners likewise (a corner is known by its three
/// planes), its right angles and parallel planes factors, and what its loose points fix a relative
/// pose to the keyframe before. Returns the keyframe's id.
int insertKeyframe(ScanFeatures features, const MatchResult& match, const SensorModel& sensor,
                   MapState& map);

/// Makes anew what follows from which landmark each plane of a keyframe is
/// (`Keyframe::landmark_of_plane`): the landmarks of the plane factors, observations, corner
/// landmarks, right angles and parallel planes. O(P log P) for P pairs of planes of all keyframes.
void relink(MapState& map);

/// Puts each corner landmark where its three plane landmarks now meet; to be called after their
/// planes moved.
void updateCorners(LandmarkMap& landmarks);

}  // namespace opp::mapping
