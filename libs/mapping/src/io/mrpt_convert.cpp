// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/mrpt_convert.h"

#include <mrpt/math/CMatrixFixed.h>
#include <mrpt/system/datetime.h>

namespace opp::mapping {

Eigen::Isometry3d toIsometry(const mrpt::poses::CPose3D& pose) {
  mrpt::math::CMatrixDouble44 matrix;
  pose.getHomogeneousMatrix(matrix);
  return Eigen::Isometry3d(Eigen::Matrix4d(matrix.asEigen()));
}

mrpt::poses::CPose3D toCPose3D(const Eigen::Isometry3d& transform) {
  mrpt::math::CMatrixDouble44 matrix;
  matrix.asEigen() = transform.matrix();
  return mrpt::poses::CPose3D(matrix);
}

double toSeconds(const mrpt::Clock::time_point& time) {
  return time == INVALID_TIMESTAMP ? 0.0 : mrpt::Clock::toDouble(time);
}

}  // namespace opp::mapping
