// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/map_part.h"

#include "registration/observability.h"

#include <algorithm>

namespace opp::mapping {
namespace {

const LocalizedScan* scanOf(const MapState& map, int session, std::size_t scan_index) {
  const auto found = std::find_if(map.scans.begin(), map.scans.end(), [&](const LocalizedScan& s) {
    return s.session == session && s.scan_index == scan_index;
  });
  return found == map.scans.end() ? nullptr : &*found;
}

/// Whether motion between the end of one part and the beginning of the other allows the pose.
bool expectedBy(const ExpectedBeginning& beginning, const MapState& a, const MapState& b,
                const Eigen::Isometry3d& a_from_b) {
  const LocalizedScan* last = scanOf(a, beginning.session, beginning.last_scan);
  const LocalizedScan* first = scanOf(b, beginning.session, beginning.first_scan);
  if (last == nullptr || first == nullptr) return true;
  const Eigen::Isometry3d last_from_first =
      poseOf(a, *last).inverse() * a_from_b * poseOf(b, *first);
  const Vector6d error = difference(beginning.last_from_first, last_from_first);
  if (error.dot(beginning.information * error) > kPossible) return false;
  // Rooms repeat: what resembles a place is rather the next of its kind if motion speaks for that.
  const Matrix6d covariance = beginning.information.inverse();
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

/// Whether the body can have moved so far in the time between the parts.
bool reachable(const MapState& a, const MapState& b, const Eigen::Isometry3d& a_from_b,
               const MapperParams& params) {
  constexpr double kSigmas = 3.0;
  for (const LocalizedScan& first : b.scans) {
    const LocalizedScan* last = nullptr;
    for (const LocalizedScan& scan : a.scans) {
      if (scan.session == first.session && scan.timestamp <= first.timestamp) last = &scan;
    }
    if (last == nullptr) continue;
    const double seconds = first.timestamp - last->timestamp;
    const Eigen::Vector3d was = poseOf(a, *last).translation();
    const Eigen::Vector3d is = a_from_b * poseOf(b, first).translation();
    return (is - was).norm() <=
           params.loop.search_distance + kSigmas * params.frontend.speed * seconds;
  }
  return true;
}

}  // namespace

void PartHistory::merge(const PartHistory& other) {
  origins.insert(other.origins.begin(), other.origins.end());
  beginnings.insert(beginnings.end(), other.beginnings.begin(), other.beginnings.end());
  repeated.insert(other.repeated.begin(), other.repeated.end());
}

void MapPart::indexFrom(std::size_t first_keyframe) {
  for (std::size_t k = first_keyframe; k < map.keyframes.size(); ++k)
    index.add(map.keyframes[k].features.primitives_in_body);
}

bool MapPart::seesRepeated(int keyframe, double reach) const {
  if (history.repeated.empty()) return false;
  const Eigen::Vector3d view = map.keyframes[static_cast<std::size_t>(keyframe)].viewCentre();
  return std::any_of(map.keyframes.begin(), map.keyframes.end(), [&](const Keyframe& other) {
    return history.repeated.count({other.features.session, other.features.scan_index}) > 0 &&
           (other.viewCentre() - view).norm() <= reach;
  });
}

void MapPart::markRepeated(int keyframe) {
  const ScanFeatures& features = map.keyframes[static_cast<std::size_t>(keyframe)].features;
  history.repeated.insert({features.session, features.scan_index});
}

bool motionAllows(const MapPart& a, const MapPart& b, const Eigen::Isometry3d& a_from_b,
                  const MapperParams& params) {
  return reachable(a.map, b.map, a_from_b, params) && expectedBegin(a.map, b, a_from_b) &&
         expectedBegin(b.map, a, a_from_b.inverse());
}

}  // namespace opp::mapping
