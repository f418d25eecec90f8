// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/point_cloud.h"

#include <stdexcept>

namespace opp {

/// \throws std::invalid_argument if the parts of a cloud do not fit each other.
inline void check(const PointCloud& cloud) {
  if (cloud.hasNormals() && cloud.normals.size() != cloud.size()) {
    throw std::invalid_argument("a cloud needs one normal per point or none");
  }
  if (cloud.organized() &&
      static_cast<std::size_t>(cloud.rows) * static_cast<std::size_t>(cloud.cols) != cloud.size()) {
    throw std::invalid_argument("an organized cloud needs rows x cols points");
  }
  if (!cloud.viewpoint.allFinite()) {
    throw std::invalid_argument("the viewpoint of a cloud must be finite");
  }
}

}  // namespace opp
