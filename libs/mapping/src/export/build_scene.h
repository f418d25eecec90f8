// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/planar_map.h"
#include "opp/mapping/core/trajectory.h"

#include <mrpt/opengl/COpenGLScene.h>

namespace opp::mapping {

/// The objects that writeScene describes.
mrpt::opengl::COpenGLScene::Ptr buildScene(const PlanarMap& map, const Trajectory& trajectory);

}  // namespace opp::mapping
