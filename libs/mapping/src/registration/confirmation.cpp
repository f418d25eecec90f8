// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "registration/pose_judge.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace opp::mapping {
namespace {

/// A normal is independent of others if it is at least 30° out of their span.
constexpr double kMinSine = 0.5;

/// Part of `normal` that is outside of the span of two or fewer others.
double outside(const std::vector<Plane>& basis, const Eigen::Vector3d& normal) {
  if (basis.empty()) return 1.0;
  if (basis.size() == 1) return basis[0].normal().cross(normal).norm();
  return std::abs(basis[0].normal().cross(basis[1].normal()).normalized().dot(normal));
}

/// The target's planes with the most of these samples, of independent normals.
std::vector<Plane> basisOf(const ScanModel& target, const std::vector<std::uint32_t>& samples) {
  const std::vector<PlanePrimitive>& planes = target.primitives().planes;
  std::vector<int> count(planes.size(), 0), order(planes.size());
  for (const std::uint32_t i : samples) {
    if (target.labelOf(i) >= 0) ++count[static_cast<std::size_t>(target.labelOf(i))];
  }
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return count[static_cast<std::size_t>(a)] > count[static_cast<std::size_t>(b)];
  });
  std::vector<Plane> basis;
  for (const int p : order) {
    const Plane& plane = planes[static_cast<std::size_t>(p)].plane;
    if (basis.size() == 3 || count[static_cast<std::size_t>(p)] == 0) break;
    if (outside(basis, plane.normal()) > kMinSine) basis.push_back(plane);
  }
  return basis;
}

/// The target's samples that take part in an agreement, from either side.
std::vector<std::uint32_t> agreeingTargetSamples(const ScanModel& target, const ScanModel& source,
                                                 const Verification& verification) {
  std::vector<std::uint32_t> result;
  const std::size_t of_source = source.samples.size();
  for (std::size_t v = 0; v < verification.votes.size(); ++v) {
    if (verification.votes[v] <= 0) continue;
    result.push_back(v < of_source ? static_cast<std::uint32_t>(verification.partners[v])
                                   : target.samples[v - of_source]);
  }
  return result;
}

}  // namespace

double Confirmation::share() const {
  return agreeing == 0 ? 0.0 : static_cast<double>(confirming) / agreeing;
}

Confirmation confirmationOf(const ScanModel& target, const ScanModel& source,
                            const Candidate& candidate) {
  const std::vector<std::uint32_t> agreeing =
      agreeingTargetSamples(target, source, candidate.verification);
  const std::vector<Plane> basis = basisOf(target, agreeing);
  // Wide, so that what bends away from a surface or sticks out of it a little does not count.
  const double reach = 0.5 * std::max(target.voxels.cell(), source.voxels.cell());
  const auto beyond = std::count_if(agreeing.begin(), agreeing.end(), [&](std::uint32_t i) {
    const Eigen::Vector3d point = target.cloud().points[i].cast<double>();
    return std::all_of(basis.begin(), basis.end(), [&](const Plane& plane) {
      return std::abs(plane.signedDistance(point)) > reach;
    });
  });
  return {static_cast<int>(agreeing.size()), static_cast<int>(beyond)};
}

}  // namespace opp::mapping
