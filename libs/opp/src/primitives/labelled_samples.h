// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/point_cloud.h"
#include "opp/primitives/primitives.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace opp {

/// Mean extent of each plane's samples [m]; the cloud's spacing where a plane has none.
inline std::vector<double> spacingsOf(const OrientedCloud& cloud, const Primitives& scan) {
  std::vector<double> sums(scan.planes.size()), counts(scan.planes.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (scan.labels[i] < 0) continue;
    sums[static_cast<std::size_t>(scan.labels[i])] += cloud.extent(i);
    counts[static_cast<std::size_t>(scan.labels[i])] += 1.0;
  }
  for (std::size_t k = 0; k < sums.size(); ++k) {
    sums[k] = counts[k] > 0.0 ? sums[k] / counts[k] : cloud.spacing;
  }
  return sums;
}

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
