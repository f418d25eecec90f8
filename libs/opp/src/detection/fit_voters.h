// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"

#include "detection/partners.h"

#include <Eigen/Core>

#include <optional>

namespace opp {

/// Mean of the voters' normals, each turned to the side of the unit vector `start`, and of `start`.
Eigen::Vector3d meanNormal(const Partners& voters, const Eigen::Vector3d& start);

/// The height along the unit vector `normal`, from the reference point [m], that most voters share:
/// mode of the heights, so that parallel surfaces within one peak do not mix. Needs voters.
double densestHeight(const Partners& voters, const Eigen::Vector3d& normal);

/// Plane through those voters that lie within the noise of it; coordinates as in Partners.
struct VotersFit {
  Plane plane;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  ///< of these voters
  int votes = 0;
};

/// Least squares of heights over planes that are nearly right already, a closed form: voting fits
/// some hundred planes a scan. Reused for the next fit.
class VoterFitter {
 public:
  explicit VoterFitter(Eigen::Index capacity);
  /// Starts from the plane (`origin`, unit `normal`). Empty if fewer than `min_votes` are left.
  std::optional<VotersFit> fit(const Partners& voters, const Eigen::Vector3d& origin,
                               const Eigen::Vector3d& normal, int min_votes);

 private:
  /// Coordinates (u, v, h) of the voters in the frame of the plane through `fit.mean`, and weights:
  /// 1/gate² within `widening` gates of it, else 0. Returns how many are within.
  int weigh(const Partners& voters, const VotersFit& fit,
            const Eigen::Matrix<double, 3, 2>& tangents, double widening);

  Eigen::ArrayXf u_, v_, h_, weight_;
};

}  // namespace opp
