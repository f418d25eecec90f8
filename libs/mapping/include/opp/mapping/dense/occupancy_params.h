// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/params/field.h"

#include <string_view>

namespace opp::mapping {

/// Parameters of the OctoMap. The probabilities are those of Hornung et al., "OctoMap", Autonomous
/// Robots 2013, and octomap's own defaults.
struct OccupancyParams {
  static constexpr std::string_view kSection = "occupancy";
  double resolution = 0.05;
  double max_range = 1000.0;
  double hit_probability = 0.7;
  double miss_probability = 0.4;
  double min_probability = 0.1192;
  double max_probability = 0.971;

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.resolution, Field{"resolution", "m", 0.001, 10.0, "edge of the smallest voxel"});
    f(p.max_range,
      Field{"max_range", "m", 0.1, 1000.0, "longer rays only free space, up to this range"});
    f(p.hit_probability,
      Field{"hit_probability", "", 0.5, 0.999, "that a voxel is occupied, after one hit"});
    f(p.miss_probability,
      Field{"miss_probability", "", 0.001, 0.5, "that a voxel is occupied, after one miss"});
    f(p.min_probability, Field{"min_probability", "", 0.001, 0.5, "misses end here"});
    f(p.max_probability, Field{"max_probability", "", 0.5, 0.999, "hits end here"});
  }
};

}  // namespace opp::mapping
