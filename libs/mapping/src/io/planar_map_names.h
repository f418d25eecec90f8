// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/planar_map.h"

#include <array>
#include <string_view>
#include <utility>

namespace opp::mapping {

/// The words of planar_map.json for the kinds of its elements.
inline constexpr std::array<std::pair<PlaneKind, std::string_view>, 6> kPlaneKinds{
    {{PlaneKind::kFloor, "floor"},
     {PlaneKind::kCeiling, "ceiling"},
     {PlaneKind::kWall, "wall"},
     {PlaneKind::kHorizontal, "horizontal"},
     {PlaneKind::kVertical, "vertical"},
     {PlaneKind::kOther, "other"}}};
inline constexpr std::array<std::pair<LineKind, std::string_view>, 3> kLineKinds{
    {{LineKind::kConvex, "convex"},
     {LineKind::kConcave, "concave"},
     {LineKind::kUnknown, "unknown"}}};
inline constexpr std::array<std::pair<CornerKind, std::string_view>, 4> kCornerKinds{
    {{CornerKind::kConvex, "convex"},
     {CornerKind::kConcave, "concave"},
     {CornerKind::kSaddle, "saddle"},
     {CornerKind::kUnknown, "unknown"}}};

/// The word for `kind` in one of the tables above.
template <typename Table, typename Kind>
std::string_view wordOf(const Table& table, Kind kind) {
  for (const auto& [value, word] : table) {
    if (value == kind) return word;
  }
  return "";
}

}  // namespace opp::mapping
