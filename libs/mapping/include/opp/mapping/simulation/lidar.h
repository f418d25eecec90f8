// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/simulation/ray_tracer.h"
#include "opp/params/field.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <string_view>
#include <vector>

namespace opp::mapping {

/// Spinning lidar. Defaults: Velodyne VLP-16 at 10 Hz (16 rings within ±15°, 0.2° in azimuth,
/// 100 m; its manual states ±3 cm typical accuracy, taken as two standard deviations).
/// A sweep is taken at one moment: what a driver delivers that compensates motion.
struct LidarModel {
  static constexpr std::string_view kSection = "lidar";
  int rings = 16;
  int columns = 1800;
  double lowest = -0.2618;  // −15°
  double highest = 0.2618;  // 15°
  double noise = 0.015;
  double min_range = 0.5;
  double max_range = 100.0;
  double grazing_start = 1.3963;  // 80°
  double grazing_end = 1.5533;    // 89°
  double dropout = 0.002;

  static LidarModel vlp16() { return {}; }
  /// Ouster OS1-64: 64 rings within ±22.5°, 1024 columns, precision about 1 cm (data sheet).
  static LidarModel os1_64();

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.rings, Field{"rings", "", 1.0, 1024.0, "number of lasers"});
    f(p.columns, Field{"columns", "", 4.0, 1e5, "shots of each laser a turn"});
    f(p.lowest, Field{"lowest", "rad", -1.5708, 1.5708, "elevation of the lowest ring"});
    f(p.highest, Field{"highest", "rad", -1.5708, 1.5708, "elevation of the highest ring"});
    f(p.noise, Field{"noise", "m", 0.0, 1.0, "of the range (1 sigma)"});
    f(p.min_range, Field{"min_range", "m", 0.0, 1000.0, "nearer returns are lost"});
    f(p.max_range, Field{"max_range", "m", 0.0, 1000.0, "farther returns are lost"});
    f(p.grazing_start, Field{"grazing_start", "rad", 0.0, 1.5708, "incidence where loss begins"});
    f(p.grazing_end, Field{"grazing_end", "rad", 0.0, 1.5708, "incidence where all is lost"});
    f(p.dropout, Field{"dropout", "", 0.0, 1.0, "share of returns lost for no reason"});
  }
};

/// Returns of one turn, ring by ring from below, lost ones left out.
struct LidarScan {
  std::vector<Eigen::Vector3f> points;  ///< in the sensor frame [m]
  std::vector<int> sides;               ///< of the world
};

/// One turn. Each shot draws from (seed, stream, shot).
/// \throws std::invalid_argument if a parameter is out of range.
LidarScan sweep(const RayTracer& tracer, const Eigen::Isometry3d& map_from_sensor,
                const LidarModel& model, std::uint64_t seed, std::uint64_t stream);

}  // namespace opp::mapping
