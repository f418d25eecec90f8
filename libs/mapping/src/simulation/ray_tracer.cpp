// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/ray_tracer.h"

#include "plane_coordinates.h"

#include <embree3/rtcore.h>

#include <algorithm>
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
  const auto triangles = geos.triangulate(polygon);
  std::vector<Triangle> result;
  for (const Polygon2d& triangle : geos.polygonsOf(triangles)) {
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
  // One building thread and the same instruction set on every machine that has it: the same tree
  // and the same choice where two faces meet.
  RTCDevice device = rtcNewDevice("threads=1,set_affinity=0,max_isa=avx2");
  RTCScene scene = nullptr;
  std::vector<Plane> planes;  ///< of each face
  std::vector<int> face_of_triangle;

  explicit Scene(const World& world);
  /// The hit with the distance to the face's plane instead of Embree's, which is \p found.
  RayHit exactHit(unsigned triangle, const Eigen::Vector3d& origin,
                  const Eigen::Vector3d& direction, double found) const;
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

constexpr std::size_t kPacket = 16;

void setRay(RTCRay16& packet, std::size_t k, const Eigen::Vector3d& origin,
            const Eigen::Vector3d& direction, float far) {
  const Eigen::Vector3f o = origin.cast<float>(), d = direction.cast<float>();
  packet.org_x[k] = o.x(), packet.org_y[k] = o.y(), packet.org_z[k] = o.z();
  packet.dir_x[k] = d.x(), packet.dir_y[k] = d.y(), packet.dir_z[k] = d.z();
  packet.tnear[k] = 0.0F;
  packet.tfar[k] = far;
  packet.time[k] = 0.0F;
  packet.mask[k] = ~0U;
  packet.id[k] = 0;
  packet.flags[k] = 0;
}

/// Rays 0 … count − 1 in packets: calls `fill(k, ray)` for each place k of a packet that gets a
/// ray, then `run(valid, first, size)` for the packet.
template <typename Fill, typename Run>
void forEachPacket(std::size_t count, const Fill& fill, const Run& run) {
  for (std::size_t first = 0; first < count; first += kPacket) {
    const std::size_t size = std::min(kPacket, count - first);
    alignas(64) std::array<int, kPacket> valid{};  // −1: take part
    for (std::size_t k = 0; k < size; ++k) {
      valid[k] = -1;
      fill(k, first + k);
    }
    run(valid.data(), first, size);
  }
}

RTCIntersectContext coherentContext() {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  return context;
}

}  // namespace

RayHit RayTracer::Scene::exactHit(unsigned triangle, const Eigen::Vector3d& origin,
                                  const Eigen::Vector3d& direction, double found) const {
  const int face = face_of_triangle[triangle];
  const Plane& plane = planes[static_cast<std::size_t>(face)];
  const double slope = plane.normal().dot(direction);
  const double distance = -plane.signedDistance(origin) / slope;
  // A face seen edge-on is as thin as nothing: there the two intersections disagree.
  if (!(std::abs(distance - found) <= kMaxDisagreement * found)) return {};
  return {2 * face + (slope < 0.0 ? 0 : 1), distance};
}

RayHit RayTracer::trace(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
  return trace(origin, std::vector<Eigen::Vector3d>{direction}).front();
}

std::vector<RayHit> RayTracer::trace(const Eigen::Vector3d& origin,
                                     const std::vector<Eigen::Vector3d>& directions) const {
  std::vector<RayHit> hits(directions.size());
  RTCIntersectContext context = coherentContext();
  RTCRayHit16 packet{};  // zero: Embree also looks at places that no ray takes
  forEachPacket(
      directions.size(),
      [&](std::size_t k, std::size_t i) {
        setRay(packet.ray, k, origin, directions[i], std::numeric_limits<float>::infinity());
        packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
        packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
      },
      [&](const int* valid, std::size_t first, std::size_t size) {
        rtcIntersect16(valid, scene_->scene, &context, &packet);
        for (std::size_t k = 0; k < size; ++k) {
          if (packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) continue;
          hits[first + k] = scene_->exactHit(packet.hit.primID[k], origin, directions[first + k],
                                             static_cast<double>(packet.ray.tfar[k]));
        }
      });
  return hits;
}

std::vector<bool> RayTracer::blocked(const Eigen::Vector3d& from,
                                     const std::vector<Eigen::Vector3d>& to, double slack) const {
  std::vector<bool> result(to.size());
  RTCIntersectContext context = coherentContext();
  RTCRay16 packet{};  // zero: as in trace()
  forEachPacket(
      to.size(),
      [&](std::size_t k, std::size_t i) {
        const Eigen::Vector3d direction = to[i] - from;
        const double part = std::max(0.0, 1.0 - slack / direction.norm());
        setRay(packet, k, from, direction, static_cast<float>(part));
      },
      [&](const int* valid, std::size_t first, std::size_t size) {
        rtcOccluded16(valid, scene_->scene, &context, &packet);
        for (std::size_t k = 0; k < size; ++k) result[first + k] = packet.tfar[k] < 0.0F;
      });
  return result;
}

Eigen::Vector3d RayTracer::sideNormal(int side) const {
  const Eigen::Vector3d& front = scene_->planes.at(static_cast<std::size_t>(side / 2)).normal();
  return side % 2 == 0 ? front : Eigen::Vector3d(-front);
}

}  // namespace opp::mapping
