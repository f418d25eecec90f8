// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/surface_turn.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace opp {

void SurfaceTurn::add(const Eigen::Vector2d& place, double height, double variance) {
  const Eigen::Vector2d t = place.cwiseQuotient(widths_);
  Vector6 row;
  row << 1.0, t.x(), t.y(), 0.5 * t.x() * t.x(), t.x() * t.y(), 0.5 * t.y() * t.y();
  known_ += row * row.transpose() / variance;
  sums_ += row * (height / variance);
  squares_ += height * height / variance;
  count_ += 1.0;
}

SurfaceTurn::Turns SurfaceTurn::turns() const {
  const Matrix6 covariance = known_.inverse();
  const auto turnOf = [&](int at, double width) {
    const double bend = covariance.row(at).dot(sums_);
    return Turn{std::abs(bend) / width, std::sqrt(std::max(0.0, covariance(at, at))) / width};
  };
  return {turnOf(3, widths_[0]), turnOf(5, widths_[1])};
}

double SurfaceTurn::scatter() const {
  const double freedom = count_ - 6.0;
  if (!(freedom > 0.0)) return std::numeric_limits<double>::infinity();
  return std::max(0.0, squares_ - sums_.dot(known_.inverse() * sums_)) / freedom;
}

}  // namespace opp
