// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/map_part.h"

#include "registration/observability.h"

#include <algorithm>

namespace opp::mapping {
namespace {

const LocalizedScan* scanOf(const MapState& map, const ScanId& id) {
  const auto found = std::find_if(map.scans.begin(), map.scans.end(),
                                  [&](const LocalizedScan& s) { return s.id() == id; });
  return found == map.scans.end() ? nullptr : &*found;
}

/// Whether motion between the end of one part and the beginning of the other allows the pose.
bool expectedBy(const ExpectedBeginning& beginning, const MapState& a, const MapState& b,
                const Eigen::Isometry3d& a_from_b) {
  const LocalizedScan* last = scanOf(a, beginning.last);
  const LocalizedScan* first = scanOf(b, beginning.first);
  if (last == nullptr || first == nullptr) return true;
  const Eigen::Isometry3d last_from_first =
      poseOf(a, *last).inverse() * a_from_b * poseOf(b, *first);
  const Vector6d error = difference(beginning.last_from_first, last_from_first);
  if (error.dot(beginning.information * error) > kPossible) return false;
  // Rooms repeat: what resembles a place is rather the next of its kind if motion speaks for that.
  const Matrix6d covariance = covarianceOf(beginning.information);
  const Eigen::Vector3d shift = error.tail<3>();
  return shift.dot(covariance.bottomRightCorner<3, 3>().ldlt().solve(shift)) <= kClearly;
}

/// The same for all beginnings of `later`.
bool expectedBegin(const MapState& earlier, const MapPart& later,
                   const Eigen::Isometry3d& earlier_from_later) {
  return std::all_of(later.history.beginnings.begin(), later.history.beginnings.end(),
                     [&](const auto& beginning) {
                       return expectedBy(beginning, earlier, later.map, earlier_from_later);
                     });
}

struct Stop {
  ScanId scan;
  double timestamp;
  bool in_b;
  Eigen::Vector3d position;  ///< in the frame of a
};

/// Whether the body can have moved so far in the time whenever it went from one part to the other.
bool reachable(const MapState& a, const MapState& b, const Eigen::Isometry3d& a_from_b,
               const MapperParams& params) {
  std::vector<Stop> stops;
  for (const LocalizedScan& s : a.scans)
    stops.push_back({s.id(), s.timestamp, false, poseOf(a, s).translation()});
  for (const LocalizedScan& s : b.scans)
    stops.push_back({s.id(), s.timestamp, true, a_from_b * poseOf(b, s).translation()});
  std::sort(stops.begin(), stops.end(),
            [](const Stop& x, const Stop& y) { return x.scan < y.scan; });
  constexpr double kSigmas = 3.0;
  return std::adjacent_find(stops.begin(), stops.end(), [&](const Stop& from, const Stop& to) {
           const double reach =
               params.loop.search_distance +
               kSigmas * params.frontend.speed * std::abs(to.timestamp - from.timestamp);
           return from.in_b != to.in_b && from.scan.first == to.scan.first &&
                  (to.position - from.position).norm() > reach;
         }) == stops.end();
}

}  // namespace

bool PartHistory::sharesOrigin(const PartHistory& other) const {
  return std::any_of(origins.begin(), origins.end(),
                     [&](int id) { return other.origins.count(id) > 0; });
}

void PartHistory::merge(const PartHistory& other) {
  origins.insert(other.origins.begin(), other.origins.end());
  for (const ExpectedBeginning& beginning : other.beginnings) expect(beginning);
  repeated.insert(other.repeated.begin(), other.repeated.end());
}

void PartHistory::expect(const ExpectedBeginning& beginning) {
  const bool known =
      std::any_of(beginnings.begin(), beginnings.end(), [&](const ExpectedBeginning& other) {
        return other.last == beginning.last && other.first == beginning.first;
      });
  if (!known) beginnings.push_back(beginning);
}

void PartHistory::expectTied(const MapState& map, const std::vector<int>& sets) {
  for (const RelativePoseFactor& f : map.factors.relative_poses) {
    const auto first = static_cast<std::size_t>(f.first),
               second = static_cast<std::size_t>(f.second);
    if (sets[first] == sets[second]) continue;
    const ScanFeatures& from = map.keyframes[first].features;
    const ScanFeatures& to = map.keyframes[second].features;
    expect({from.id(), to.id(), f.first_from_second, f.information});
  }
}

void MapPart::indexFrom(std::size_t first_keyframe) {
  for (std::size_t k = first_keyframe; k < map.keyframes.size(); ++k)
    index.add(map.keyframes[k].features.primitives_in_body);
}

bool MapPart::seesRepeated(int keyframe, double reach) const {
  if (history.repeated.empty()) return false;
  const Eigen::Vector3d view = map.keyframes[static_cast<std::size_t>(keyframe)].viewCentre();
  return std::any_of(map.keyframes.begin(), map.keyframes.end(), [&](const Keyframe& other) {
    return history.repeated.count(other.features.id()) > 0 &&
           (other.viewCentre() - view).norm() <= reach;
  });
}

void MapPart::markRepeated(int keyframe) {
  history.repeated.insert(map.keyframes[static_cast<std::size_t>(keyframe)].features.id());
}

bool motionAllows(const MapPart& a, const MapPart& b, const Eigen::Isometry3d& a_from_b,
                  const MapperParams& params) {
  return reachable(a.map, b.map, a_from_b, params) && expectedBegin(a.map, b, a_from_b) &&
         expectedBegin(b.map, a, a_from_b.inverse());
}

}  // namespace opp::mapping
