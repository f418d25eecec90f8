// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/point_cloud.h"
#include "opp/primitives/primitives.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace opp {

/// Samples of each plane, in their order in the cloud.
/// \throws std::invalid_argument if labels do not fit to cloud and planes.
inline std::vector<std::vector<Eigen::Vector3d>> samplesByPlane(const OrientedCloud& cloud,
                                                                const Primitives& scan) {
  const auto planes = static_cast<int>(scan.planes.size());
  const bool known = std::all_of(scan.labels.begin(), scan.labels.end(),
                                 [planes](int label) { return label < planes; });
  if (scan.labels.size() != cloud.size() || !known) {
    throw std::invalid_argument("detected planes need one label per sample of the cloud");
  }
  std::vector<std::vector<Eigen::Vector3d>> samples(scan.planes.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (scan.labels[i] < 0) continue;
    samples[static_cast<std::size_t>(scan.labels[i])].push_back(cloud.points[i].cast<double>());
  }
  return samples;
}

}  // namespace opp
