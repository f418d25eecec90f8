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
      counts_(static_cast<std::size_t>(theta_bins + 2) * static_cast<std::size_t>(rho_bins + 2),
              0) {}

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
  count(vote, 1);
  votes_.push_back(vote);
}

void VoteTable::count(const Vote& vote, std::int32_t change) {
  counts_[index(vote.theta_bin, vote.rho_bin)] += change;
  // The rows beside the fold once more on its other side, mirrored.
  const int mirrored = rho_bins_ - 1 - vote.rho_bin;
  if (vote.theta_bin == 0) counts_[index(theta_bins_, mirrored)] += change;
  if (vote.theta_bin == theta_bins_ - 1) counts_[index(-1, mirrored)] += change;
}

int VoteTable::windowVotes(int theta_bin, int rho_bin) const {
  const std::int32_t* row = &counts_[index(theta_bin - 1, rho_bin - 1)];
  int sum = 0;
  for (int k = 0; k < 3; ++k, row += rho_bins_ + 2) sum += row[0] + row[1] + row[2];
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
    const int sum = windowVotes(vote.theta_bin, vote.rho_bin);
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
    count(vote, -1);
  }
  votes_.resize(kept);
  if (peak.voters.empty()) return peak;
  peak.theta /= static_cast<double>(peak.voters.size());
  peak.rho /= static_cast<double>(peak.voters.size());
  return peak;
}

void VoteTable::clear() {
  for (const Vote& vote : votes_) count(vote, -1);
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
