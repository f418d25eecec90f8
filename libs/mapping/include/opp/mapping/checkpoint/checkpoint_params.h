// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/params/field.h"

#include <string_view>

namespace opp::mapping {

/// How often a run stores what it has come to, see `Checkpointer`.
struct CheckpointParams {
  static constexpr std::string_view kSection = "checkpoint";
  double interval = 30.0;
  double max_share = 0.02;

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.interval, Field{"interval", "s", 0.0, 1e9,
                        "least time between two checkpoints, from which --resume goes on"});
    f(p.max_share, Field{"max_share", "", 1e-4, 1.0,
                         "and so long that writing them takes at most this part of it"});
  }
};

}  // namespace opp::mapping
