// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"

#include <Eigen/Geometry>

namespace opp {

/// Weighted moments of a point set up to second order: all that any sum of squared point-to-plane
/// distances needs, however many points there are. Kept centred, so that far-away clouds lose no
/// digits.
///
/// Σ wᵢ (n·xᵢ + d)² = πᵀ S π with S = Σ wᵢ (xᵢ,1)(xᵢ,1)ᵀ = weight·(mean,1)(mean,1)ᵀ + scatter.
class PointMoments {
 public:
  PointMoments() = default;
  /// Moments with these values: Σ wᵢ, Σ wᵢ xᵢ / Σ wᵢ, Σ wᵢ (xᵢ−mean)(xᵢ−mean)ᵀ.
  PointMoments(double weight, const Eigen::Vector3d& mean, const Eigen::Matrix3d& scatter)
      : weight_(weight), mean_(mean), scatter_(scatter) {}

  /// Adds a point with weight ≥ 0 (for least squares 1/σ²). Constant time.
  void add(const Eigen::Vector3d& point, double weight = 1.0);
  /// Multiplies all weights with `factor` ≥ 0.
  void scaleWeights(double factor);
  /// Adds all that `other` holds (Chan's update). Constant time.
  void merge(const PointMoments& other);

  double weight() const { return weight_; }              ///< Σ wᵢ
  const Eigen::Vector3d& mean() const { return mean_; }  ///< Σ wᵢ xᵢ / Σ wᵢ; zero if empty
  const Eigen::Matrix3d& scatter() const { return scatter_; }  ///< Σ wᵢ (xᵢ−mean)(xᵢ−mean)ᵀ
  bool empty() const { return weight_ <= 0.0; }

  /// Σ wᵢ (n·xᵢ + d)².
  double squaredError(const Plane& plane) const;
  /// The 4×4 matrix S of the class comment.
  Eigen::Matrix4d homogeneous() const;
  /// A 4×4 matrix L with L Lᵀ = S (rank-deficient S allowed): the residual of a plane π is Lᵀπ,
  /// four numbers that stand for all points (DESIGN: refinement with moments).
  Eigen::Matrix4d factor() const;
  /// Least-squares plane; the normal is turned toward `viewpoint`. Eigenvector of the scatter's
  /// least eigenvalue. \throws std::invalid_argument if empty.
  Plane fitPlane(const Eigen::Vector3d& viewpoint) const;
  /// Eigenvalues of scatter / weight, ascending [m²]; zero if empty.
  Eigen::Vector3d variances() const;

 private:
  friend PointMoments transformed(const Eigen::Isometry3d&, const PointMoments&);
  double weight_ = 0.0;
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d scatter_ = Eigen::Matrix3d::Zero();
};

/// The moments of the points expressed in frame b.
PointMoments transformed(const Eigen::Isometry3d& b_from_a, const PointMoments& moments_in_a);

/// Covariance of (α, β, δ) (see `tangentBasis`) of a plane that was fitted to `moments` with
/// weights 1/σ²: inverse of the normal equations JᵀJ, where the residual of a point is its signed
/// distance over σ. Directions that the points do not fix (a line of points, an empty set) get
/// `max_variance` [rad²].
Eigen::Matrix3d planeCovariance(const Plane& plane, const PointMoments& moments,
                                double max_variance = 1.0);

}  // namespace opp
