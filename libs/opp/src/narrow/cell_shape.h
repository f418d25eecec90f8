// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"

#include "cloud/depth_image.h"
#include "geometry/surface_turn.h"
#include "narrow/pixel_blocks.h"

#include <vector>

namespace opp {

/// How cells lie about a plane near them.
class CellShape {
 public:
  /// \param plane about the viewpoint. O(cells).
  CellShape(const DepthImage& image, const Plane& plane, const std::vector<PixelBlock>& cells);

  /// Mean squared offset from the plane, over that of the noise.
  double scatter() const { return scatter_; }
  /// The same from a quadratic form through the cells, per degree of freedom.
  double bentScatter() const { return bent_scatter_; }
  /// Whether that form turns by more than `most` [rad] across the cells, and by more than `sigmas`
  /// times what noise could feign. True where cells in a line do not tell.
  bool turns(double most, double sigmas) const;

 private:
  double scatter_ = 0.0, bent_scatter_ = 0.0;
  bool in_line_ = false;
  SurfaceTurn::Turns turns_;
};

}  // namespace opp
