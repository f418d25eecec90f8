// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"
#include "opp/geometry/point_moments.h"

namespace opp {

/// Samples of a plane, with weights 1/σ², and that plane.
struct SurfacePart {
  const PointMoments& moments;
  const Plane& plane;
};

/// Whether two parts (not empty, of almost the same normal) lie side by side: whether even
/// rectangles with their means and spreads do not overlap along the line through the means.
bool sideBySide(const SurfacePart& a, const SurfacePart& b);

/// Whether the plane `common` fits both parts nearly as well as their own planes do, so that they
/// are one surface.
///
/// Assignment to the nearest plane cuts a surface by its noise into halves that lie upon each
/// other. Parts that lie side by side were cut by their places: their own planes gain no more than
/// chance by that, and what neighbours err alike. Two surfaces with a step between them gain more,
/// though a plane that slants from one to the other fits both within their noise.
/// \param alike correlation of the errors of neighbouring samples.
bool isOneSurface(const Plane& common, const SurfacePart& a, const SurfacePart& b, double alike);

}  // namespace opp
