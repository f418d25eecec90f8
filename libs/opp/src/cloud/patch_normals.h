// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sampling_params.h"
#include "opp/cloud/sensor_model.h"

#include "cloud/patches.h"
#include "cloud/window_fitter.h"

#include <vector>

namespace opp {

/// Normal of one patch; zero: none that could be trusted.
struct PatchNormal {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double sigma =
      0.0;  ///< along the normal, of one raw point: the sensor model's, and lateral noise [m]
};

/// Normals of patches from windows around them. A window grows until its normal is certain enough;
/// a patch may take any window that holds it, so that next to an edge the window stays on the
/// patch's side: the edge-preserving filter of Kuwahara et al. (1976) with a plane in place of the
/// mean grey value.
class PatchNormals {
 public:
  /// `patches` and `windows` must outlive this.
  PatchNormals(const Patches& patches, PatchWindows& windows, const Eigen::Vector3d& viewpoint,
               const SensorModel& sensor, const SamplingParams& params);

  /// One normal per patch. O(patches) windows.
  std::vector<PatchNormal> estimate();

  /// Correlation of the errors of raw points in one patch, from the means of neighbouring patches,
  /// which scatter the more (1 + (n − 1) ρ times as much for n points); once estimate() is done.
  double noiseCorrelation() const;

 private:
  NoiseScales measureNoise();
  /// Fits the windows of these patches that have no fit of this radius yet.
  void prepare(const std::vector<int>& patches, int radius);
  bool fits(int patch, const WindowFit& plane) const;
  const WindowFit* bestWindow(int patch, int radius);
  int choose(int patch, int radius, PatchNormal& result);
  int sufficientRadius(const WindowFit& window, int radius) const;

  const Patches& patches_;
  PatchWindows& windows_;
  Eigen::Vector3d viewpoint_;  ///< relative to the patches' origin
  SamplingParams params_;
  WindowFitter fitter_;
  NoiseScales scales_;
  std::vector<WindowFit> fits_;  ///< of the current radius
  std::vector<int> fit_radius_;  ///< radius at which fits_[i] was computed; 0: never
  std::vector<int> candidates_;  ///< scratch
  std::vector<int> missing_;     ///< scratch
};

}  // namespace opp
