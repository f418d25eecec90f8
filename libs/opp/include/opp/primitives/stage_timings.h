// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace opp {

/// Wall time of each stage from raw points to primitives [s]: the first two are of
/// `makeOrientedCloud`, the others of `detectPrimitives`.
struct StageTimings {
  double normals = 0.0;
  double sampling = 0.0;
  double voting = 0.0;
  double clustering = 0.0;
  double narrow = 0.0;  ///< narrow planes
  double refinement = 0.0;
  double corners = 0.0;
  double lines = 0.0;
};

}  // namespace opp
