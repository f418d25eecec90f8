// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/motion_between.h"

#include "registration/observability.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <set>

namespace opp::mapping {
namespace {

using Index = std::size_t;

/// So many standard deviations bound what is possible.
constexpr double kSigmas = 3.0;

std::optional<Eigen::Isometry3d> poseAt(const MapState& map, const ScanId& id) {
  const auto found = std::find_if(map.scans.begin(), map.scans.end(),
                                  [&](const LocalizedScan& s) { return s.id() == id; });
  if (found == map.scans.end()) return std::nullopt;
  return poseOf(map, *found);
}

/// What is expected of `second.first` relative to `first.last` if the body went from `first.first`
/// to `second.last` as `map` has it; nothing if it is not in the map. What drifts within a part is
/// little beside what motion leaves open.
std::optional<ExpectedBeginning> chained(const ExpectedBeginning& first,
                                         const ExpectedBeginning& second, const MapState& map) {
  const auto map_from_first = poseAt(map, first.first), map_from_last = poseAt(map, second.last);
  if (!map_from_first || !map_from_last) return std::nullopt;
  const Eigen::Isometry3d last_from_last =
      first.last_from_first * map_from_first->inverse() * *map_from_last;
  ExpectedBeginning both;
  both.last = first.last;
  both.first = second.first;
  both.last_from_first = last_from_last * second.last_from_first;
  const Matrix6d moved =
      movedBy(both.last_from_first.translation() - first.last_from_first.translation());
  const Matrix6d turn = turned(last_from_last.linear());
  const Matrix6d covariance = moved * covarianceOf(first.information) * moved.transpose() +
                              turn * covarianceOf(second.information) * turn.transpose();
  both.information = inverse(covariance);
  return both;
}

/// What is expected of how `later` begins relative to `earlier`, by way of as few others as can be.
std::vector<ExpectedBeginning> expectedBeginnings(const std::vector<MapPart>& parts, Index earlier,
                                                  Index later) {
  std::vector<ExpectedBeginning> result;
  const auto& direct = parts[later].history.beginnings;
  std::deque<ExpectedBeginning> open(direct.begin(), direct.end());
  std::set<Index> passed = {later};
  for (; !open.empty(); open.pop_front()) {
    const ExpectedBeginning& end = open.front();
    const auto part = std::find_if(parts.begin(), parts.end(), [&](const MapPart& p) {
      return poseAt(p.map, end.last).has_value();
    });
    if (part == parts.end()) continue;
    const auto p = static_cast<Index>(part - parts.begin());
    if (p == earlier) {
      result.push_back(end);
    } else if (passed.insert(p).second) {
      for (const ExpectedBeginning& before : part->history.beginnings) {
        if (const auto both = chained(before, end, part->map)) open.push_back(*both);
      }
    }
  }
  return result;
}

/// Whether a claimed pose is where it was expected. \param tolerance variances of (ω, v) within
/// which claims are one: neither they nor the parts are as exact as what ties two scans.
bool isExpected(const ExpectedBeginning& beginning, const Eigen::Isometry3d& last_from_first,
                const Vector6d& tolerance) {
  const Vector6d error = difference(beginning.last_from_first, last_from_first);
  Matrix6d covariance = covarianceOf(beginning.information);
  covariance.diagonal() += tolerance;
  if (error.dot(covariance.ldlt().solve(error)) > kPossible) return false;
  // Rooms repeat: what resembles a place is rather the next of its kind if motion speaks for that.
  const Eigen::Vector3d shift = error.tail<3>();
  return shift.dot(covariance.bottomRightCorner<3, 3>().ldlt().solve(shift)) <= kClearly;
}

}  // namespace

MotionBetween::MotionBetween(const std::vector<MapPart>& parts, Index a, Index b,
                             const MapperParams& params)
    : search_distance_(params.loop.search_distance) {
  tolerance_ << Eigen::Vector3d::Constant(params.loop.agree_rotation * params.loop.agree_rotation),
      Eigen::Vector3d::Constant(params.loop.agree_translation * params.loop.agree_translation);
  addPassages(parts[a].map, parts[b].map, params);
  addExpectations(parts, a, b, true);
  addExpectations(parts, b, a, false);
}

void MotionBetween::addPassages(const MapState& a, const MapState& b, const MapperParams& params) {
  struct Stop {
    ScanId scan;
    double timestamp;
    bool in_b;
    Eigen::Vector3d position;
  };
  std::vector<Stop> stops;
  for (const LocalizedScan& s : a.scans)
    stops.push_back({s.id(), s.timestamp, false, poseOf(a, s).translation()});
  for (const LocalizedScan& s : b.scans)
    stops.push_back({s.id(), s.timestamp, true, poseOf(b, s).translation()});
  std::sort(stops.begin(), stops.end(),
            [](const Stop& x, const Stop& y) { return x.scan < y.scan; });
  for (Index k = 1; k < stops.size(); ++k) {
    const Stop &from = stops[k - 1], &to = stops[k];
    if (from.in_b == to.in_b || from.scan.first != to.scan.first) continue;
    const double reach = params.loop.search_distance +
                         kSigmas * params.frontend.speed * std::abs(to.timestamp - from.timestamp);
    passages_.push_back(
        {(from.in_b ? to : from).position, (from.in_b ? from : to).position, reach});
  }
}

void MotionBetween::addExpectations(const std::vector<MapPart>& parts, Index earlier, Index later,
                                    bool begins_b) {
  for (const ExpectedBeginning& beginning : expectedBeginnings(parts, earlier, later)) {
    const auto last = poseAt(parts[earlier].map, beginning.last);
    const auto first = poseAt(parts[later].map, beginning.first);
    if (last && first) expectations_.push_back({beginning, begins_b, *last, *first});
  }
}

bool MotionBetween::isMet(const Expectation& e, const Eigen::Isometry3d& a_from_b) const {
  const Eigen::Isometry3d earlier_from_later = e.begins_b ? a_from_b : a_from_b.inverse();
  return isExpected(e.beginning,
                    e.earlier_from_last.inverse() * earlier_from_later * e.later_from_first,
                    tolerance_);
}

bool MotionBetween::allows(const Eigen::Isometry3d& a_from_b) const {
  return std::all_of(passages_.begin(), passages_.end(),
                     [&](const Passage& p) {
                       return (p.position_in_a - a_from_b * p.position_in_b).norm() <= p.reach;
                     }) &&
         std::all_of(expectations_.begin(), expectations_.end(),
                     [&](const Expectation& e) { return isMet(e, a_from_b); });
}

bool MotionBetween::expects(const Eigen::Isometry3d& a_from_b) const {
  return std::any_of(expectations_.begin(), expectations_.end(), [&](const Expectation& e) {
    const Matrix6d covariance = covarianceOf(e.beginning.information);
    const double sigma = std::sqrt(largestVariance(covariance.bottomRightCorner<3, 3>()));
    return kSigmas * sigma <= search_distance_ && isMet(e, a_from_b);
  });
}

}  // namespace opp::mapping
