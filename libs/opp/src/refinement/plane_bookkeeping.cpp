// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/plane_bookkeeping.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace opp {
namespace {

/// One surface that nearest-plane assignment cuts in two: each half of a Gaussian has a mean square
/// of 0.36 σ² about its own plane and of 1 σ² about the common one, 2.8 times as much. Two surfaces
/// that `splitLayers` tells apart have at least 6 times as much.
constexpr double kOneSurface = 4.0;

/// Whether the samples of both planes fit one plane as well as two.
bool sameSurface(const PlaneFit& a, const PlaneFit& b, const RefinementParams& params) {
  if (std::abs(a.plane.normal().dot(b.plane.normal())) < std::cos(params.normal_gate)) return false;
  PointMoments joint = a.moments;
  joint.merge(b.moments);
  const Eigen::Vector3d normal = ownNormal(joint.scatter(), a.plane.normal());
  const Plane plane = Plane::fromPointNormal(joint.mean(), normal);
  const auto fits = [&](const PlaneFit& part) {
    return part.moments.squaredError(plane) <= kOneSurface * part.moments.squaredError(part.plane);
  };
  return fits(a) && fits(b);
}

void absorb(const PlaneFit& part, PlaneFit& whole) {
  whole.sums.merge(part.sums);
  whole.moments = whole.sums.moments();
  whole.slack = std::max(whole.slack, part.slack);
  whole.reach.extend(part.reach);
  const Eigen::Vector3d normal = ownNormal(whole.moments.scatter(), whole.plane.normal());
  whole.plane = Plane::fromPointNormal(whole.moments.mean(), normal);
}

}  // namespace

Eigen::Vector3d ownNormal(const Eigen::Matrix3d& scatter, const Eigen::Vector3d& known) {
  // A weak prior of 1 rad⁻² for the known normal decides where the points decide nothing.
  const Eigen::Matrix3d prior = Eigen::Matrix3d::Identity() - known * known.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(0.5 * (scatter + scatter.transpose()) +
                                                             prior);
  const Eigen::Vector3d normal = eigen.eigenvectors().col(0);
  return normal.dot(known) < 0.0 ? Eigen::Vector3d(-normal) : normal;
}

std::vector<int> survivors(std::vector<PlaneFit>& fits, const RefinementParams& params) {
  const std::size_t count = fits.size();
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return fits[a].sums.support > fits[b].sums.support;
  });
  std::vector<std::size_t> kept, first(count);  // first: least index of those merged into a plane
  std::vector<int> target(count, -1);
  for (const std::size_t k : order) {
    if (fits[k].curved || fits[k].uncertain || fits[k].sums.support < params.min_support) continue;
    const auto same = std::find_if(kept.begin(), kept.end(), [&](std::size_t other) {
      return sameSurface(fits[other], fits[k], params);
    });
    const std::size_t whole = same == kept.end() ? k : *same;
    if (whole == k) {
      kept.push_back(k);
      first[k] = k;
    } else {
      absorb(fits[k], fits[whole]);
      first[whole] = std::min(first[whole], k);
    }
    target[k] = static_cast<int>(whole);
  }
  std::sort(kept.begin(), kept.end(),
            [&](std::size_t a, std::size_t b) { return first[a] < first[b]; });
  std::vector<int> rank(count, -1);
  for (std::size_t r = 0; r < kept.size(); ++r) rank[kept[r]] = static_cast<int>(r);
  for (int& index : target) {
    if (index >= 0) index = rank[static_cast<std::size_t>(index)];
  }
  return target;
}

void compact(const std::vector<int>& new_index, std::vector<PlaneFit>& fits,
             std::vector<OrthogonalityEdge>& edges) {
  // Of the planes that share an index, the one with most support holds the merged sums.
  std::vector<PlaneFit> kept;
  for (std::size_t k = 0; k < fits.size(); ++k) {
    if (new_index[k] < 0) continue;
    const auto slot = static_cast<std::size_t>(new_index[k]);
    if (slot >= kept.size()) kept.resize(slot + 1);
    if (fits[k].sums.support > kept[slot].sums.support) kept[slot] = fits[k];
  }
  fits = std::move(kept);
  std::vector<OrthogonalityEdge> moved;
  for (const OrthogonalityEdge& edge : edges) {
    const int a = new_index[static_cast<std::size_t>(edge.planes[0])];
    const int b = new_index[static_cast<std::size_t>(edge.planes[1])];
    if (a < 0 || b < 0 || a == b) continue;
    const std::array<int, 2> planes{std::min(a, b), std::max(a, b)};
    const auto same = std::find_if(moved.begin(), moved.end(),
                                   [&](const auto& other) { return other.planes == planes; });
    if (same == moved.end()) {
      moved.push_back({planes, edge.votes});
    } else {
      same->votes += edge.votes;
    }
  }
  std::sort(moved.begin(), moved.end(),
            [](const auto& a, const auto& b) { return a.planes < b.planes; });
  edges = std::move(moved);
}

PlanePrimitive primitiveOf(const PlaneFit& fit, int family, const OrientedCloud& cloud,
                           const Primitives& scan) {
  PlanePrimitive result;
  const Eigen::Vector3d viewpoint = cloud.viewpoint.cast<double>();
  result.plane = fit.plane.signedDistance(viewpoint) < 0.0 ? fit.plane.flipped() : fit.plane;
  result.moments = fit.moments;
  result.family = family;
  const SampleSums& sums = fit.sums;
  result.support = sums.support;
  result.area = sums.area;
  result.rms = std::sqrt(sums.meanSquare());
  const Eigen::Vector3d& shared = scan.families[static_cast<std::size_t>(family)].normal;
  const double sign = shared.dot(result.plane.normal()) < 0.0 ? -1.0 : 1.0;
  const Eigen::Matrix<double, 3, 2> tangents = tangentBasis(result.plane.normal());
  const Eigen::Matrix2d turn = sign * tangents.transpose() * tangentBasis(shared);
  const Eigen::Matrix2d angles =
      turn * scan.normal_covariance.block<2, 2>(2 * family, 2 * family) * turn.transpose();
  // d = −n·mean + ε, where ε is independent of the normal with variance 1/weight.
  const Eigen::Vector2d lever = tangents.transpose() * fit.moments.mean();
  result.covariance.topLeftCorner<2, 2>() = angles;
  result.covariance.topRightCorner<2, 1>() = -angles * lever;
  result.covariance.bottomLeftCorner<1, 2>() = -(angles * lever).transpose();
  // One unit of information more than the data have: a plane without samples gets 1 m².
  result.covariance(2, 2) = 1.0 / (1.0 + fit.moments.weight()) + lever.dot(angles * lever);
  return result;
}

}  // namespace opp
