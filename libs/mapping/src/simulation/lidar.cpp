// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/lidar.h"

#include "opp/geometry/constants.h"
#include "opp/mapping/simulation/seeded_random.h"

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
  for (int column = 0; column < model.columns; ++column) {
    for (int ring = 0; ring < model.rings; ++ring) {
      SeededRandom random(seed, stream, static_cast<std::uint64_t>(column * model.rings + ring));
      const Eigen::Vector3d in_sensor = shotDirection(model, column, ring);
      const Eigen::Vector3d in_map = map_from_sensor.linear() * in_sensor;
      const RayHit hit = tracer.trace(map_from_sensor.translation(), in_map);
      if (!hit.valid() || random.uniform() < model.dropout) continue;
      const double angle =
          std::acos(std::min(1.0, std::abs(tracer.sideNormal(hit.side).dot(in_map))));
      const double loss = (angle - model.grazing_start) / (model.grazing_end - model.grazing_start);
      if (random.uniform() < loss) continue;
      const double range = hit.distance + model.noise * random.normal();
      if (range < model.min_range || range > model.max_range) continue;
      scan.points.emplace_back((range * in_sensor).cast<float>());
      scan.sides.push_back(hit.side);
    }
  }
  return scan;
}

}  // namespace opp::mapping
