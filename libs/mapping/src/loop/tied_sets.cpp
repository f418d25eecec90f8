// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/tied_sets.h"

#include "opp/graph/union_find.h"
#include "opp/mapping/loop/keyframe_graph.h"

#include "registration/observability.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <map>
#include <utility>

namespace opp::mapping {
namespace {

using Index = std::size_t;

/// Sets of keyframes that do not move against each other, and what ties the sets.
class TiedSets {
 public:
  TiedSets(const MapState& map, double max_variance)
      : map_(map), max_variance_(max_variance), sets_(map.keyframes.size()) {
    for (const KeyframeLink& link : map.links) {
      if (link.variance <= max_variance) sets_.join(Index(link.first), Index(link.second));
    }
  }

  /// Joins sets whose ties, all taken together, fix them against a larger one.
  UnionFind joined() {
    std::vector<Index> open = roots();
    while (open.size() > 1) {
      const auto largest = std::max_element(
          open.begin(), open.end(), [&](Index a, Index b) { return sizeOf(a) < sizeOf(b); });
      std::rotate(open.begin(), largest, largest + 1);
      const Eigen::MatrixXd covariance = covarianceOfOthers(open);
      std::vector<Index> rest;
      for (Index k = 1; k < open.size(); ++k) {
        const auto at = static_cast<Eigen::Index>(6 * (k - 1));
        const Keyframe& keyframe = map_.keyframes[open[k]];
        const Matrix6d moved = movedBy(keyframe.map_from_body.translation());
        const Matrix6d here = moved * covariance.block<6, 6>(at, at) * moved.transpose();
        if (viewVariance(here, keyframe) <= max_variance_) {
          sets_.join(open[0], open[k]);
        } else {
          rest.push_back(open[k]);
        }
      }
      open = std::move(rest);
    }
    return sets_;
  }

 private:
  std::vector<Index> roots() {
    std::vector<Index> result;
    for (Index k = 0; k < map_.keyframes.size(); ++k) {
      if (sets_.root(k) == k) result.push_back(k);
    }
    return result;
  }

  std::ptrdiff_t sizeOf(Index root) {
    Index count = 0;
    for (Index k = 0; k < map_.keyframes.size(); ++k) count += sets_.root(k) == root ? 1 : 0;
    return static_cast<std::ptrdiff_t>(count);
  }

  /// Of (ω, v at the map's origin) of all sets but the first, which stays where it is.
  Eigen::MatrixXd covarianceOfOthers(const std::vector<Index>& roots) {
    // What no tie holds is known to 100 rad and 100 m, as in `covarianceOf`.
    constexpr double kLeast = 1e-4;
    const auto size = static_cast<Eigen::Index>(6 * (roots.size() - 1));
    Eigen::MatrixXd information = kLeast * Eigen::MatrixXd::Identity(size, size);
    const auto rowOf = [&](int keyframe) {
      const auto found = std::find(roots.begin(), roots.end(), sets_.root(Index(keyframe)));
      return 6 * static_cast<Eigen::Index>(found - roots.begin() - 1);
    };
    for (const RelativePoseFactor& f : map_.factors.relative_poses) {
      const Eigen::Index a = rowOf(f.first), b = rowOf(f.second);
      if (a == b || a >= size || b >= size) continue;
      const Matrix6d tie = informationOf(f);
      if (a >= 0) information.block<6, 6>(a, a) += tie;
      if (b >= 0) information.block<6, 6>(b, b) += tie;
      if (a < 0 || b < 0) continue;
      information.block<6, 6>(a, b) -= tie;
      information.block<6, 6>(b, a) -= tie;
    }
    return information.ldlt().solve(Eigen::MatrixXd::Identity(size, size));
  }

  /// Of the factor's (ω, v) in the map's axes, v at the map's origin.
  Matrix6d informationOf(const RelativePoseFactor& f) const {
    const Matrix6d first_from_map =
        turned(map_.keyframes[Index(f.first)].map_from_body.linear().transpose());
    const Matrix6d at_second =
        first_from_map * movedBy(map_.keyframes[Index(f.second)].map_from_body.translation());
    return at_second.transpose() * f.information * at_second;
  }

  const MapState& map_;
  double max_variance_;
  UnionFind sets_;
};

}  // namespace

std::vector<int> tiedSets(const MapState& map, double max_variance) {
  UnionFind tied = TiedSets(map, max_variance).joined();
  std::vector<int> result;
  std::map<Index, int> numbers;
  for (Index k = 0; k < map.keyframes.size(); ++k) {
    const auto next = static_cast<int>(numbers.size());
    result.push_back(numbers.try_emplace(tied.root(k), next).first->second);
  }
  return result;
}

}  // namespace opp::mapping
