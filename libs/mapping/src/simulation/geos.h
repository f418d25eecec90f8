// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <geos_c.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace opp::mapping {
/// Apart from the class of the same name that the planar map uses.
inline namespace simulation_geometry {

using Ring2d = std::vector<Eigen::Vector2d>;  ///< does not repeat its first vertex

/// Polygon with holes in a plane's own coordinates; outer ring counter-clockwise, holes clockwise.
struct Polygon2d {
  Ring2d outer;
  std::vector<Ring2d> holes;
};

/// GEOS' C interface with ownership and errors as exceptions. Use one object per thread.
class Geos {
 public:
  using Geometry = std::unique_ptr<GEOSGeometry, std::function<void(GEOSGeometry*)>>;

  Geos();
  ~Geos();
  Geos(const Geos&) = delete;
  Geos& operator=(const Geos&) = delete;

  GEOSContextHandle_t handle() const { return handle_; }
  /// Takes ownership. \throws std::runtime_error with GEOS' message if `geometry` is null.
  Geometry own(GEOSGeometry* geometry) const;
  Geometry polygon(const Polygon2d& polygon) const;
  /// Union of all parts.
  Geometry merged(std::vector<Geometry> parts) const;
  /// Polygons of a geometry of any type, those in collections included; in GEOS' order.
  std::vector<Polygon2d> polygons(const GEOSGeometry* geometry) const;

 private:
  GEOSGeometry* ring(const Ring2d& vertices) const;
  Ring2d vertices(const GEOSGeometry* ring, bool counter_clockwise) const;

  GEOSContextHandle_t handle_;
  mutable std::string message_;
};

}  // namespace simulation_geometry
}  // namespace opp::mapping
