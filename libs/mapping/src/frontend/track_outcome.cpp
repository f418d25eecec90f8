// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/tracker.h"

namespace opp::mapping {

std::string_view describe(TrackOutcome outcome) {
  switch (outcome) {
    case TrackOutcome::kLocalized:
      return "localized";
    case TrackOutcome::kEmptyScan:
      return "the scan is empty";
    case TrackOutcome::kNoMap:
      return "there is no map yet";
    case TrackOutcome::kLittleOverlap:
      return "too little of the scan agrees with the map";
    case TrackOutcome::kContradicted:
      return "scan and map each show something where the other looked through";
    case TrackOutcome::kImplausible:
      return "the body cannot have moved so far since the last scan";
    case TrackOutcome::kUnobserved:
      return "the scan leaves a direction open that was not seen for too long";
    case TrackOutcome::kForgotten:
      return "nothing was recognized for so long that the body may have turned around";
  }
  return "";
}

}  // namespace opp::mapping
