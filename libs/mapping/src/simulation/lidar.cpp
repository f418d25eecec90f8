// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/lidar.h"

#include "opp/geometry/constants.h"
#include "opp/mapping/simulation/seeded_random.h"

#include <algorithm>
#include <cmath>

namespace opp::mapping {
namespace {

Eigen::Vector3d shotDirection(const LidarModel& model, int column, int ring) {
  const double azimuth = 2.0 * kPi * column / model.columns;
  const double share = model.rings > 1 ? static_cast<double>(ring) / (model.rings - 1) : 0.5;
  const double elevation = model.lowest + share * (model.highest - model.lowest);
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

double grazingLoss(const LidarModel& model, const Eigen::Vector3d& normal,
                   const Eigen::Vector3d& unit_direction) {
  const double angle = std::acos(std::min(1.0, std::abs(normal.dot(unit_direction))));
  return (angle - model.grazing_start) / (model.grazing_end - model.grazing_start);
}

}  // namespace

LidarModel LidarModel::os1_64() {
  LidarModel model;
  model.rings = 64;
  model.columns = 1024;
  model.lowest = degToRad(-22.5);
  model.highest = degToRad(22.5);
  model.noise = 0.01;
  return model;
}

LidarScan sweep(const RayTracer& tracer, const Eigen::Isometry3d& map_from_sensor,
                const LidarModel& model, std::uint64_t seed, std::uint64_t stream) {
  validate(model);
  LidarScan scan;
  for (int ring = 0; ring < model.rings; ++ring) {
    std::vector<Eigen::Vector3d> in_sensor, in_map;
    for (int column = 0; column < model.columns; ++column) {
      in_sensor.push_back(shotDirection(model, column, ring));
      in_map.emplace_back(map_from_sensor.linear() * in_sensor.back());
    }
    const std::vector<RayHit> hits = tracer.trace(map_from_sensor.translation(), in_map);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const auto shot = static_cast<std::uint64_t>(ring) * hits.size() + i;
      SeededRandom random(seed, stream, shot);
      if (!hits[i].valid() || random.uniform() < model.dropout) continue;
      if (random.uniform() < grazingLoss(model, tracer.sideNormal(hits[i].side), in_map[i]))
        continue;
      const double range = hits[i].distance + model.noise * random.normal();
      if (range < model.min_range || range > model.max_range) continue;
      scan.points.emplace_back((range * in_sensor[i]).cast<float>());
      scan.sides.push_back(hits[i].side);
    }
  }
  return scan;
}

}  // namespace opp::mapping
