// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sampling_params.h"
#include "opp/cloud/sensor_model.h"

#include "cloud/patches.h"

#include <vector>

namespace opp {

/// Plane through all points of a window of patches, and how far it can be trusted.
struct WindowFit {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< to the viewpoint; zero: no plane
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();    ///< relative to the patches' origin
  // Variances along the normal, of one raw point [m²].
  double model_variance = 0.0;     ///< by the sensor model
  double expected_variance = 0.0;  ///< with lateral noise
  double variance = 0.0;           ///< as neighbouring patches of this cloud show it
  double spread_variance = 0.0;    ///< as points within patches show it
  double bend_variance = 0.0;      ///< of deviations that a tolerated curvature explains [m²]
  double between = 0.0;            ///< Σ n (distance of a patch's mean)², n points in the patch
  int freedom = 0;                 ///< patches more than a plane needs
  double misfit = 0.0;             ///< of the patches' means, over what noise and bend explain
  double surprise = 0.0;        ///< the same, in standard deviations above what noise alone gives
  double angle_variance = 0.0;  ///< of the normal, in its worse direction [rad²]
  double least_angle_variance = 0.0;  ///< the same, by the noise alone [rad²]

  bool found() const { return !normal.isZero(); }
  bool flat() const { return found() && misfit <= 1.0; }
};

/// Normal of one patch; zero: none that could be trusted.
struct PatchNormal {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double sigma = 0.0;  ///< along the normal, of one raw point, by the sensor model [m]
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
  void measureNoise();
  const WindowFit& fit(int patch, int radius);
  WindowFit fitWindow(int patch, int radius);
  /// True if one patch has more than half of the leverage in the window's narrow direction: beside
  /// a line of points a single other one always makes a perfect plane.
  bool hangsOnOnePatch(int patch, int radius, const Eigen::Vector3d& mean,
                       const Eigen::Vector3d& narrow);
  double spreadOf(int patch, const Eigen::Vector3d& normal) const;
  void setNoise(WindowFit& window, double range, double cos_incidence) const;
  bool fits(int patch, const WindowFit& plane) const;
  const WindowFit* bestWindow(int patch, int radius);
  int choose(int patch, int radius, PatchNormal& result);
  int sufficientRadius(const WindowFit& window, int radius) const;

  const Patches& patches_;
  PatchWindows& windows_;
  Eigen::Vector3d viewpoint_;  ///< relative to the patches' origin
  SensorModel sensor_;
  SamplingParams params_;
  double least_cosine_;          ///< of the incidence angle
  double noise_scale_ = 1.0;     ///< variance seen between patches over the expected
  double spread_scale_ = 1.0;    ///< variance seen within patches over the expected
  std::vector<WindowFit> fits_;  ///< of the current radius
  std::vector<int> fit_radius_;  ///< radius at which fits_[i] was computed; 0: never
  std::vector<int> window_;      ///< scratch
  std::vector<int> candidates_;  ///< scratch
};

}  // namespace opp
