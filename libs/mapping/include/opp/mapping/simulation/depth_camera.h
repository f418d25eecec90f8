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

/// Pinhole camera without distortion. A pixel (column, row) looks along
/// (1, −(column − cx)/fx, −(row − cy)/fy) in the sensor frame (x forward, y left, z up).
struct PinholeCamera {
  int width = 640;
  int height = 480;
  double fx = 575.0;  ///< [px], as cy: nominal values of the Kinect's depth camera
  double fy = 575.0;
  double cx = 319.5;
  double cy = 239.5;

  /// The camera of images with every `factor`-th column and row (pixel areas averaged).
  PinholeCamera decimated(int factor) const;
  Eigen::Vector3d direction(double column, double row) const {
    return {1.0, -(column - cx) / fx, -(row - cy) / fy};
  }
};

/// Structured-light depth camera (Kinect v1).
/// - Disparity: 1/z is measured in steps of `disparity_step` and with Gaussian noise before
///   rounding. Khoshelham & Oude Elberink (Sensors 2012, 12, 1437) calibrate the step as
///   2.85e-3 /m and the whole error as half a step, σ_z = 1.43e-3 z²; 0.41 steps of noise and
///   1/√12 of rounding make that half step. (Handa et al., ICRA 2014, use the same step.)
/// - Lateral noise: the pixel's ray is displaced by σ = 0.5 px (Handa et al.), which makes edges
///   ragged and error grow with the surface's slope.
/// - Shadow: no depth where the projector, `baseline` to the right of the camera, does not reach.
/// - Edges: correlation windows that straddle a jump fail with probability `edge_dropout`.
/// - Grazing angles: drop-outs grow linearly from `grazing_start` to certainty at `grazing_end`
///   (Nguyen et al., 3DIMPVT 2012, find no usable data beyond about 80°).
struct KinectModel {
  static constexpr std::string_view kSection = "kinect";
  double disparity_step = 2.85e-3;
  double disparity_noise = 0.41;
  double lateral_noise = 0.5;
  double baseline = 0.075;
  double edge_jump = 0.03;
  int edge_radius = 1;
  double edge_dropout = 0.5;
  double grazing_start = 1.2217;  // 70°
  double grazing_end = 1.4835;    // 85°
  double min_range = 0.5;
  double max_range = 6.0;
  double range_unit = 0.001;

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.disparity_step, Field{"disparity_step", "1/m", 1e-9, 0.1, "resolution of 1/depth"});
    f(p.disparity_noise, Field{"disparity_noise", "", 0.0, 100.0, "in disparity steps (1 sigma)"});
    f(p.lateral_noise, Field{"lateral_noise", "px", 0.0, 10.0, "of a pixel's ray (1 sigma)"});
    f(p.baseline, Field{"baseline", "m", 0.0, 1.0, "projector to camera; casts the shadow"});
    f(p.edge_jump, Field{"edge_jump", "", 0.0, 1.0, "relative depth step that counts as an edge"});
    f(p.edge_radius, Field{"edge_radius", "px", 0.0, 10.0, "pixels this near an edge may fail"});
    f(p.edge_dropout, Field{"edge_dropout", "", 0.0, 1.0, "probability to fail there"});
    f(p.grazing_start, Field{"grazing_start", "rad", 0.0, 1.5708, "incidence where loss begins"});
    f(p.grazing_end, Field{"grazing_end", "rad", 0.0, 1.5708, "incidence where all is lost"});
    f(p.min_range, Field{"min_range", "m", 0.0, 100.0, "nearer depth is lost"});
    f(p.max_range, Field{"max_range", "m", 0.0, 65.0, "farther depth is lost"});
    f(p.range_unit, Field{"range_unit", "m", 1e-5, 0.01, "of the stored 16-bit depth"});
  }
};

/// Depth along the optical axis and what each pixel saw, row by row.
struct DepthImage {
  PinholeCamera camera;
  double range_unit = 0.001;          ///< [m] of a stored count
  double max_range = 6.0;             ///< [m]
  std::vector<std::uint16_t> counts;  ///< depth / range_unit; 0: no measurement
  std::vector<double> true_depth;     ///< of the ray that was traced [m]; 0: nothing
  std::vector<int> sides;             ///< of the world; −1: no measurement

  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(camera.width) +
           static_cast<std::size_t>(column);
  }
};

/// Depth as the geometry has it, in units of `range_unit` (rounded to the nearest: error at most
/// half a unit). The depth before rounding is in `true_depth`. Depth that does not fit 16 bits is
/// lost.
DepthImage renderIdeal(const RayTracer& tracer, const Eigen::Isometry3d& map_from_sensor,
                       const PinholeCamera& camera, double range_unit);

/// Depth as a Kinect sees it. Each pixel draws from (seed, stream, pixel).
/// \throws std::invalid_argument if a parameter is out of range.
DepthImage renderKinect(const RayTracer& tracer, const Eigen::Isometry3d& map_from_sensor,
                        const PinholeCamera& camera, const KinectModel& model, std::uint64_t seed,
                        std::uint64_t stream);

}  // namespace opp::mapping
