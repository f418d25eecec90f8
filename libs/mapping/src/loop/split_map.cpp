// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/split_map.h"

#include "opp/graph/union_find.h"
#include "opp/mapping/loop/keyframe_graph.h"

#include "registration/observability.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <utility>

namespace opp::mapping {
namespace {

using Index = std::size_t;

/// New id of each old one; −1: left out.
using Renumbering = std::vector<int>;

/// Numbers those of `count` things that `kept` approves of.
template <typename Kept>
Renumbering renumber(Index count, Kept kept) {
  Renumbering result(count, -1);
  int next = 0;
  for (Index k = 0; k < count; ++k) {
    if (kept(k)) result[k] = next++;
  }
  return result;
}

template <std::size_t N>
bool allKept(const std::array<int, N>& ids, const Renumbering& renumbered) {
  return std::all_of(ids.begin(), ids.end(), [&](int id) { return renumbered[Index(id)] >= 0; });
}

template <std::size_t N>
std::array<int, N> renumberedIds(std::array<int, N> ids, const Renumbering& renumbered) {
  for (int& id : ids) id = renumbered[Index(id)];
  return ids;
}

std::vector<PrimitiveObservation> observationsOf(const std::vector<PrimitiveObservation>& all,
                                                 const Renumbering& keyframes) {
  std::vector<PrimitiveObservation> result;
  for (PrimitiveObservation o : all) {
    o.keyframe = keyframes[Index(o.keyframe)];
    if (o.keyframe >= 0) result.push_back(o);
  }
  return result;
}

LandmarkMap landmarksOf(const LandmarkMap& all, const Renumbering& keyframes,
                        const Renumbering& planes) {
  LandmarkMap result;
  for (Index p = 0; p < all.planes.size(); ++p) {
    if (planes[p] < 0) continue;
    result.planes.push_back(
        {all.planes[p].plane_in_map, observationsOf(all.planes[p].observations, keyframes)});
  }
  for (const CornerLandmark& corner : all.corners) {
    auto observations = observationsOf(corner.observations, keyframes);
    if (observations.empty() || !allKept(corner.planes, planes)) continue;
    result.corners.push_back(
        {renumberedIds(corner.planes, planes), corner.position_in_map, std::move(observations)});
  }
  return result;
}

MapFactors factorsOf(const MapFactors& all, const Renumbering& keyframes,
                     const Renumbering& planes) {
  MapFactors result;
  for (PlaneFactor f : all.planes) {
    f.keyframe = keyframes[Index(f.keyframe)];
    if (f.keyframe < 0) continue;
    f.landmark = planes[Index(f.landmark)];
    result.planes.push_back(f);
  }
  for (RelativePoseFactor f : all.relative_poses) {
    f.first = keyframes[Index(f.first)];
    f.second = keyframes[Index(f.second)];
    if (f.first >= 0 && f.second >= 0) result.relative_poses.push_back(f);
  }
  for (const OrthogonalityFactor& f : all.orthogonalities) {
    if (allKept(f.landmarks, planes))
      result.orthogonalities.push_back({renumberedIds(f.landmarks, planes)});
  }
  for (const ParallelismFactor& f : all.parallelisms) {
    if (allKept(f.landmarks, planes))
      result.parallelisms.push_back({renumberedIds(f.landmarks, planes)});
  }
  return result;
}

/// Moves the kept keyframes out of `map`; the rest of it is copied.
MapState takeKeyframes(const Renumbering& keyframes, MapState& map) {
  const Renumbering planes = renumber(map.landmarks.planes.size(), [&](Index p) {
    const auto& seen = map.landmarks.planes[p].observations;
    return std::any_of(seen.begin(), seen.end(), [&](const PrimitiveObservation& o) {
      return keyframes[Index(o.keyframe)] >= 0;
    });
  });
  MapState part;
  part.landmarks = landmarksOf(map.landmarks, keyframes, planes);
  part.factors = factorsOf(map.factors, keyframes, planes);
  for (Index k = 0; k < map.keyframes.size(); ++k) {
    if (keyframes[k] < 0) continue;
    part.keyframes.push_back(std::move(map.keyframes[k]));
    for (int& landmark : part.keyframes.back().landmark_of_plane) {
      if (landmark >= 0) landmark = planes[Index(landmark)];
    }
  }
  for (const KeyframeLink& link : map.links) {
    const int first = keyframes[Index(link.first)], second = keyframes[Index(link.second)];
    if (first >= 0 && second >= 0) part.links.push_back({first, second, link.variance});
  }
  for (LocalizedScan scan : map.scans) {
    scan.keyframe = keyframes[Index(scan.keyframe)];
    if (scan.keyframe >= 0) part.scans.push_back(scan);
  }
  return part;
}

/// (ω, v) of a body whose v is given at one point, with v at another that is `offset` away.
Matrix6d movedBy(const Eigen::Vector3d& offset) {
  Matrix6d moved = Matrix6d::Identity();
  moved.bottomLeftCorner<3, 3>() << 0.0, offset.z(), -offset.y(),  //
      -offset.z(), 0.0, offset.x(),                                //
      offset.y(), -offset.x(), 0.0;
  return moved;
}

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

std::vector<MapState> splitMap(MapState&& map, double max_variance) {
  UnionFind tied = TiedSets(map, max_variance).joined();
  std::vector<MapState> parts;
  std::vector<bool> taken(map.keyframes.size(), false);
  for (Index first = 0; first < taken.size(); ++first) {
    if (taken[first]) continue;
    const Renumbering keyframes =
        renumber(taken.size(), [&](Index k) { return tied.root(k) == tied.root(first); });
    for (Index k = 0; k < taken.size(); ++k) taken[k] = taken[k] || keyframes[k] >= 0;
    if (first == 0 && std::all_of(taken.begin(), taken.end(), [](bool t) { return t; })) {
      parts.push_back(std::move(map));
      return parts;
    }
    parts.push_back(takeKeyframes(keyframes, map));
  }
  const auto largest = std::max_element(
      parts.begin(), parts.end(),
      [](const MapState& a, const MapState& b) { return a.scans.size() < b.scans.size(); });
  if (largest != parts.end()) largest->loop_closures = map.loop_closures;
  return parts;
}

}  // namespace opp::mapping
