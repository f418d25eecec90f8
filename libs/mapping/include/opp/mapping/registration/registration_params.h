// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/constants.h"
#include "opp/params/field.h"

#include <string_view>

namespace opp::mapping {

/// Parameters of the registration of a scan against a local map (planes + points, DESIGN 3, rung
/// 3).
struct RegistrationParams {
  static constexpr std::string_view kSection = "registration";
  int max_points = 2500;
  double surfel_size_ratio = 2.5;
  double level_ratio = 4.0;
  int levels = 3;
  double normal_gate = degToRad(35.0);
  double normal_noise = degToRad(3.0);
  double landmark_normal_noise = degToRad(0.25);
  double rim_normal_noise = degToRad(5.0);
  /// A narrow surface that is not yet mapped is matched to another beside it, and its few samples
  /// may be all that shows a direction: 3.7° of roll before a shelf in one scan of 300.
  double narrow_caution = 5.0;
  double kernel_width = 2.5;
  int max_iterations = 30;
  double rotation_tolerance = 2e-5;
  double translation_tolerance = 2e-5;
  double plane_vote_share = 0.3;
  double plane_gate_sigmas = 3.0;

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.max_points, Field{"max_points", "", 50, 1e6,
                          "samples of a scan used as points, balanced over their normals"});
    f(p.surfel_size_ratio, Field{"surfel_size_ratio", "", 1.0, 20.0,
                                 "edge of a surfel's voxel over the sample spacing"});
    f(p.level_ratio,
      Field{"level_ratio", "", 1.5, 20.0, "edge of a voxel over that of the next finer level"});
    f(p.levels, Field{"levels", "", 1, 8,
                      "levels of voxels; the less is known of a pose, the coarser the first"});
    f(p.normal_gate, Field{"normal_gate", "rad", 0.01, 1.57,
                           "point and surfel match if their normals differ less"});
    f(p.normal_noise,
      Field{"normal_noise", "rad", 1e-4, 0.5,
            "normals of surfels scatter so much, until plane landmarks show how much"});
    f(p.landmark_normal_noise, Field{"landmark_normal_noise", "rad", 1e-6, 0.5,
                                     "normals of plane landmarks are off so much"});
    f(p.rim_normal_noise,
      Field{"rim_normal_noise", "rad", 1e-4, 0.5, "normals of rims scatter so much"});
    f(p.narrow_caution,
      Field{"narrow_caution", "", 1.0, 1e3,
            "samples of planes found pixel by pixel count as if their noise were larger by this"});
    f(p.kernel_width, Field{"kernel_width", "", 0.1, 100.0,
                            "Cauchy kernel: residual in sigmas at which influence peaks"});
    f(p.max_iterations,
      Field{"max_iterations", "", 1, 1000, "Gauss-Newton steps per stage at most"});
    f(p.rotation_tolerance,
      Field{"rotation_tolerance", "rad", 1e-12, 0.1, "converged when a step rotates less"});
    f(p.translation_tolerance,
      Field{"translation_tolerance", "m", 1e-12, 0.1, "converged when a step moves less"});
    f(p.plane_vote_share,
      Field{"plane_vote_share", "", 0.0, 1.0,
            "a scan's plane is a landmark if this share of its matched samples lie on it"});
    f(p.plane_gate_sigmas,
      Field{"plane_gate_sigmas", "", 0.5, 100.0,
            "and if their distance (rms) is below so many sigmas of a sample, of its noise and "
            "of the distortion that the map shows"});
  }
};

}  // namespace opp::mapping
