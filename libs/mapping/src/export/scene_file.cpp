// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/export/scene_file.h"

#include "opp/geometry/constants.h"
#include "opp/mapping/core/move_planar_map.h"
#include "opp/mapping/io/atomic_file.h"
#include "opp/mapping/planar/level_frame.h"

#include "export/build_scene.h"

#include <Eigen/Geometry>
#include <mrpt/img/CImage.h>
#include <mrpt/opengl/CFBORender.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace opp::mapping {
namespace {

constexpr int kMinSize = 16;
constexpr int kMaxSize = 8192;
constexpr double kFieldOfView = 0.6;  ///< [rad] vertical, of the perspective view
/// [rad] vertical, of the top view: from so far away that walls seem to stand upright.
constexpr double kTopFieldOfView = 0.05;
constexpr double kBorder = 1.05;  ///< the top view is this much wider than the map
/// The perspective view encloses the map's circumscribed sphere times this: maps are flat.
constexpr double kFill = 0.95;

Eigen::AlignedBox3d boundsOf(const PlanarMap& map, const Trajectory& trajectory) {
  Eigen::AlignedBox3d bounds;
  for (const PlanarMapPlane& plane : map.planes) {
    for (const PlanarPolygon& polygon : plane.polygons) {
      for (const Eigen::Vector3d& vertex : polygon.outer) bounds.extend(vertex);
    }
  }
  for (const StampedPose& pose : trajectory) bounds.extend(pose.map_from_body.translation());
  if (bounds.isEmpty()) bounds.extend(Eigen::Vector3d::Zero());
  return bounds;
}

/// Points the camera at the map; returns the distance of the eye from its centre.
double aim(const RenderOptions& options, const Eigen::AlignedBox3d& bounds,
           mrpt::opengl::CCamera& camera) {
  const Eigen::Vector3d center = bounds.center();
  const Eigen::Vector3d size = bounds.sizes().cwiseMax(1.0);
  const double aspect = static_cast<double>(options.width) / options.height;
  const bool is_top = options.view == SceneView::kTop;
  const double field_of_view = is_top ? kTopFieldOfView : kFieldOfView;
  const double half_tangent = std::tan(0.5 * field_of_view);
  const double narrowest = std::atan(half_tangent * std::min(1.0, aspect));
  const double distance =
      is_top ? kBorder * 0.5 * std::max(size.y(), size.x() / aspect) / half_tangent + size.z()
             : kFill * 0.5 * size.norm() / std::sin(narrowest);
  camera.setPointingAt(mrpt::math::TPoint3D(center.x(), center.y(), center.z()));
  camera.setProjectiveFOVdeg(static_cast<float>(radToDeg(field_of_view)));
  camera.setZoomDistance(static_cast<float>(distance));
  camera.setAzimuthDegrees(is_top ? -90.0F : static_cast<float>(radToDeg(options.azimuth)));
  camera.setElevationDegrees(is_top ? 90.0F : static_cast<float>(radToDeg(options.elevation)));
  return distance;
}

mrpt::img::CImage draw(mrpt::opengl::COpenGLScene& scene, const Eigen::AlignedBox3d& bounds,
                       const RenderOptions& options) {
  const auto viewport = scene.getViewport();
  viewport->setCustomBackgroundColor({1.0F, 1.0F, 1.0F});
  // Walls all around are lit alike: much ambient light, a little from above.
  viewport->lightParameters().ambient = {0.6F, 0.6F, 0.6F, 1.0F};
  viewport->lightParameters().diffuse = {0.4F, 0.4F, 0.4F, 1.0F};
  viewport->lightParameters().specular = {0.0F, 0.0F, 0.0F, 1.0F};
  mrpt::opengl::CFBORender renderer(static_cast<unsigned>(options.width),
                                    static_cast<unsigned>(options.height));
  const double distance = aim(options, bounds, renderer.getCamera(scene));
  const double radius = std::max(1.0, bounds.sizes().norm());
  viewport->setViewportClipDistances(static_cast<float>(std::max(0.05, distance - radius)),
                                     static_cast<float>(distance + radius));
  mrpt::img::CImage image;
  renderer.render_RGB(scene, image);
  return image;
}

}  // namespace

void writeScene(const std::filesystem::path& path, const PlanarMap& map,
                const Trajectory& trajectory) {
  const auto scene = buildScene(map, trajectory);
  replaceFileAtomically(path, [&](const std::filesystem::path& temporary) {
    if (!scene->saveToFile(temporary.string())) {
      throw std::runtime_error(path.string() + " cannot be written as a 3D scene");
    }
  });
}

void renderScene(const std::filesystem::path& path, const PlanarMap& map,
                 const Trajectory& trajectory, const Eigen::Vector3d& up,
                 const RenderOptions& options) {
  for (const int size : {options.width, options.height}) {
    if (size < kMinSize || size > kMaxSize) {
      throw std::invalid_argument("an image's width and height must be in [16, 8192] pixels");
    }
  }
  const Eigen::Isometry3d level_from_map = levelFromMap(map, up);
  const PlanarMap level_map = movedPlanarMap(level_from_map, map);
  Trajectory level_trajectory = trajectory;
  for (StampedPose& pose : level_trajectory) {
    pose.map_from_body = level_from_map * pose.map_from_body;
  }
  const auto scene = buildScene(level_map, level_trajectory);
  const mrpt::img::CImage image = draw(*scene, boundsOf(level_map, level_trajectory), options);
  replaceFileAtomically(path, [&](const std::filesystem::path& temporary) {
    if (!image.saveToFile(temporary.string())) {
      throw std::runtime_error(path.string() + " cannot be written as an image");
    }
  });
}

}  // namespace opp::mapping
