// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/registration/align_globally.h"
#include "opp/mapping/registration/corner_icp_params.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace opp::mapping {

/// How two scans are to be brought together.
enum class RegistrationMode : std::uint8_t {
  kAuto,     ///< near the initial guess if there is one, else or if that fails without any
  kCorners,  ///< corner-assisted ICP over what the common corners leave free
  kIcp,      ///< plain ICP from the initial guess (the identity if there is none)
};

/// Outcome of `registerScans`.
struct Registration {
  bool success = false;
  std::string reason;  ///< why there is no pose; empty on success
  RegistrationMode mode_used = RegistrationMode::kCorners;  ///< kCorners or kIcp
  /// Identity unless `success`: no pose is invented.
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< of (ω, v), see `retract`; zero unless `success`
  int dof = 6;           ///< parameters that corners left free in the last estimation: 0, 1, 3 or 6
  double overlap = 0.0;  ///< share of the better covered scan that agrees at the best pose found
  double rms = 0.0;      ///< distance of agreeing samples there [m]
  std::vector<CornerMatch> corner_matches;
};

/// Brings two scans together and answers only if they tell the pose; whatever way it was found, the
/// pose is verified both ways (see `alignGlobally`). kCorners estimates over the set of poses that
/// bring the corners together exactly (Sommer et al. 2020, Eq. 12–13), kAuto over all of them with
/// all that the scans hold, which is more exact where corners are noisy. Deterministic.
/// \throws std::invalid_argument as alignGlobally and cornerIcp
Registration registerScans(const AlignmentInput& target, const AlignmentInput& source,
                           const std::optional<Eigen::Isometry3d>& initial_target_from_source,
                           RegistrationMode mode, const SensorModel& sensor,
                           const GlobalAlignmentParams& alignment, const CornerIcpParams& icp);

/// A cloud of unknown origin as an input of alignment. Its viewpoint is believed if it can have
/// seen most of the samples, and if the normals of the raw cloud do not point away from it; else
/// neither free space nor the sides of surfaces are known. An organized cloud is one view. \param
/// raw the cloud that `scan` was made of
AlignmentInput inputOfUnknownView(const ScanFeatures& scan, const PointCloud& raw);

}  // namespace opp::mapping
