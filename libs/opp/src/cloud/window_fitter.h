// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sampling_params.h"
#include "opp/cloud/sensor_model.h"

#include "cloud/noisy_plane.h"
#include "cloud/patches.h"
#include "cloud/point_noise.h"

#include <array>
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

/// How far a cloud is from the sensor model.
struct NoiseScales {
  double between = 1.0;  ///< variance seen between patches over the expected
  double within = 1.0;   ///< variance seen within patches over the expected
};

/// Fits planes to windows of patches, several at a time.
class WindowFitter {
 public:
  /// `patches` and `windows` must outlive this; `viewpoint` is relative to the patches' origin.
  WindowFitter(const Patches& patches, PatchWindows& windows, const Eigen::Vector3d& viewpoint,
               const SensorModel& sensor, const SamplingParams& params);

  /// What the next fits go by.
  void setNoise(const NoiseScales& scales) { scales_ = scales; }
  /// Writes fits[k] for each k of `patches`, which are all different.
  void fit(const std::vector<int>& patches, int radius, std::vector<WindowFit>& fits);
  /// Variance of a patch's points along the normal.
  double spreadOf(int patch, const Eigen::Vector3d& normal) const;

 private:
  /// Windows side by side; only the first `size` are in use.
  struct Batch {
    std::array<WindowSums, kLanes> windows;
    std::array<int, kLanes> patches{};
    int size = 0;
  };
  void fitBatch(const Batch& batch, int radius, std::vector<WindowFit>& fits);
  /// `fit` has its mean and freedom already.
  void judge(const WindowSums& window, int patch, int radius, const NoisyPlane& plane,
             WindowFit& fit);
  void setVariances(WindowFit& window, double range, double cos_incidence) const;
  /// True if one patch has more than half of the leverage in the window's narrow direction: beside
  /// a line of points a single other one always makes a perfect plane.
  bool hangsOnOnePatch(int patch, int radius, const Eigen::Vector3d& mean,
                       const Eigen::Vector3d& narrow);

  const Patches& patches_;
  PatchWindows& windows_;
  Eigen::Vector3d viewpoint_;
  SensorModel sensor_;
  SamplingParams params_;
  PointNoise noise_;
  double least_cosine_;  ///< of the incidence angle
  NoiseScales scales_;
  std::vector<int> window_;  ///< scratch
};

}  // namespace opp
