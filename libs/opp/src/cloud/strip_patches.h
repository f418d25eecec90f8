// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sampling_params.h"

#include "cloud/open_cells.h"
#include "cloud/point_noise.h"

#include <Eigen/Core>

#include <vector>

namespace opp {

/// The part of a strip that lies in one block of the grid.
struct StripPatch {
  Eigen::Vector3d point;   ///< mean of its raw points, from the viewpoint [m]
  Eigen::Vector3d normal;  ///< to the viewpoint
  double sigma = 0.0;      ///< along the normal, of one raw point [m]
  double count = 0.0;      ///< of raw points
};

/// Surfaces too narrow for windows of patches (door frames, edges of boards): regions of adjoining
/// cells at one height along one of `directions` (unit vectors), of at least 150 raw points. Their
/// cells scatter about the plane as noise does, they extend across their narrow side, and a free
/// fit turns from the direction by no more than noise allows; so slices of other surfaces are none.
/// Of several regions around a cell the largest is taken. O(directions × cells).
std::vector<StripPatch> findStrips(const OpenCells& cells,
                                   const std::vector<Eigen::Vector3d>& directions,
                                   const SamplingParams& params, const PointNoise& noise,
                                   double pixel_angle);

}  // namespace opp
