// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <geos_c.h>

#include <memory>
#include <string>
#include <vector>

namespace opp::mapping {

using Ring2d = std::vector<Eigen::Vector2d>;  ///< does not repeat its first vertex

/// Polygon with holes in the plane: outer ring counter-clockwise, holes clockwise.
struct Polygon2d {
  Ring2d outer;
  std::vector<Ring2d> holes;
};

/// Twice the signed area is positive for counter-clockwise rings; this is the signed area.
double signedArea(const Ring2d& ring);

/// GEOS through its reentrant C interface; errors come as std::runtime_error. One per thread.
class Geos {
 public:
  struct Deleter {
    GEOSContextHandle_t handle;
    void operator()(GEOSGeometry* geometry) const { GEOSGeom_destroy_r(handle, geometry); }
  };
  using Geometry = std::unique_ptr<GEOSGeometry, Deleter>;

  Geos();
  ~Geos();
  Geos(const Geos&) = delete;
  Geos& operator=(const Geos&) = delete;

  GEOSContextHandle_t handle() const { return handle_; }  ///< for calls that have no method here
  /// Takes ownership. \throws std::runtime_error with GEOS' message if `geometry` is null.
  Geometry checked(GEOSGeometry* geometry) const;

  Geometry polygon(const Polygon2d& polygon) const;
  Geometry collection(std::vector<Geometry> parts) const;
  Geometry unionOf(const Geometry& parts) const;
  /// The area that an outline which may cross or touch itself encloses. Spikes and necks thinner
  /// than about a nanometre go: turned to another frame they would cross themselves by rounding.
  Geometry untied(const Geometry& geometry) const;
  Geometry simplify(const Geometry& geometry, double tolerance) const;
  /// Triangles that fill the polygons without further vertices.
  Geometry triangulate(const Geometry& geometry) const;
  /// All polygons of a geometry, with ring directions as Polygon2d demands.
  std::vector<Polygon2d> polygonsOf(const Geometry& geometry) const;

 private:
  Ring2d ringOf(const GEOSGeometry* ring, bool counter_clockwise) const;
  GEOSGeometry* linearRing(const Ring2d& ring) const;

  GEOSContextHandle_t handle_;
  mutable std::string error_;
};

}  // namespace opp::mapping
