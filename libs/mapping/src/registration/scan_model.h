// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/scan_features.h"
#include "opp/mapping/registration/global_alignment_params.h"

#include "registration/depth_map.h"
#include "registration/voxel_index.h"

#include <cstdint>
#include <vector>

namespace opp::mapping {

/// Planes that face the same way.
struct PlaneDirection {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< area-weighted mean, unit length
  double area = 0.0;                                 ///< of its planes [m²]
  std::vector<int> planes;
};

/// A scan made ready for the many questions of global alignment. Refers to the features it was made
/// of.
struct ScanModel {
  ScanModel(const ScanFeatures& features, const GlobalAlignmentParams& params);

  const OrientedCloud& cloud() const { return features.cloud_in_body; }
  const Primitives& primitives() const { return features.primitives_in_body; }
  int labelOf(std::uint32_t sample) const { return primitives().labels[sample]; }
  /// Plane that holds the sample's surface: the fitted plane of its label, else its own tangent.
  Plane surfaceAt(std::uint32_t sample) const;

  const ScanFeatures& features;
  std::vector<PlaneDirection> directions;  ///< largest area first
  VoxelIndex voxels;
  DepthMap depth;
  std::vector<std::uint32_t> samples;            ///< even over directions of normals, ascending
  std::vector<std::uint32_t> screening_samples;  ///< fewer, in an order fit for giving up early
};

}  // namespace opp::mapping
