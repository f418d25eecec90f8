// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/merge_covered.h"

#include "opp/mapping/frontend/merge_landmarks.h"

#include "frontend/landmark_support.h"
#include "planar/landmark_extents.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace opp::mapping {
namespace {

using Index = std::size_t;

/// Samples this near may be on a plane [standard deviations].
constexpr double kNear = 3.0;
/// Of the smaller one's support.
constexpr double kMost = 0.7;

/// Where a landmark was seen.
struct Seen {
  int landmark = 0;
  PlaneFrame frame;
  std::vector<PlaneCell> cells;  ///< ascending
  double sigma = 0.0;            ///< standard deviation of a sample along the normal [m]
};

/// Of what all keyframes saw of it.
double sampleSigma(const PlaneLandmark& landmark, const MapState& map) {
  double weight = 0.0, samples = 0.0;
  for (const PrimitiveObservation& o : landmark.observations) {
    const Primitives& primitives = map.keyframes[Index(o.keyframe)].features.primitives_in_body;
    weight += primitives.planes[Index(o.primitive)].moments.weight();
    samples += primitives.planes[Index(o.primitive)].support;
  }
  return weight > 0.0 ? std::sqrt(samples / weight) : 0.0;
}

/// Of all landmarks that were, largest first.
std::vector<Seen> seenLandmarks(const MapState& map, double cell) {
  std::vector<Seen> all;
  int id = 0;
  for (const PlaneExtent& extent : landmarkSupports(map, cell)) {
    const double sigma = sampleSigma(map.landmarks.planes[Index(id)], map);
    all.push_back({id++, extent.frame(), extent.supportCells(), sigma});
    if (all.back().cells.empty()) all.pop_back();
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Seen& a, const Seen& b) { return a.cells.size() > b.cells.size(); });
  return all;
}

/// Cells of `small` that may as well be of `large`.
std::size_t coveredCells(const Seen& small, const Seen& large, double cell) {
  return static_cast<std::size_t>(
      std::count_if(small.cells.begin(), small.cells.end(), [&](const PlaneCell& at) {
        const Eigen::Vector3d point = small.frame.lift(cell * centreOf(at));
        return std::abs(large.frame.plane().signedDistance(point)) <= kNear * small.sigma &&
               std::binary_search(large.cells.begin(), large.cells.end(),
                                  large.frame.cellAt(point, cell));
      }));
}

}  // namespace

int mergeCovered(MapState& map, double cell) {
  std::vector<int> joined_with(map.landmarks.planes.size());
  std::iota(joined_with.begin(), joined_with.end(), 0);
  std::vector<Seen> stay;
  int joined = 0;
  for (const Seen& seen : seenLandmarks(map, cell)) {
    auto most = static_cast<std::size_t>(kMost * static_cast<double>(seen.cells.size()));
    for (const Seen& larger : stay) {
      if (!faceAlike(larger.frame.plane(), seen.frame.plane())) continue;
      const std::size_t covered = coveredCells(seen, larger, cell);
      if (covered <= most) continue;
      most = covered;
      joined_with[Index(seen.landmark)] = larger.landmark;
    }
    if (joined_with[Index(seen.landmark)] == seen.landmark)
      stay.push_back(seen);
    else
      ++joined;
  }
  if (joined > 0) joinLandmarks(joined_with, map);
  return joined;
}

}  // namespace opp::mapping
