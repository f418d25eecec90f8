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

/// One Kinect exposure: what all pixels share.
class KinectExposure {
 public:
  KinectExposure(const RayTracer& tracer, const Eigen::Isometry3d& map_from_sensor,
                 const PinholeCamera& camera, const KinectModel& model, std::uint64_t seed,
                 std::uint64_t stream)
      : tracer_(tracer),
        map_from_sensor_(map_from_sensor),
        camera_(camera),
        model_(model),
        seed_(seed),
        stream_(stream),
        projector_in_map_(map_from_sensor * Eigen::Vector3d(0.0, -model.baseline, 0.0)) {}

  /// Traces displaced rays of a row; writes true depth, and the side where the surface sends
  /// enough light back and the projector reaches it.
  void exposeRow(int row, DepthImage& image) const {
    const Eigen::Vector3d origin = map_from_sensor_.translation();
    std::vector<SeededRandom> random;
    std::vector<Eigen::Vector3d> directions;
    for (int column = 0; column < camera_.width; ++column) {
      random.emplace_back(seed_, stream_, image.index(column, row));
      const auto shift = random.back().normalPair();
      directions.emplace_back(map_from_sensor_.linear() *
                              camera_.direction(column + model_.lateral_noise * shift[0],
                                                row + model_.lateral_noise * shift[1]));
    }
    const std::vector<RayHit> hits = tracer_.trace(origin, directions);
    std::vector<Eigen::Vector3d> points;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      points.emplace_back(origin + hits[i].distance * directions[i]);
    }
    const std::vector<bool> shadow = tracer_.blocked(projector_in_map_, points);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      if (!hits[i].valid()) continue;
      const std::size_t pixel = image.index(static_cast<int>(i), row);
      image.true_depth[pixel] = hits[i].distance;  // along the axis the direction measures 1
      const bool lost = random[i].uniform() < grazingLoss(hits[i].side, directions[i]);
      if (!lost && !shadow[i]) image.sides[pixel] = hits[i].side;
    }
  }

  /// Counts of a pixel that exposeRow() gave a side; 0 if it fails at an edge or out of range.
  std::uint16_t measure(int column, int row, const DepthImage& image) const {
    const std::size_t pixel = image.index(column, row);
    SeededRandom random(seed_, stream_, image.counts.size() + pixel);  // not the exposure's
    if (atEdge(column, row, image) && random.uniform() < model_.edge_dropout) return 0;
    return countsOf(measured(image.true_depth[pixel], random), model_.range_unit);
  }

 private:
  double grazingLoss(int side, const Eigen::Vector3d& direction) const {
    const double cosine = std::abs(tracer_.sideNormal(side).dot(direction)) / direction.norm();
    if (cosine > std::cos(model_.grazing_start)) return 0.0;
    return (std::acos(cosine) - model_.grazing_start) / (model_.grazing_end - model_.grazing_start);
  }

  double measured(double depth, SeededRandom& random) const {
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

  const RayTracer& tracer_;
  const Eigen::Isometry3d& map_from_sensor_;
  const PinholeCamera& camera_;
  const KinectModel& model_;
  std::uint64_t seed_;
  std::uint64_t stream_;
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
    std::vector<Eigen::Vector3d> directions;
    for (int column = 0; column < camera.width; ++column) {
      directions.emplace_back(map_from_sensor.linear() * camera.direction(column, row));
    }
    const std::vector<RayHit> hits = tracer.trace(map_from_sensor.translation(), directions);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      if (!hits[i].valid()) continue;
      const std::size_t pixel = image.index(static_cast<int>(i), row);
      image.true_depth[pixel] = hits[i].distance;
      image.counts[pixel] = countsOf(hits[i].distance, range_unit);
      if (image.counts[pixel] != 0) image.sides[pixel] = hits[i].side;
    }
  }
  return image;
}

DepthImage renderKinect(const RayTracer& tracer, const Eigen::Isometry3d& map_from_sensor,
                        const PinholeCamera& camera, const KinectModel& model, std::uint64_t seed,
                        std::uint64_t stream) {
  validate(model);
  DepthImage image = blankImage(camera, model.range_unit, model.max_range);
  const KinectExposure exposure(tracer, map_from_sensor, camera, model, seed, stream);
  for (int row = 0; row < camera.height; ++row) exposure.exposeRow(row, image);
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      const std::size_t pixel = image.index(column, row);
      if (image.sides[pixel] < 0) continue;
      image.counts[pixel] = exposure.measure(column, row, image);
      if (image.counts[pixel] == 0) image.sides[pixel] = -1;
    }
  }
  return image;
}

}  // namespace opp::mapping
