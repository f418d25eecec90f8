// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/point_cloud.h"

#include "detection/voting_scene.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace opp {

/// Samples around one reference point, one array per number, so that loops over them vectorize.
/// Only the first `size` entries are in use.
struct Partners {
  explicit Partners(Eigen::Index capacity);

  Eigen::ArrayXf x, y, z;     ///< from the reference point [m]
  Eigen::ArrayXf nx, ny, nz;  ///< normals
  Eigen::ArrayXf gate;        ///< [m] largest distance of each from its plane
  Eigen::Index size = 0;

  void add(const Partners& from, Eigen::Index k) {
    x[size] = from.x[k], y[size] = from.y[k], z[size] = from.z[k];
    nx[size] = from.nx[k], ny[size] = from.ny[k], nz[size] = from.nz[k];
    gate[size++] = from.gate[k];
  }
};

/// Draws ≤ K partners of the sample `r` evenly from the cells about it. `cells` is scratch.
void drawPartners(const VotingScene& scene, std::uint32_t r,
                  std::vector<NeighbourhoodGrid::Range>& cells, Partners& partners);

}  // namespace opp
