// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/mapping/registration/alignment_input.h"
#include "opp/mapping/registration/global_alignment_params.h"

#include "registration/free_space.h"
#include "registration/voxel_index.h"

#include <cmath>
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
  ScanModel(const AlignmentInput& input, const SensorModel& sensor_model,
            const GlobalAlignmentParams& params);

  const OrientedCloud& cloud() const { return features.cloud_in_body; }
  const Primitives& primitives() const { return features.primitives_in_body; }
  int labelOf(std::uint32_t sample) const { return primitives().labels[sample]; }
  /// Plane that holds the sample's surface: the fitted plane of its label, else its own tangent.
  Plane surfaceAt(std::uint32_t sample) const;
  /// Do two normals, the second turned into the frame of the first, face the same way? Their sign
  /// counts only if it tells the side from which the surface was seen.
  bool alike(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double min_cosine) const {
    const double cosine = a.dot(b);
    return (sided ? cosine : std::abs(cosine)) > min_cosine;
  }

  const ScanFeatures& features;
  bool sided;   ///< the sign of normals has a meaning
  double area;  ///< of all samples [m²]
  SensorModel sensor;
  std::vector<PlaneDirection> directions;  ///< largest area first
  VoxelIndex voxels;
  FreeSpace free_space;
  std::vector<std::uint32_t> samples;            ///< even over directions of normals, ascending
  std::vector<std::uint32_t> screening_samples;  ///< fewer, in an order fit for giving up early
  std::vector<float> sigmas;                     ///< of each sample's offset along its normal [m]
};

}  // namespace opp::mapping
