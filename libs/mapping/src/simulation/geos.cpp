// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "geos.h"

#include <algorithm>
#include <stdexcept>

namespace opp::mapping {
inline namespace simulation_geometry {
namespace {

void keepMessage(const char* message, void* target) {
  *static_cast<std::string*>(target) = message;
}

double signedArea(const Ring2d& ring) {
  double doubled = 0.0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const Eigen::Vector2d a = ring[i] - ring[0], b = ring[i + 1] - ring[0];
    doubled += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * doubled;
}

}  // namespace

Geos::Geos() : handle_(GEOS_init_r()) {
  GEOSContext_setErrorMessageHandler_r(handle_, keepMessage, &message_);
}

Geos::~Geos() { GEOS_finish_r(handle_); }

Geos::Geometry Geos::own(GEOSGeometry* geometry) const {
  if (geometry == nullptr) throw std::runtime_error("polygon operation failed: " + message_);
  return {geometry, [h = handle_](GEOSGeometry* g) { GEOSGeom_destroy_r(h, g); }};
}

GEOSGeometry* Geos::ring(const Ring2d& vertices) const {
  const auto count = static_cast<unsigned>(vertices.size());
  GEOSCoordSequence* sequence = GEOSCoordSeq_create_r(handle_, count + 1, 2);
  for (unsigned i = 0; i <= count; ++i) {
    const Eigen::Vector2d& v = vertices[i % count];
    GEOSCoordSeq_setXY_r(handle_, sequence, i, v.x(), v.y());
  }
  GEOSGeometry* result = GEOSGeom_createLinearRing_r(handle_, sequence);
  if (result == nullptr) throw std::runtime_error("polygon operation failed: " + message_);
  return result;
}

Geos::Geometry Geos::polygon(const Polygon2d& polygon) const {
  std::vector<GEOSGeometry*> holes;
  for (const Ring2d& hole : polygon.holes) holes.push_back(ring(hole));
  return own(GEOSGeom_createPolygon_r(handle_, ring(polygon.outer), holes.data(),
                                      static_cast<unsigned>(holes.size())));
}

Geos::Geometry Geos::merged(std::vector<Geometry> parts) const {
  std::vector<GEOSGeometry*> raw;
  for (Geometry& part : parts) raw.push_back(part.release());
  const Geometry all = own(GEOSGeom_createCollection_r(handle_, GEOS_GEOMETRYCOLLECTION, raw.data(),
                                                       static_cast<unsigned>(raw.size())));
  return own(GEOSUnaryUnion_r(handle_, all.get()));
}

std::vector<Polygon2d> Geos::polygons(const GEOSGeometry* geometry) const {
  std::vector<Polygon2d> result;
  if (GEOSisEmpty_r(handle_, geometry) != 0) return result;
  if (GEOSGeomTypeId_r(handle_, geometry) == GEOS_POLYGON) {
    Polygon2d polygon{vertices(GEOSGetExteriorRing_r(handle_, geometry), true), {}};
    for (int k = 0; k < GEOSGetNumInteriorRings_r(handle_, geometry); ++k) {
      polygon.holes.push_back(vertices(GEOSGetInteriorRingN_r(handle_, geometry, k), false));
    }
    return {polygon};
  }
  if (GEOSGeomTypeId_r(handle_, geometry) < GEOS_MULTIPOINT) return result;  // points and lines
  for (int k = 0; k < GEOSGetNumGeometries_r(handle_, geometry); ++k) {
    const auto part = polygons(GEOSGetGeometryN_r(handle_, geometry, k));
    result.insert(result.end(), part.begin(), part.end());
  }
  return result;
}

Ring2d Geos::vertices(const GEOSGeometry* ring, bool counter_clockwise) const {
  const GEOSCoordSequence* sequence = GEOSGeom_getCoordSeq_r(handle_, ring);
  unsigned count = 0;
  GEOSCoordSeq_getSize_r(handle_, sequence, &count);
  Ring2d result(count > 0 ? count - 1 : 0);
  for (unsigned i = 0; i < result.size(); ++i) {
    GEOSCoordSeq_getXY_r(handle_, sequence, i, &result[i].x(), &result[i].y());
  }
  if ((signedArea(result) > 0.0) != counter_clockwise) std::reverse(result.begin(), result.end());
  return result;
}

}  // namespace simulation_geometry
}  // namespace opp::mapping
