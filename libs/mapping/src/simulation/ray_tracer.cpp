// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/ray_tracer.h"

#include "plane_coordinates.h"

#include <embree3/rtcore.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace opp::mapping {
namespace {

/// Relative difference of the float32 and the exact distance that float32 rounding can explain.
constexpr double kMaxDisagreement = 1e-3;

using Triangle = std::array<Eigen::Vector3d, 3>;

/// Triangles that cover a face exactly: a fan where it is a triangle or quadrilateral without
/// holes of which the diagonal lies inside, else GEOS' constrained Delaunay triangulation.
std::vector<Triangle> triangulated(const Geos& geos, const Face& face) {
  if (face.outer.size() == 3 && face.holes.empty()) {
    return {{face.outer[0], face.outer[1], face.outer[2]}};
  }
  const PlaneCoordinates coordinates(face.plane);
  const auto polygon = geos.polygon(coordinates.polygon(face));
  const auto triangles =
      geos.own(GEOSConstrainedDelaunayTriangulation_r(geos.handle(), polygon.get()));
  std::vector<Triangle> result;
  for (const Polygon2d& triangle : geos.polygons(triangles.get())) {
    result.push_back({coordinates.point(triangle.outer.at(0)),
                      coordinates.point(triangle.outer.at(1)),
                      coordinates.point(triangle.outer.at(2))});
  }
  return result;
}

void requireNoError(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error != RTC_ERROR_NONE) {
    throw std::runtime_error("ray tracer: Embree error " + std::to_string(error));
  }
}

}  // namespace

struct RayTracer::Scene {
  // One building thread: the same tree, and so the same choice among equal distances, on every
  // machine load.
  RTCDevice device = rtcNewDevice("threads=1,set_affinity=0");
  RTCScene scene = nullptr;
  std::vector<Plane> planes;  ///< of each face
  std::vector<int> face_of_triangle;

  explicit Scene(const World& world);
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  ~Scene() {
    if (scene != nullptr) rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

RayTracer::Scene::Scene(const World& world) {
  const Geos geos;
  std::vector<Triangle> triangles;
  for (std::size_t f = 0; f < world.faces().size(); ++f) {
    planes.push_back(world.faces()[f].plane);
    for (const Triangle& triangle : triangulated(geos, world.faces()[f])) {
      triangles.push_back(triangle);
      face_of_triangle.push_back(static_cast<int>(f));
    }
  }
  scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  if (!triangles.empty()) {
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), 3 * triangles.size()));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), triangles.size()));
    requireNoError(device);
    for (std::size_t i = 0; i < 3 * triangles.size(); ++i) {
      Eigen::Map<Eigen::Vector3f>(vertices + 3 * i) = triangles[i / 3][i % 3].cast<float>();
      indices[i] = static_cast<unsigned>(i);
    }
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene, mesh);
    rtcReleaseGeometry(mesh);
  }
  rtcCommitScene(scene);
  requireNoError(device);
}

RayTracer::RayTracer(const World& world) : scene_(std::make_unique<Scene>(world)) {}
RayTracer::~RayTracer() = default;
RayTracer::RayTracer(RayTracer&&) noexcept = default;
RayTracer& RayTracer::operator=(RayTracer&&) noexcept = default;

namespace {

void setRay(RTCRay& ray, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
            float far) {
  const Eigen::Vector3f o = origin.cast<float>(), d = direction.cast<float>();
  ray.org_x = o.x(), ray.org_y = o.y(), ray.org_z = o.z();
  ray.dir_x = d.x(), ray.dir_y = d.y(), ray.dir_z = d.z();
  ray.tnear = 0.0F;
  ray.tfar = far;
  ray.time = 0.0F;
  ray.mask = ~0U;
  ray.id = 0;
  ray.flags = 0;
}

}  // namespace

RayHit RayTracer::trace(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
  RTCRayHit query;
  setRay(query.ray, origin, direction, std::numeric_limits<float>::infinity());
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  const int face = scene_->face_of_triangle[query.hit.primID];
  const Plane& plane = scene_->planes[static_cast<std::size_t>(face)];
  const double slope = plane.normal().dot(direction);
  const double distance = -plane.signedDistance(origin) / slope;
  // A face seen edge-on is as thin as nothing: there the two intersections disagree.
  const double found = static_cast<double>(query.ray.tfar);
  if (!(std::abs(distance - found) <= kMaxDisagreement * found)) return {};
  return {2 * face + (slope < 0.0 ? 0 : 1), distance};
}

bool RayTracer::blocked(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                        double slack) const {
  const Eigen::Vector3d direction = to - from;
  const double length = direction.norm();
  if (!(length > slack)) return false;
  RTCRay ray;
  setRay(ray, from, direction, static_cast<float>(1.0 - slack / length));
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene_->scene, &context, &ray);
  return ray.tfar < 0.0F;
}

Eigen::Vector3d RayTracer::sideNormal(int side) const {
  const Eigen::Vector3d& front = scene_->planes.at(static_cast<std::size_t>(side / 2)).normal();
  return side % 2 == 0 ? front : Eigen::Vector3d(-front);
}

}  // namespace opp::mapping
