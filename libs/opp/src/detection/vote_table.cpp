// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/detection/vote_table.h"

#include "opp/geometry/constants.h"

#include <algorithm>
#include <cmath>

namespace opp {

VoteTable::VoteTable(int theta_bins, int rho_bins, double radius)
    : theta_bins_(theta_bins),
      rho_bins_(rho_bins),
      radius_(static_cast<float>(radius)),
      counts_(static_cast<std::size_t>(theta_bins) * static_cast<std::size_t>(rho_bins), 0) {}

void VoteTable::cast(float theta, float rho, std::uint32_t voter) {
  constexpr float kPiF = static_cast<float>(kPi);
  while (theta < 0.0F || theta >= kPiF) {
    theta += theta < 0.0F ? kPiF : -kPiF;
    rho = -rho;
  }
  const auto bin = [](float value, float range, int bins) {
    return std::clamp(static_cast<int>(value / range * static_cast<float>(bins)), 0, bins - 1);
  };
  const Vote vote{theta, rho, bin(theta, kPiF, theta_bins_),
                  bin(rho + radius_, 2.0F * radius_, rho_bins_), voter};
  ++counts_[static_cast<std::size_t>(index({vote.theta_bin, vote.rho_bin}))];
  votes_.push_back(vote);
}

VoteTable::Bin VoteTable::wrapped(Bin bin) const {
  if (bin.theta < 0) return {bin.theta + theta_bins_, rho_bins_ - 1 - bin.rho};
  if (bin.theta >= theta_bins_) return {bin.theta - theta_bins_, rho_bins_ - 1 - bin.rho};
  return bin;
}

int VoteTable::windowVotes(Bin center) const {
  int sum = 0;
  for (int t = center.theta - 1; t <= center.theta + 1; ++t) {
    for (int r = std::max(0, center.rho - 1); r <= std::min(rho_bins_ - 1, center.rho + 1); ++r) {
      sum += counts_[static_cast<std::size_t>(index(wrapped({t, r})))];
    }
  }
  return sum;
}

bool VoteTable::inWindow(const Vote& vote, Bin center, double& theta, double& rho) const {
  // The vote as seen from the center: possibly on the other side of the fold.
  Bin bin{vote.theta_bin, vote.rho_bin};
  theta = static_cast<double>(vote.theta);
  rho = static_cast<double>(vote.rho);
  const int steps = bin.theta - center.theta;
  if (std::abs(steps) > 1) {
    const bool above = steps > 0;
    bin = {bin.theta + (above ? -theta_bins_ : theta_bins_), rho_bins_ - 1 - bin.rho};
    theta += above ? -kPi : kPi;
    rho = -rho;
  }
  return std::abs(bin.theta - center.theta) <= 1 && std::abs(bin.rho - center.rho) <= 1;
}

VotePeak VoteTable::takePeak() {
  VotePeak peak;
  Bin center{0, 0};
  int best = 0;
  for (const Vote& vote : votes_) {
    const int sum = windowVotes({vote.theta_bin, vote.rho_bin});
    if (sum <= best) continue;
    best = sum;
    center = {vote.theta_bin, vote.rho_bin};
  }
  std::size_t kept = 0;
  for (const Vote& vote : votes_) {
    double theta = 0.0, rho = 0.0;
    if (!inWindow(vote, center, theta, rho)) {
      votes_[kept++] = vote;
      continue;
    }
    peak.theta += theta;
    peak.rho += rho;
    peak.voters.push_back(vote.voter);
    --counts_[static_cast<std::size_t>(index({vote.theta_bin, vote.rho_bin}))];
  }
  votes_.resize(kept);
  if (peak.voters.empty()) return peak;
  peak.theta /= static_cast<double>(peak.voters.size());
  peak.rho /= static_cast<double>(peak.voters.size());
  return peak;
}

void VoteTable::clear() {
  for (const Vote& vote : votes_) {
    counts_[static_cast<std::size_t>(index({vote.theta_bin, vote.rho_bin}))] = 0;
  }
  votes_.clear();
}

int significantVotes(double mean, double windows, double false_alarms) {
  // P(X ≥ t) ≤ e^−mean (e mean / t)^t for t > mean.
  const double needed = std::log(windows / false_alarms);
  int votes = std::max(3, static_cast<int>(std::ceil(mean)));
  while (mean > 0.0 && votes * std::log(votes / mean) - (votes - mean) < needed) ++votes;
  return votes;
}

}  // namespace opp
