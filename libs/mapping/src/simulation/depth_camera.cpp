// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/depth_camera.h"

#include "opp/mapping/simulation/seeded_random.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace opp::mapping {
namespace {

std::uint16_t countsOf(double depth, double unit) {
  const double counts = std::round(depth / unit);
  constexpr double kMost = std::numeric_limits<std::uint16_t>::max();
  return counts >= 1.0 && counts <= kMost ? static_cast<std::uint16_t>(counts) : std::uint16_t{0};
}

DepthImage blankImage(const PinholeCamera& camera, double range_unit, double max_range) {
  if (camera.width < 1 || camera.height < 1) {
    throw std::invalid_argument("depth camera: the image has no pixels");
  }
  DepthImage image;
  image.camera = camera;
  image.range_unit = range_unit;
  image.max_range = max_range;
  const auto count =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  image.counts.assign(count, 0);
  image.true_depth.assign(count, 0.0);
  image.sides.assign(count, -1);
  return image;
}

double angleOfIncidence(const Eigen::Vector3d& normal, const Eigen::Vector3d& direction) {
  return std::acos(std::min(1.0, std::abs(normal.dot(direction)) / direction.norm()));
}

/// One Kinect exposure: what all pixels share.
class KinectExposure {
 public:
  KinectExposure(const RayTracer& tracer, const Eigen::Isometry3d& map_from_sensor,
                 const PinholeCamera& camera, const KinectModel& model)
      : tracer_(tracer), map_from_sensor_(map_from_sensor), camera_(camera), model_(model) {
    projector_in_map_ = map_from_sensor * Eigen::Vector3d(0.0, -model.baseline, 0.0);
  }

  /// Traces the pixel's displaced ray; writes depth and side where the surface can be measured.
  void expose(int column, int row, SeededRandom& random, DepthImage& image) const {
    const double displaced_column = column + model_.lateral_noise * random.normal();
    const double displaced_row = row + model_.lateral_noise * random.normal();
    const Eigen::Vector3d direction =
        map_from_sensor_.linear() * camera_.direction(displaced_column, displaced_row);
    const Eigen::Vector3d origin = map_from_sensor_.translation();
    const RayHit hit = tracer_.trace(origin, direction);
    if (!hit.valid()) return;
    const std::size_t i = image.index(column, row);
    image.true_depth[i] = hit.distance;  // the direction's component along the axis is 1
    const double angle = angleOfIncidence(tracer_.sideNormal(hit.side), direction);
    const double loss =
        (angle - model_.grazing_start) / (model_.grazing_end - model_.grazing_start);
    if (random.uniform() < loss) return;
    if (tracer_.blocked(projector_in_map_, origin + hit.distance * direction)) return;
    image.sides[i] = hit.side;
  }

  double measured(double depth, SeededRandom& random) const {
    if (model_.disparity_step <= 0.0) return depth;
    const double disparity = 1.0 / (depth * model_.disparity_step);
    const double rounded = std::round(disparity + model_.disparity_noise * random.normal());
    const double result = rounded > 0.0 ? 1.0 / (rounded * model_.disparity_step) : 0.0;
    return result >= model_.min_range && result <= model_.max_range ? result : 0.0;
  }

  bool atEdge(int column, int row, const DepthImage& image) const {
    const double depth = image.true_depth[image.index(column, row)];
    const int r = model_.edge_radius;
    for (int v = std::max(0, row - r); v <= std::min(camera_.height - 1, row + r); ++v) {
      for (int u = std::max(0, column - r); u <= std::min(camera_.width - 1, column + r); ++u) {
        const double step = std::abs(image.true_depth[image.index(u, v)] - depth);
        if (step > model_.edge_jump * depth) return true;
      }
    }
    return false;
  }

 private:
  const RayTracer& tracer_;
  const Eigen::Isometry3d& map_from_sensor_;
  const PinholeCamera& camera_;
  const KinectModel& model_;
  Eigen::Vector3d projector_in_map_;
};

}  // namespace

PinholeCamera PinholeCamera::decimated(int factor) const {
  if (factor < 1 || factor > std::min(width, height)) {
    throw std::invalid_argument("depth camera: decimation must be from 1 to the image's size");
  }
  // Pixel centres are at whole numbers: a block of pixels begins half a pixel before them.
  return {width / factor, height / factor,           fx / factor,
          fy / factor,    (cx + 0.5) / factor - 0.5, (cy + 0.5) / factor - 0.5};
}

DepthImage renderIdeal(const RayTracer& tracer, const Eigen::Isometry3d& map_from_sensor,
                       const PinholeCamera& camera, double range_unit) {
  if (!(range_unit > 0.0)) throw std::invalid_argument("depth camera: range_unit must be > 0");
  DepthImage image =
      blankImage(camera, range_unit, range_unit * std::numeric_limits<std::uint16_t>::max());
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      const Eigen::Vector3d direction = map_from_sensor.linear() * camera.direction(column, row);
      const RayHit hit = tracer.trace(map_from_sensor.translation(), direction);
      if (!hit.valid()) continue;
      const std::size_t i = image.index(column, row);
      image.true_depth[i] = hit.distance;
      image.counts[i] = countsOf(hit.distance, range_unit);
      if (image.counts[i] != 0) image.sides[i] = hit.side;
    }
  }
  return image;
}

DepthImage renderKinect(const RayTracer& tracer, const Eigen::Isometry3d& map_from_sensor,
                        const PinholeCamera& camera, const KinectModel& model, std::uint64_t seed,
                        std::uint64_t stream) {
  validate(model);
  DepthImage image = blankImage(camera, model.range_unit, model.max_range);
  const KinectExposure exposure(tracer, map_from_sensor, camera, model);
  std::vector<SeededRandom> random;
  random.reserve(image.counts.size());
  for (std::size_t i = 0; i < image.counts.size(); ++i) random.emplace_back(seed, stream, i);
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      exposure.expose(column, row, random[image.index(column, row)], image);
    }
  }
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      const std::size_t i = image.index(column, row);
      if (image.sides[i] < 0) continue;
      const bool fails =
          exposure.atEdge(column, row, image) && random[i].uniform() < model.edge_dropout;
      const double depth = fails ? 0.0 : exposure.measured(image.true_depth[i], random[i]);
      image.counts[i] = countsOf(depth, model.range_unit);
      if (image.counts[i] == 0) image.sides[i] = -1;
    }
  }
  return image;
}

}  // namespace opp::mapping
