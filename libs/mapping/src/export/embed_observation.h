// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/observation_to_cloud.h"

#include <mrpt/obs/CObservation.h>

#include <filesystem>

namespace opp::mapping {

/// Makes an observation independent of files outside of the rawlog, and gives depth images points
/// in their sensor's frame. \throws std::runtime_error if it holds no usable measurement.
void embed(mrpt::obs::CObservation& observation, ObservationConverter& converter);

}  // namespace opp::mapping
