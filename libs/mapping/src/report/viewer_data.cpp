// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/viewer_data.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace opp::mapping {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kShortestStep = 0.01;  ///< [m] of the way: shorter ones cannot be told apart

Json pointJson(const Eigen::Vector3d& point) {
  const auto rounded = [](double value) { return std::round(1000.0 * value) / 1000.0 + 0.0; };
  return {rounded(point.x()), rounded(point.y()), rounded(point.z())};
}

void addStretches(const SessionTrack& track, Json& way) {
  const Eigen::Vector3d* last = nullptr;  // that is in the list
  for (std::size_t i = 0; i < track.positions.size(); ++i) {
    const Eigen::Vector3d& position = track.positions[i];
    if (!position.allFinite()) {
      last = nullptr;
      continue;
    }
    const bool is_end = i + 1 == track.positions.size() || !track.positions[i + 1].allFinite();
    if (last != nullptr && !is_end && (position - *last).norm() < kShortestStep) continue;
    if (last == nullptr) way.push_back(Json::array());
    way.back().push_back(pointJson(position));
    last = &position;
  }
}

}  // namespace

std::string viewerData(const ReportFigures& figures) {
  Json json = {{"lines", Json::array()}, {"corners", Json::array()}, {"way", Json::array()}};
  const Eigen::Quaterniond turn(figures.level_from_map.linear());
  json["level_from_map"] = {turn.x(), turn.y(), turn.z(), turn.w()};
  for (const PlanarMapLine& line : figures.map.lines) {
    json["lines"].push_back(pointJson(line.start));
    json["lines"].push_back(pointJson(line.end));
  }
  for (const PlanarMapCorner& corner : figures.map.corners) {
    json["corners"].push_back(pointJson(corner.position));
  }
  for (const SessionTrack& track : figures.tracks) addStretches(track, json["way"]);
  return json.dump();
}

}  // namespace opp::mapping
