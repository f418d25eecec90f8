// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planar/geos.h"

#include <algorithm>
#include <stdexcept>

namespace opp::mapping {
namespace {

/// [m] Coordinates of untied polygons are multiples of this: a million times the rounding of
/// doubles at 10 m, a millionth of what a sensor sees.
constexpr double kGrid = 1e-9;

void keepMessage(const char* message, void* text) { *static_cast<std::string*>(text) = message; }

}  // namespace

double signedArea(const Ring2d& ring) {
  double twice = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d& a = ring[i];
    const Eigen::Vector2d& b = ring[(i + 1) % ring.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

Geos::Geos() : handle_(GEOS_init_r()) {
  GEOSContext_setErrorMessageHandler_r(handle_, keepMessage, &error_);
}

Geos::~Geos() { GEOS_finish_r(handle_); }

Geos::Geometry Geos::checked(GEOSGeometry* geometry) const {
  if (geometry == nullptr) throw std::runtime_error("GEOS: " + error_);
  return Geometry(geometry, Deleter{handle_});
}

GEOSGeometry* Geos::linearRing(const Ring2d& ring) const {
  std::vector<double> buffer;
  for (std::size_t i = 0; i <= ring.size(); ++i) {
    const Eigen::Vector2d& vertex = ring[i % ring.size()];
    buffer.insert(buffer.end(), {vertex.x(), vertex.y()});
  }
  GEOSCoordSequence* sequence = GEOSCoordSeq_copyFromBuffer_r(
      handle_, buffer.data(), static_cast<unsigned>(ring.size() + 1), 0, 0);
  return checked(GEOSGeom_createLinearRing_r(handle_, sequence)).release();
}

Geos::Geometry Geos::polygon(const Polygon2d& polygon) const {
  std::vector<GEOSGeometry*> holes;
  for (const Ring2d& hole : polygon.holes) holes.push_back(linearRing(hole));
  return checked(GEOSGeom_createPolygon_r(handle_, linearRing(polygon.outer), holes.data(),
                                          static_cast<unsigned>(holes.size())));
}

Geos::Geometry Geos::collection(std::vector<Geometry> parts) const {
  std::vector<GEOSGeometry*> raw;
  for (Geometry& part : parts) raw.push_back(part.release());
  return checked(GEOSGeom_createCollection_r(handle_, GEOS_MULTIPOLYGON, raw.data(),
                                             static_cast<unsigned>(raw.size())));
}

Geos::Geometry Geos::unionOf(const Geometry& parts) const {
  return checked(GEOSUnaryUnion_r(handle_, parts.get()));
}

Geos::Geometry Geos::untied(const Geometry& geometry) const {
  GEOSMakeValidParams* params = GEOSMakeValidParams_create_r(handle_);
  GEOSMakeValidParams_setMethod_r(handle_, params, GEOS_MAKE_VALID_STRUCTURE);
  GEOSMakeValidParams_setKeepCollapsed_r(handle_, params, 0);
  GEOSGeometry* raw = GEOSMakeValidWithParams_r(handle_, geometry.get(), params);
  GEOSMakeValidParams_destroy_r(handle_, params);
  const Geometry valid = checked(raw);
  return checked(GEOSGeom_setPrecision_r(handle_, valid.get(), kGrid, 0));
}

Geos::Geometry Geos::simplify(const Geometry& geometry, double tolerance) const {
  return checked(GEOSTopologyPreserveSimplify_r(handle_, geometry.get(), tolerance));
}

Geos::Geometry Geos::triangulate(const Geometry& geometry) const {
  return checked(GEOSConstrainedDelaunayTriangulation_r(handle_, geometry.get()));
}

Ring2d Geos::ringOf(const GEOSGeometry* ring, bool counter_clockwise) const {
  const GEOSCoordSequence* sequence = GEOSGeom_getCoordSeq_r(handle_, ring);
  unsigned size = 0;
  GEOSCoordSeq_getSize_r(handle_, sequence, &size);
  Ring2d vertices(size == 0 ? 0 : size - 1);
  for (unsigned i = 0; i + 1 < size; ++i) {
    GEOSCoordSeq_getXY_r(handle_, sequence, i, &vertices[i].x(), &vertices[i].y());
  }
  if ((signedArea(vertices) > 0.0) != counter_clockwise) {
    std::reverse(vertices.begin(), vertices.end());
  }
  return vertices;
}

std::vector<Polygon2d> Geos::polygonsOf(const Geometry& geometry) const {
  std::vector<Polygon2d> polygons;
  const int parts = GEOSGetNumGeometries_r(handle_, geometry.get());
  for (int part = 0; part < parts; ++part) {
    const GEOSGeometry* polygon = GEOSGetGeometryN_r(handle_, geometry.get(), part);
    if (GEOSGeomTypeId_r(handle_, polygon) != GEOS_POLYGON ||
        GEOSisEmpty_r(handle_, polygon) == 1) {
      continue;
    }
    polygons.push_back({ringOf(GEOSGetExteriorRing_r(handle_, polygon), true), {}});
    const int holes = GEOSGetNumInteriorRings_r(handle_, polygon);
    for (int hole = 0; hole < holes; ++hole) {
      polygons.back().holes.push_back(
          ringOf(GEOSGetInteriorRingN_r(handle_, polygon, hole), false));
    }
  }
  return polygons;
}

}  // namespace opp::mapping
