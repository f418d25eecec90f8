// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/plane_bookkeeping.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace opp {
namespace {

void absorb(const PlaneFit& part, PlaneFit& whole) {
  whole.sums.merge(part.sums);
  whole.moments = whole.sums.moments();
  whole.reach.extend(part.reach);
  const Eigen::Vector3d normal = ownNormal(whole.moments.scatter(), whole.plane.normal());
  whole.plane = Plane::fromPointNormal(whole.moments.mean(), normal);
  const double rms = std::sqrt(whole.moments.squaredError(whole.plane) / whole.moments.weight());
  whole.slack = std::max({whole.slack, part.slack, rms});
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

std::vector<int> survivors(SameSurface& same_surface, const RefinementParams& params,
                           std::vector<PlaneFit>& fits) {
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
    const auto same = std::find_if(kept.begin(), kept.end(),
                                   [&](std::size_t other) { return same_surface(other, k); });
    const std::size_t whole = same == kept.end() ? k : *same;
    if (whole == k) {
      kept.push_back(k);
      first[k] = k;
    } else {
      absorb(fits[k], fits[whole]);
      same_surface.merge(k, whole);
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
