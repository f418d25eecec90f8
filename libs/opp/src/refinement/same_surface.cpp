// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/same_surface.h"

#include "graph/one_surface.h"
#include "refinement/plane_bookkeeping.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

namespace opp {
namespace {

/// Samples adjoin that lie no farther apart than this many of their extents (a diagonal is √2).
constexpr double kAdjoin = 1.5;
/// Pieces adjoin along at least this many pairs of samples; fewer tell nothing.
constexpr double kLeastPairs = 3.0;
/// What adjoins must be less than a step at 90 % confidence: where noise or a sample astride of an
/// edge brings two layers together in one place, that tells too little.
constexpr double kStepSigmas = 1.28;
/// A step shows in full between samples that adjoin, less what a sample astride of it takes from
/// both sides; along a bent surface they differ by its slope over one extent.
constexpr double kStep = 0.5;

/// Whether the part turns from the common normal by no more than its uncertainty and a bend of
/// `slope` (standard deviation [rad]) allow.
bool turnsBy(const PlaneFit& part, const Eigen::Vector3d& normal, double slope, double sigmas) {
  const Eigen::Matrix<double, 3, 2> tangents = tangentBasis(normal);
  const Eigen::Vector3d& own = part.plane.normal();
  const Eigen::Vector2d turn = tangents.transpose() * own;
  const Eigen::Matrix2d known = tangents.transpose() * part.information(own) * tangents;
  // (C + s²)⁻¹ = (1 + s² K)⁻¹ K for C = K⁻¹, also where K is singular.
  const Eigen::Matrix2d weight =
      (Eigen::Matrix2d::Identity() + slope * slope * known).inverse() * known;
  return turn.dot(weight * turn) <= sigmas * sigmas;
}

/// Where the two planes are this many standard deviations of a sample apart, its own error does not
/// decide whose it is: if it lies on one of them, within this part of their distance, and not
/// halfway, as where a bent surface goes over from one to the other.
constexpr double kApart = 6.0;
constexpr double kOnOne = 0.25;

/// A sample in the frame of the common plane.
struct Place {
  double row = 0.0;    ///< of strips along the plane, as wide as samples reach that adjoin
  double along = 0.0;  ///< in the plane [m]
  double across = 0.0;
  double offset = 0.0;  ///< from the plane [m]
  double squared_extent = 0.0;
  int label = 0;         ///< +1: of the first plane, −1: of the second
  bool is_sure = false;  ///< the label is
  int side = 0;          ///< > 0: of the first plane, < 0: of the second, as those around tell
};

/// Whether the sample is plainly of its own plane and not of the other.
bool isSureOf(const WeightedSample& sample, const PlaneFit& own, const PlaneFit& other) {
  const double sign = own.plane.normal().dot(other.plane.normal()) < 0.0 ? -1.0 : 1.0;
  const double offset = own.plane.signedDistance(sample.point);
  const double gap = offset - sign * other.plane.signedDistance(sample.point);
  return gap * gap > kApart * kApart * sample.variance && std::abs(offset) < kOnOne * std::abs(gap);
}

bool adjoin(const Place& a, const Place& b) {
  const double along = b.along - a.along, across = b.across - a.across;
  const double extent = std::max(a.squared_extent, b.squared_extent);
  return along * along + across * across <= kAdjoin * kAdjoin * extent;
}

/// Places that adjoin are no farther apart than this [m].
double reachOf(const std::vector<Place>& places) {
  double largest = 0.0;
  for (const Place& place : places) largest = std::max(largest, place.squared_extent);
  return kAdjoin * std::sqrt(largest);
}

/// visit(i, j), i before j, for all samples that adjoin; they are in the same or in the next row.
/// `places` ascend by row, then along it; `reach` is what samples adjoin within [m].
template <typename Visit>
void visitAdjoining(const std::vector<Place>& places, double reach, const Visit& visit) {
  std::size_t next = 0;  // the first in the next row that may adjoin
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Place& place = places[i];
    const auto before = [&](const Place& other) {
      return other.row < place.row + 1.0 ||
             (other.row == place.row + 1.0 && other.along < place.along - reach);
    };
    for (std::size_t j = i + 1; j < places.size() && places[j].row == place.row; ++j) {
      if (places[j].along > place.along + reach) break;
      if (adjoin(place, places[j])) visit(i, j);
    }
    while (next < places.size() && before(places[next])) ++next;
    for (std::size_t j = next; j < places.size() && places[j].row == place.row + 1.0; ++j) {
      if (places[j].along > place.along + reach) break;
      if (adjoin(place, places[j])) visit(i, j);
    }
  }
}

/// Drops the places that cannot tell: samples of both planes, or others beside such, adjoin only
/// within two reaches of the places of both, and to know these one more is needed. `boxes`: of the
/// first and of the second plane's places (along, across).
void keepWherePlanesMeet(std::array<Eigen::AlignedBox2d, 2> boxes, double reach,
                         std::vector<Place>& places) {
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(3.0 * reach);
  for (Eigen::AlignedBox2d& box : boxes) box = {box.min() - margin, box.max() + margin};
  const Eigen::AlignedBox2d common = boxes[0].intersection(boxes[1]);
  const auto outside = [&](const Place& place) {
    return !common.contains(Eigen::Vector2d(place.along, place.across));
  };
  places.erase(std::remove_if(places.begin(), places.end(), outside), places.end());
}

}  // namespace

