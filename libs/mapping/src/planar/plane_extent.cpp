// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/planar/plane_extent.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

namespace opp::mapping {
namespace {

/// Repetitions are removed whenever a list has doubled, so memory stays with the number of cells.
constexpr std::size_t kSmallList = 4096;

void sortUnique(std::vector<PlaneCell>& cells) {
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
}

void compactIfGrown(std::vector<PlaneCell>& cells) {
  if (cells.size() < kSmallList || cells.size() < cells.capacity()) return;
  sortUnique(cells);
  cells.reserve(2 * cells.size());
}

}  // namespace

PlaneFrame::PlaneFrame(const Plane& plane, const Eigen::Vector3d& u_hint) : plane_(plane) {
  const Eigen::Vector3d& normal = plane.normal();
  const Eigen::Vector3d along = u_hint - u_hint.dot(normal) * normal;
  // A hint nearly along the normal says nothing: below a hundredth its direction is noise.
  u_axis_ = along.norm() > 0.01 * u_hint.norm() ? Eigen::Vector3d(along.normalized())
                                                : Eigen::Vector3d(tangentBasis(normal).col(0));
  v_axis_ = normal.cross(u_axis_);
}

PlaneCell PlaneFrame::cellAt(const Eigen::Vector3d& point, double cell) const {
  const Eigen::Vector2d at = project(point) / cell;
  return {static_cast<std::int32_t>(std::floor(at.y())),
          static_cast<std::int32_t>(std::floor(at.x()))};
}

PlaneExtent::PlaneExtent(const PlaneFrame& frame, double cell) : frame_(frame), cell_(cell) {
  if (!(cell > 0.0)) throw std::invalid_argument("the cell of a plane's raster must be positive");
}

void PlaneExtent::mark(const Eigen::Vector2d& center, double footprint,
                       std::vector<PlaneCell>& cells) const {
  if (!center.allFinite()) return;
  // Cells whose centre lies in the square; at least the cell of the centre itself.
  const Eigen::Vector2d at = center / cell_;
  const double half = std::max(0.5 * footprint / cell_, 0.5);
  const auto first_row = static_cast<std::int32_t>(std::ceil(at.y() - half - 0.5));
  const auto first_column = static_cast<std::int32_t>(std::ceil(at.x() - half - 0.5));
  for (std::int32_t row = first_row; row + 0.5 < at.y() + half; ++row) {
    for (std::int32_t column = first_column; column + 0.5 < at.x() + half; ++column) {
      cells.push_back({row, column});
    }
  }
  compactIfGrown(cells);
}

void PlaneExtent::addSupport(const Eigen::Vector3d& point, double footprint) {
  mark(frame_.project(point), footprint, support_);
}

void PlaneExtent::addSightline(const Eigen::Vector3d& viewpoint, const Eigen::Vector3d& point,
                               double footprint, double clearance) {
  const double at_viewpoint = frame_.plane().signedDistance(viewpoint);
  const double at_point = frame_.plane().signedDistance(point);
  if (!(at_viewpoint > 0.0 && at_point < -clearance)) return;
  const double part = at_viewpoint / (at_viewpoint - at_point);
  mark(frame_.project(viewpoint + part * (point - viewpoint)), part * footprint, passed_);
}

std::vector<PlaneCell> PlaneExtent::supportCells() const {
  sortUnique(support_);
  return support_;
}

std::vector<PlaneCell> PlaneExtent::openCells() const {
  sortUnique(support_);
  sortUnique(passed_);
  std::vector<PlaneCell> open;
  std::set_difference(passed_.begin(), passed_.end(), support_.begin(), support_.end(),
                      std::back_inserter(open));
  return open;
}

}  // namespace opp::mapping
