// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_factors.h"

#include <Eigen/Geometry>

namespace opp::mapping {

/// Lᵀ(Tᵀπ): blocks are the keyframe's quaternion (Eigen's xyzw) and translation, the plane's normal
/// and d.
class PlaneMomentCost {
 public:
  explicit PlaneMomentCost(const PointMoments& moments_in_body)
      : factor_(moments_in_body.factor()) {}

  template <typename T>
  bool operator()(const T* q, const T* t, const T* n, const T* d, T* residuals) const {
    const Eigen::Map<const Eigen::Quaternion<T>> map_from_body(q);
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> translation(t);
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> normal(n);
    const Eigen::Matrix<T, 3, 1> normal_in_body = map_from_body.conjugate() * normal;
    const T d_in_body = normal.dot(translation) + *d;
    for (int k = 0; k < 4; ++k) {
      residuals[k] =
          normal_in_body.dot(factor_.block<3, 1>(0, k).cast<T>()) + d_in_body * factor_(3, k);
    }
    return true;
  }

 private:
  Eigen::Matrix4d factor_;
};

/// Whitened (ω, v) between the measured and the estimated pose of the second keyframe in the first.
class RelativePoseCost {
 public:
  explicit RelativePoseCost(const RelativePoseFactor& factor);

  template <typename T>
  bool operator()(const T* q_first, const T* t_first, const T* q_second, const T* t_second,
                  T* residuals) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    const Eigen::Map<const Eigen::Quaternion<T>> first(q_first), second(q_second);
    const Eigen::Map<const Vector> first_t(t_first), second_t(t_second);
    const Eigen::Quaternion<T> first_from_second = first.conjugate() * second;
    const Eigen::Quaternion<T> error = first_from_second * rotation_.conjugate().cast<T>();
    Eigen::Matrix<T, 6, 1> omega_v;
    // 2·vec(q) is ω to third order; the sign of w makes q and −q the same rotation.
    omega_v.template head<3>() = (error.w() < T(0.0) ? T(-2.0) : T(2.0)) * error.vec();
    omega_v.template tail<3>() =
        first.conjugate() * Vector(second_t - first_t) - translation_.cast<T>();
    Eigen::Map<Eigen::Matrix<T, 6, 1>> whitened(residuals);
    whitened = sqrt_information_.cast<T>() * omega_v;
    return true;
  }

 private:
  Eigen::Quaterniond rotation_;
  Eigen::Vector3d translation_;
  Matrix6d sqrt_information_;
};

/// cos(angle)/σ of two normals; for small deviations the deviation from 90° over σ (Sommer et al.
/// 2020, Eq. 10).
class OrthogonalityCost {
 public:
  explicit OrthogonalityCost(double sigma) : sigma_(sigma) {}

  template <typename T>
  bool operator()(const T* n1, const T* n2, T* residual) const {
    residual[0] = (n1[0] * n2[0] + n1[1] * n2[1] + n1[2] * n2[2]) / sigma_;
    return true;
  }

 private:
  double sigma_;
};

/// sin(angle)/σ of two normals as the vector n1 × n2 / σ: zero for equal and for opposite normals.
class ParallelismCost {
 public:
  explicit ParallelismCost(double sigma) : sigma_(sigma) {}

  template <typename T>
  bool operator()(const T* n1, const T* n2, T* residuals) const {
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> first(n1), second(n2);
    Eigen::Map<Eigen::Matrix<T, 3, 1>> cross(residuals);
    cross = first.cross(second) / T(sigma_);
    return true;
  }

 private:
  double sigma_;
};

}  // namespace opp::mapping
