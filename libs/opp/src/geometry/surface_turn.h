// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace opp {

/// Fits heights over a plane by a quadratic form of the place; its second derivatives tell by how
/// much the surface turns across its extent.
class SurfaceTurn {
 public:
  /// \param widths of the surface along the axes of the places [m], > 0.
  explicit SurfaceTurn(const Eigen::Vector2d& widths) : widths_(widths) {}

  /// \param place from the surface's middle [m]; \param variance of the height [m²].
  void add(const Eigen::Vector2d& place, double height, double variance);

  struct Turn {
    double angle = 0.0;  ///< between the normals at both ends [rad], ≥ 0
    double error = 0.0;  ///< its standard deviation [rad]
  };
  /// Along each axis; not finite if the places do not tell it. O(1).
  struct Turns {
    Turn first, second;
  };
  Turns turns() const;
  /// Mean square of what the form leaves of the heights, over their variance, per degree of freedom;
  /// infinite where there is none. O(1).
  double scatter() const;

 private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  Eigen::Vector2d widths_;
  Matrix6 known_ = Matrix6::Zero();
  Vector6 sums_ = Vector6::Zero();
  double squares_ = 0.0, count_ = 0.0;
};

}  // namespace opp