SameSurface::SameSurface(const std::vector<PlaneFit>& fits,
                         const std::vector<WeightedSample>& samples, const std::vector<int>& labels,
                         const Eigen::Vector3d& viewpoint, const SensorModel& sensor,
                         const RefinementParams& params)
    : fits_(fits),
      samples_(samples),
      viewpoint_(viewpoint),
      sensor_(sensor),
      params_(params),
      members_(membersOf(labels, fits.size())) {}

bool SameSurface::operator()(std::size_t index_a, std::size_t index_b) const {
  const PlaneFit &a = fits_[index_a], &b = fits_[index_b];
  if (std::abs(a.plane.normal().dot(b.plane.normal())) < std::cos(params_.normal_gate))
    return false;
  PointMoments joint = a.moments;
  joint.merge(b.moments);
  const Eigen::Vector3d normal = ownNormal(joint.scatter(), a.plane.normal());
  const Plane plane = Plane::fromPointNormal(joint.mean(), normal);
  if (isOneSurface(plane, {a.moments, a.plane}, {b.moments, b.plane}, sensor_.noise_correlation)) {
    return true;
  }
  bool bends = true;
  double step = 0.0;
  for (const PlaneFit* part : {&a, &b}) {
    const double own = part->moments.squaredError(part->plane);
    const double common = part->moments.squaredError(plane);
    const double range = (part->moments.mean() - viewpoint_).norm();
    const double bend = sensor_.distortion(range), sigmas = params_.test_sigmas;
    bends = bends && common - own <= part->moments.weight() * std::pow(sigmas * bend, 2) &&
            turnsBy(*part, normal, sensor_.distortionSlope(range), sigmas);
    step = std::max(step, std::sqrt(std::max(0.0, common - own) / part->moments.weight()));
  }
  return bends && goesOn(index_a, index_b, normal, step);
}

bool SameSurface::goesOn(std::size_t a, std::size_t b, const Eigen::Vector3d& normal,
                         double step) const {
  const Eigen::Matrix<double, 3, 2> tangents = tangentBasis(normal);
  std::vector<Place> places;
  places.reserve(members_[a].size() + members_[b].size());
  std::array<Eigen::AlignedBox2d, 2> boxes;
  for (const std::size_t plane : {a, b}) {
    for (const std::uint32_t i : members_[plane]) {
      const WeightedSample& sample = samples_[i];
      const Eigen::Vector2d place(tangents.col(0).dot(sample.point),
                                  tangents.col(1).dot(sample.point));
      places.push_back({0.0, place.x(), place.y(), normal.dot(sample.point), sample.area,
                        plane == a ? 1 : -1, isSureOf(sample, fits_[plane], fits_[a + b - plane]),
                        0});
      boxes[plane == a ? 0 : 1].extend(place);
    }
  }
  keepWherePlanesMeet(boxes, reachOf(places), places);
  const double reach = reachOf(places);
  if (!(reach > 0.0)) return false;  // samples without an extent adjoin nothing
  for (Place& place : places) place.row = std::floor(place.across / reach);
  std::sort(places.begin(), places.end(), [](const Place& p, const Place& q) {
    return std::tie(p.row, p.along, p.across) < std::tie(q.row, q.along, q.across);
  });
  std::vector<std::pair<std::size_t, std::size_t>> adjoining;
  visitAdjoining(places, reach, [&](std::size_t i, std::size_t j) {
    places[i].side += places[j].label;
    places[j].side += places[i].label;
    adjoining.emplace_back(i, j);
  });
  // A sample's own label may depend on its own error, which would show as a step.
  for (Place& place : places) {
    if (place.is_sure) place.side = place.label;
  }
  double pairs = 0.0, jumps = 0.0, squares = 0.0;
  for (const auto& [i, j] : adjoining) {
    if (places[i].side == 0 || places[j].side == 0) continue;
    if ((places[i].side > 0) == (places[j].side > 0)) continue;
    const double jump = places[j].offset - places[i].offset;
    jumps += places[j].side > 0 ? jump : -jump;
    squares += jump * jump;
    pairs += 1.0;
  }
  if (pairs < kLeastPairs) return false;
  const double mean = jumps / pairs;
  // Along a border each sample has three partners on the other side.
  const double error = std::sqrt(3.0 * std::max(0.0, squares / pairs - mean * mean) / pairs);
  return std::abs(mean) + kStepSigmas * error < kStep * step;
}

void SameSurface::merge(std::size_t part, std::size_t whole) {
  members_[whole].insert(members_[whole].end(), members_[part].begin(), members_[part].end());
  members_[part].clear();
}

}  // namespace opp
