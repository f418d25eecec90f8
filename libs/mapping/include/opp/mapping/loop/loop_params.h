// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/constants.h"
#include "opp/params/field.h"

#include <string_view>

namespace opp::mapping {

/// Recognition of places: loop closures within a map, and joins of maps that were built apart.
struct LoopParams {
  static constexpr std::string_view kSection = "loop";
  bool close_loops = true;
  bool join_maps = true;
  int lost_scans = 5;
  int min_scans = 10;
  double min_normal_spread = 0.01;
  double step_sigma = 0.003;
  double drift_ratio = 0.01;
  double level_sigma = degToRad(1.0);
  /// Half of `agree_translation`: a map is one if its parts are where it has them with 95 %.
  double loosest_tie = 0.05;
  double connected_ratio = 0.3;
  double search_distance = 2.0;
  double drift_gate = 4.0;
  int max_candidates = 10;
  int place_keyframes = 6;
  double min_overlap = 0.5;
  int confirmations = 2;
  int join_confirmations = 3;
  int revisit_confirmations = 5;
  double certain_clarity = 0.75;
  int memory = 15;
  double rival_ratio = 2.0;
  double agree_translation = 0.1;
  double agree_rotation = degToRad(2.0);
  double word_width = 0.05;

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.close_loops, Field{"close_loops", "", 0, 1, "recognize places of the same map"});
    f(p.join_maps, Field{"join_maps", "", 0, 1, "recognize places of maps that were built apart"});
    f(p.lost_scans, Field{"lost_scans", "", 1, 1e6,
                          "after so many lost scans in a row a new map is begun, at once if motion "
                          "can no longer tell where the body is"});
    f(p.min_scans,
      Field{"min_scans", "", 1, 1e6, "maps of fewer scans that join no other are given up"});
    f(p.min_normal_spread, Field{"min_normal_spread", "", 0.0, 0.33,
                                 "a map begins with a scan whose normals spread so much in every "
                                 "direction (least mean square of a component)"});
    f(p.step_sigma, Field{"step_sigma", "m", 1e-6, 1.0,
                          "drift between keyframes that see each other's places, at least"});
    f(p.drift_ratio, Field{"drift_ratio", "", 0.0, 1.0, "and this share of their distance"});
    f(p.level_sigma, Field{"level_sigma", "rad", 1e-4, 10.0,
                           "floors, tables and ceilings are level this well (standard deviation): "
                           "what ties maps on both sides of a bare wall"});
    f(p.loosest_tie,
      Field{"loosest_tie", "m", 1e-4, 100.0,
            "what is tied worse (standard deviation of what is seen) becomes a map of its own"});
    f(p.connected_ratio,
      Field{"connected_ratio", "", 0.01, 10.0,
            "a keyframe is matched without further proof while its drift is below this share of "
            "the finest surfels"});
    f(p.search_distance, Field{"search_distance", "m", 0.0, 1e3,
                               "loops are looked for among keyframes whose views are this near"});
    f(p.drift_gate, Field{"drift_gate", "", 0.0, 100.0,
                          "and so many standard deviations of the drift; no farther is believed"});
    f(p.max_candidates, Field{"max_candidates", "", 1, 1000, "places tried for a keyframe"});
    f(p.place_keyframes,
      Field{"place_keyframes", "", 1, 1000, "keyframes that make up a place to be recognized"});
    f(p.min_overlap, Field{"min_overlap", "", 0.0, 1.0,
                           "share of a scan that agrees with the place it is said to see"});
    f(p.confirmations, Field{"confirmations", "", 1, 100,
                             "different keyframes that must agree before a place is believed"});
    f(p.join_confirmations,
      Field{
          "join_confirmations", "", 1, 100,
          "the same before maps of two sessions are joined, as no drift limits where they may be, "
          "or a map of one keyframe with another"});
    f(p.revisit_confirmations,
      Field{
          "revisit_confirmations", "", 1, 100,
          "the same before maps of one session are joined where motion does not say the same: the "
          "body may as well have come to another place of this kind as back"});
    f(p.certain_clarity,
      Field{"certain_clarity", "", 0.0, 1.0,
            "one keyframe is enough if no other pose comes this near (GlobalAlignment::clarity)"});
    f(p.memory, Field{"memory", "", 1, 1e6,
                      "keyframes after which an unconfirmed loop is forgotten (drift goes on)"});
    f(p.rival_ratio,
      Field{"rival_ratio", "", 1.0, 100.0, "so many times more keyframes than for any other pose"});
    f(p.agree_translation,
      Field{"agree_translation", "m", 1e-4, 10.0, "claims that differ less at their place agree"});
    f(p.agree_rotation, Field{"agree_rotation", "rad", 1e-4, 1.0, "and turn by less"});
    f(p.word_width, Field{"word_width", "m", 0.005, 10.0,
                          "distances of planes and corners are compared in steps of this"});
  }
};

}  // namespace opp::mapping
