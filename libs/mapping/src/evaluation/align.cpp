// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/evaluation/align.h"

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace opp::mapping {
namespace {

/// A position spread below this is rounding, not motion [m].
constexpr double kPositionResolution = 1e-9;
/// Ratio of the singular values of the cross-covariance below which the paths are straight. The
/// covariance is quadratic in lengths: this is a lateral extent of 1e-5 of the length.
constexpr double kStraightness = 1e-10;

/// Residuals below this (1 µm, 1 µrad) are rounding of the written digits and must not rule the
/// sum.
constexpr double kLeastVariance = 1e-12;
/// Weights settle within a few rounds: each one changes the rotation by less than the residuals.
constexpr int kReweightings = 10;

using Svd = Eigen::JacobiSVD<Eigen::Matrix3d>;

Svd decompose(const Eigen::Matrix3d& matrix) {
  return Svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
}

/// The rotation R that maximizes trace(Rᵀ·matrix) (Umeyama 1991, Eq. 40–43).
Eigen::Matrix3d nearestRotation(const Svd& svd) {
  const double sign = svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0 ? -1.0 : 1.0;
  return svd.matrixU() * Eigen::Vector3d(1.0, 1.0, sign).asDiagonal() * svd.matrixV().transpose();
}

/// Σ R_gt·(R·R_est)ᵀ: a rotation Q applied to R·R_est leaves Σ |R_gt − Q·R·R_est|² smallest where
/// trace(Qᵀ·this) is greatest.
Eigen::Matrix3d orientationCorrelation(const std::vector<PosePair>& pairs,
                                       const Eigen::Matrix3d& rotation) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const PosePair& pair : pairs) {
    sum += pair.gt_from_body.linear() * (rotation * pair.est_from_body.linear()).transpose();
  }
  return sum;
}

/// The turn Q about the unit vector `axis` that maximizes trace(Qᵀ·correlation). With Q = aaᵀ +
/// cos φ (I − aaᵀ) + sin φ [a]ₓ this is a cosine in φ whose peak is at atan2 of its two parts.
Eigen::Matrix3d bestTurnAbout(const Eigen::Vector3d& axis, const Eigen::Matrix3d& correlation) {
  const double cosine_part = correlation.trace() - axis.dot(correlation * axis);
  const Eigen::Vector3d twice_skew(correlation(2, 1) - correlation(1, 2),
                                   correlation(0, 2) - correlation(2, 0),
                                   correlation(1, 0) - correlation(0, 1));
  const double angle = std::atan2(axis.dot(twice_skew), cosine_part);
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

/// First and second moments of the positions of both sides.
struct PositionMoments {
  Eigen::Vector3d mean_gt = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_est = Eigen::Vector3d::Zero();
  Eigen::Matrix3d cross_covariance = Eigen::Matrix3d::Zero();  ///< gt·estᵀ [m²]
  double greater_spread = 0.0;  ///< standard deviation of the side that moves more [m]
};

PositionMoments momentsOf(const std::vector<PosePair>& pairs) {
  PositionMoments moments;
  const auto n = static_cast<double>(pairs.size());
  for (const PosePair& pair : pairs) {
    moments.mean_gt += pair.gt_from_body.translation() / n;
    moments.mean_est += pair.est_from_body.translation() / n;
  }
  double variance_gt = 0.0;
  double variance_est = 0.0;
  for (const PosePair& pair : pairs) {
    const Eigen::Vector3d gt = pair.gt_from_body.translation() - moments.mean_gt;
    const Eigen::Vector3d est = pair.est_from_body.translation() - moments.mean_est;
    moments.cross_covariance += gt * est.transpose() / n;
    variance_gt += gt.squaredNorm() / n;
    variance_est += est.squaredNorm() / n;
  }
  moments.greater_spread = std::sqrt(std::max(variance_gt, variance_est));
  return moments;
}

Eigen::Matrix3d alignRotation(const std::vector<PosePair>& pairs, const PositionMoments& moments) {
  const Svd svd = decompose(moments.cross_covariance);
  const Eigen::Vector3d& s = svd.singularValues();
  if (s[0] <= kPositionResolution * moments.greater_spread) {
    const auto identity = Eigen::Matrix3d::Identity();
    return nearestRotation(decompose(orientationCorrelation(pairs, identity)));
  }
  const Eigen::Matrix3d rotation = nearestRotation(svd);
  if (s[1] > kStraightness * s[0]) return rotation;
  return bestTurnAbout(svd.matrixU().col(0), orientationCorrelation(pairs, rotation)) * rotation;
}

void requireFinite(const std::vector<PosePair>& pairs) {
  for (const PosePair& pair : pairs) {
    if (!pair.gt_from_body.matrix().allFinite() || !pair.est_from_body.matrix().allFinite()) {
      throw std::invalid_argument("alignment of trajectories: a pose is not finite");
    }
  }
}

/// The motion with this rotation that brings the means of the positions together.
Eigen::Isometry3d throughMeans(const PositionMoments& moments, const Eigen::Matrix3d& rotation) {
  Eigen::Isometry3d gt_from_est = Eigen::Isometry3d::Identity();
  gt_from_est.linear() = rotation;
  gt_from_est.translation() = moments.mean_gt - rotation * moments.mean_est;
  return gt_from_est;
}

/// Mean squares of what an alignment leaves, in units of the two parts of alignPoses' sum.
struct Residuals {
  double position = 0.0;     ///< [m²]
  double orientation = 0.0;  ///< |R_gt − R·R_est|² in the Frobenius norm, 2 θ² for small angles
};

Residuals residualsOf(const std::vector<PosePair>& pairs, const Eigen::Isometry3d& gt_from_est) {
  Residuals sum;
  for (const PosePair& pair : pairs) {
    const Eigen::Isometry3d aligned = gt_from_est * pair.est_from_body;
    sum.position += (pair.gt_from_body.translation() - aligned.translation()).squaredNorm();
    sum.orientation += (pair.gt_from_body.linear() - aligned.linear()).squaredNorm();
  }
  const auto n = static_cast<double>(pairs.size());
  return {sum.position / n, sum.orientation / n};
}

}  // namespace

Eigen::Isometry3d alignTrajectories(const std::vector<PosePair>& pairs) {
  if (pairs.empty()) return Eigen::Isometry3d::Identity();
  requireFinite(pairs);
  const PositionMoments moments = momentsOf(pairs);
  return throughMeans(moments, alignRotation(pairs, moments));
}

Eigen::Isometry3d alignPoses(const std::vector<PosePair>& pairs) {
  Eigen::Isometry3d gt_from_est = alignTrajectories(pairs);
  if (pairs.empty()) return gt_from_est;
  const PositionMoments moments = momentsOf(pairs);
  const Eigen::Matrix3d orientations = orientationCorrelation(pairs, Eigen::Matrix3d::Identity()) /
                                       static_cast<double>(pairs.size());
  for (int k = 0; k < kReweightings; ++k) {
    const Residuals left = residualsOf(pairs, gt_from_est);
    const double position_weight = 1.0 / std::max(left.position, kLeastVariance);
    const double orientation_weight = 1.0 / std::max(left.orientation, kLeastVariance);
    gt_from_est =
        throughMeans(moments, nearestRotation(decompose(position_weight * moments.cross_covariance +
                                                        orientation_weight * orientations)));
  }
  return gt_from_est;
}

}  // namespace opp::mapping
