// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/registration/corner_icp.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>

namespace opp::mapping {
namespace {

/// Rotation that maximizes Σ targetᵀ R source of centred points (Kabsch).
Eigen::Matrix3d kabsch(const Eigen::Matrix3Xd& target, const Eigen::Matrix3Xd& source) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(target * source.transpose(),
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return svd.matrixU() * Eigen::Vector3d(1.0, 1.0, sign).asDiagonal() * svd.matrixV().transpose();
}

}  // namespace

CornerConstraint cornerConstraint(const std::vector<CornerPair>& corners,
                                  const Eigen::Isometry3d& initial, double collinear_spread) {
  CornerConstraint result;
  result.target_from_source = normalized(initial);
  if (corners.empty()) return result;

  const auto count = static_cast<Eigen::Index>(corners.size());
  Eigen::Matrix3Xd target(3, count), source(3, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    target.col(k) = corners[static_cast<std::size_t>(k)].in_target;
    source.col(k) = corners[static_cast<std::size_t>(k)].in_source;
  }
  const Eigen::Vector3d middle_t = target.rowwise().mean(), middle_s = source.rowwise().mean();
  target.colwise() -= middle_t;
  source.colwise() -= middle_s;

  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(
      Eigen::Matrix3d(target * target.transpose() / static_cast<double>(count)));
  // Standard deviation along the k-th widest direction.
  const auto deviation = [&](int k) {
    return std::sqrt(std::max(spread.eigenvalues()[2 - k], 0.0));
  };
  Eigen::Matrix3d rotation = result.target_from_source.linear();
  if (deviation(1) >= collinear_spread) {
    result.dof = 0;
    rotation = kabsch(target, source);
  } else if (deviation(0) >= collinear_spread) {
    result.dof = 1;
    result.axis_in_target = spread.eigenvectors().col(2);
    // The source's direction of the same line, with the sense that the correspondences give.
    const Eigen::Vector3d along = source * (target.transpose() * result.axis_in_target);
    rotation = Eigen::Quaterniond::FromTwoVectors(rotation * along, result.axis_in_target)
                   .toRotationMatrix() *
               rotation;
  } else {
    result.dof = 3;
  }
  result.pivot_in_target = middle_t;
  result.target_from_source.linear() = rotation;
  result.target_from_source.translation() = middle_t - rotation * middle_s;
  return result;
}

}  // namespace opp::mapping
