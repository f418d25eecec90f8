// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/export/scene_file.h"

#include "opp/geometry/constants.h"
#include "opp/mapping/evaluation/move_planar_map.h"
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
constexpr double kBorder = 1.05;      ///< the view is this much bigger than the map

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

void aim(const RenderOptions& options, const Eigen::AlignedBox3d& bounds,
         mrpt::opengl::CCamera& camera) {
  const Eigen::Vector3d center = bounds.center();
  const Eigen::Vector3d size = bounds.sizes().cwiseMax(1.0);
  const double aspect = static_cast<double>(options.width) / options.height;
  camera.setPointingAt(mrpt::math::TPoint3D(center.x(), center.y(), center.z()));
  if (options.view == SceneView::kTop) {
    // MRPT's orthographic camera shows a width of its distance.
    camera.setOrthogonal(true);
    camera.setZoomDistance(static_cast<float>(kBorder * std::max(size.x(), size.y() * aspect)));
    camera.setAzimuthDegrees(-90.0F);
    camera.setElevationDegrees(90.0F);
    return;
  }
  camera.setProjectiveFOVdeg(static_cast<float>(radToDeg(kFieldOfView)));
  const double narrowest = std::atan(std::tan(0.5 * kFieldOfView) * std::min(1.0, aspect));
  camera.setZoomDistance(static_cast<float>(kBorder * 0.5 * size.norm() / std::sin(narrowest)));
  camera.setAzimuthDegrees(static_cast<float>(radToDeg(options.azimuth)));
  camera.setElevationDegrees(static_cast<float>(radToDeg(options.elevation)));
}

mrpt::img::CImage draw(mrpt::opengl::COpenGLScene& scene, const Eigen::AlignedBox3d& bounds,
                       const RenderOptions& options) {
  const auto viewport = scene.getViewport();
  viewport->setCustomBackgroundColor({1.0F, 1.0F, 1.0F});
  viewport->setViewportClipDistances(0.05F,
                                     static_cast<float>(100.0 + 10.0 * bounds.sizes().norm()));
  // Walls all around are lit alike: much ambient light, a little from above.
  viewport->lightParameters().ambient = {0.6F, 0.6F, 0.6F, 1.0F};
  viewport->lightParameters().diffuse = {0.4F, 0.4F, 0.4F, 1.0F};
  viewport->lightParameters().specular = {0.0F, 0.0F, 0.0F, 1.0F};
  mrpt::opengl::CFBORender renderer(static_cast<unsigned>(options.width),
                                    static_cast<unsigned>(options.height));
  aim(options, bounds, renderer.getCamera(scene));
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
