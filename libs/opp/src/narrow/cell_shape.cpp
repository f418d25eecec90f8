// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "narrow/cell_shape.h"

#include "geometry/planar_spread.h"

namespace opp {

CellShape::CellShape(const DepthImage& image, const Plane& plane,
                     const std::vector<PixelBlock>& cells) {
  const Eigen::Matrix<double, 3, 2> tangents = tangentBasis(plane.normal());
  PlanarSpread spread;
  for (const PixelBlock& cell : cells) {
    spread.add(tangents.col(0).dot(cell.point), tangents.col(1).dot(cell.point));
  }
  const PlanarSpread::Axes axes = spread.axes();
  in_line_ = !(axes.widths[0] > 0.0);
  SurfaceTurn form(axes.widths);
  for (const PixelBlock& cell : cells) {
    const double variance = image.noise().expected(cell.point.squaredNorm(), plane.d()) *
                            image.sensor().meanVariance(cell.count);
    const double offset = plane.signedDistance(cell.point);
    scatter_ += offset * offset / variance / static_cast<double>(cells.size());
    const Eigen::Vector2d place = tangents.transpose() * cell.point - spread.mean();
    form.add(axes.directions.transpose() * place, offset, variance);
  }
  turns_ = form.turns();
  bent_scatter_ = form.scatter();
}

bool CellShape::turns(double most, double sigmas) const {
  const auto isSure = [&](const SurfaceTurn::Turn& turn) {
    return turn.angle > most && turn.angle > sigmas * turn.error;
  };
  return in_line_ || isSure(turns_.first) || isSure(turns_.second);
}

}  // namespace opp
