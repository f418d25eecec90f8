// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "registration/verify_pose.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace opp::mapping {
namespace {

/// A sample in free space says more against a pose than one on a surface says for it: at a wrong
/// pose planes still meet planes by chance, at the right one next to nothing stands in free space.
/// Ratio of the logarithms of the odds, for agreement of 50 % at the right pose against 30 % at a
/// wrong one, and conflict of 1 % against 8 %.
constexpr std::int8_t kConflictWeight = 3;

/// Agreement of `moving` with `fixed`; appends what each sample says to the result.
Agreement compare(const ScanModel& fixed, const ScanModel& moving,
                  const Eigen::Isometry3f& fixed_from_moving, float slack,
                  const GlobalAlignmentParams& params, Verification& all) {
  const auto min_cosine = static_cast<float>(std::cos(params.normal_gate));
  const auto sigmas = static_cast<float>(params.agreement_sigmas);
  Agreement result;
  for (const std::uint32_t i : moving.samples) {
    ++result.samples;
    all.votes.push_back(0);
    all.partners.push_back(-1);
    const Eigen::Vector3f point = fixed_from_moving * moving.cloud().points[i];
    const Eigen::Vector3f normal = fixed_from_moving.linear() * moving.cloud().normals[i];
    const std::int32_t nearest = fixed.voxels.near(point, normal, min_cosine);
    if (nearest >= 0) {
      const auto k = static_cast<std::size_t>(nearest);
      const float distance = fixed.cloud().normals[k].dot(point - fixed.cloud().points[k]);
      const float noise = std::hypot(fixed.sigmas[k], moving.sigmas[i]);
      if (std::abs(distance) <= sigmas * noise + slack) {
        ++result.agreeing;
        all.votes.back() = 1;
        all.partners.back() = nearest;
        result.squared_distance += static_cast<double>(distance * distance);
        continue;
      }
    }
    if (!fixed.free_space.contains(point, sigmas * moving.sigmas[i] + slack)) continue;
    ++result.conflicting;
    all.votes.back() = -kConflictWeight;
  }
  return result;
}

double margin(const Agreement& a) {
  if (a.samples == 0) return 0.0;
  return static_cast<double>(a.agreeing - kConflictWeight * a.conflicting) / a.samples;
}

/// After so many screening samples a pose that has less than this share of what it needs is
/// dropped: the odds of a good pose (a binomial variable) to fail here are below 1 %.
constexpr int kFirstLook = 24;
constexpr double kHopeful = 0.6;

}  // namespace

double Verification::score() const { return 0.5 * (margin(of_source) + margin(of_target)); }

double Verification::overlap() const { return std::max(of_source.overlap(), of_target.overlap()); }

double Verification::conflict() const {
  const int conflicts = of_source.conflicting + of_target.conflicting;
  const int both = conflicts + of_source.agreeing + of_target.agreeing;
  return both == 0 ? 0.0 : static_cast<double>(conflicts) / both;
}

double Verification::rms() const {
  const int agreeing = of_source.agreeing + of_target.agreeing;
  if (agreeing == 0) return 0.0;
  return std::sqrt((of_source.squared_distance + of_target.squared_distance) / agreeing);
}

double clarity(const Verification& a, const Verification& b) {
  int advantage = 0, telling = 0;
  for (std::size_t i = 0; i < a.votes.size(); ++i) {
    advantage += a.votes[i] - b.votes[i];
    telling += std::abs(a.votes[i] - b.votes[i]);
  }
  if (telling == 0) return 0.0;
  return advantage / std::sqrt(static_cast<double>(telling) * static_cast<double>(a.votes.size()));
}

int screenPose(const ScanModel& target, const ScanModel& source,
               const Eigen::Isometry3f& target_from_source, float min_cosine, int at_least) {
  const int count = static_cast<int>(source.screening_samples.size());
  int agreeing = 0, seen = 0;
  for (const std::uint32_t i : source.screening_samples) {
    if (agreeing + count - seen < at_least) return 0;
    if (seen == kFirstLook && agreeing * count < kHopeful * at_least * seen) return 0;
    ++seen;
    const Eigen::Vector3f point = target_from_source * source.cloud().points[i];
    const Eigen::Vector3f normal = target_from_source.linear() * source.cloud().normals[i];
    if (target.voxels.near(point, normal, min_cosine) >= 0) ++agreeing;
  }
  return agreeing;
}

Verification verifyPose(const ScanModel& target, const ScanModel& source,
                        const Eigen::Isometry3d& target_from_source, double slack,
                        const GlobalAlignmentParams& params) {
  const auto tolerance = static_cast<float>(slack);
  Verification result;
  result.votes.reserve(source.samples.size() + target.samples.size());
  result.partners.reserve(result.votes.capacity());
  result.of_source =
      compare(target, source, target_from_source.cast<float>(), tolerance, params, result);
  result.of_target = compare(source, target, target_from_source.inverse().cast<float>(), tolerance,
                             params, result);
  return result;
}

}  // namespace opp::mapping
