// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/constants.h"
#include "opp/params/field.h"

#include <string_view>

namespace opp::mapping {

/// Parameters of the polygons on planes.
struct PlanarParams {
  static constexpr std::string_view kSection = "planar";
  double cell = 0.025;
  double bridge = 0.15;
  double min_area = 0.02;
  double outline_tolerance = 0.04;
  double snap = 0.1;
  double open_fraction = 0.25;
  double tilt_tolerance = degToRad(10.0);
  double max_camera_tilt = degToRad(45.0);
  double wall_height = 1.0;
  double max_position_error = 0.02;
  double min_seen_share = 0.15;
  int min_rays = 8;
  double single_scan_area = 0.5;

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.cell, Field{"cell", "m", 0.001, 1.0, "edge of a cell of the raster on a plane"});
    f(p.bridge, Field{"bridge", "m", 0.0, 10.0, "narrower gaps in the support are closed"});
    f(p.min_area, Field{"min_area", "m2", 0.0, 100.0, "smaller polygons and holes are dropped"});
    f(p.outline_tolerance,
      Field{"outline_tolerance", "m", 0.0, 1.0, "outlines are simplified by at most this"});
    f(p.snap, Field{"snap", "m", 0.0, 1.0,
                    "outlines this near to a line or corner of their plane are moved onto it"});
    f(p.open_fraction, Field{"open_fraction", "", 0.0, 1.0,
                             "a hole stays open if rays passed through this part of it"});
    f(p.tilt_tolerance, Field{"tilt_tolerance", "rad", 0.0, 0.8,
                              "planes within this of level or plumb are horizontal or vertical"});
    f(p.max_camera_tilt,
      Field{"max_camera_tilt", "rad", 0.0, 1.5,
            "the vertical is looked for within this of the first body frame's z axis"});
    f(p.wall_height,
      Field{"wall_height", "m", 0.0, 100.0, "vertical planes of at least this height are walls"});
    f(p.max_position_error,
      Field{"max_position_error", "m", 1e-6, 100.0,
            "planes of a map whose place is known worse (standard deviation) are left out"});
    f(p.min_seen_share, Field{"min_seen_share", "", 0.0, 1.0,
                              "and those that a smaller share of the scans that looked there saw"});
    f(p.min_rays, Field{"min_rays", "", 1, 1e9,
                        "a scan looked there if so many of its keyframe's rays meet the plane"});
    f(p.single_scan_area,
      Field{"single_scan_area", "m2", 0.0, 1e6,
            "planes of a map that only one of its scans saw are left out if smaller"});
  }
};

}  // namespace opp::mapping
