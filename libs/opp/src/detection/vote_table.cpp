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
      theta_scale_(static_cast<float>(theta_bins / kPi)),
      rho_scale_(static_cast<float>(0.5 * rho_bins / radius)),
      windows_(static_cast<std::size_t>(theta_bins) * static_cast<std::size_t>(rho_bins + 2), 0) {}

void VoteTable::cast(float theta, float rho, std::uint32_t voter) {
  constexpr float kPiF = static_cast<float>(kPi);
  while (theta < 0.0F || theta >= kPiF) {
    theta += theta < 0.0F ? kPiF : -kPiF;
    rho = -rho;
  }
  const Vote vote{
      theta, rho, std::clamp(static_cast<int>(theta * theta_scale_), 0, theta_bins_ - 1),
      std::clamp(static_cast<int>((rho + radius_) * rho_scale_), 0, rho_bins_ - 1), voter};
  count(vote, 1);
  votes_.push_back(vote);
}

void VoteTable::addToRow(int theta_bin, int rho_bin, std::int32_t change) {
  std::int32_t* bins = &windows_[index(theta_bin, rho_bin - 1)];
  bins[0] += change;
  bins[1] += change;
  bins[2] += change;
}

void VoteTable::count(const Vote& vote, std::int32_t change) {
  // Beyond the fold ρ is mirrored.
  const int mirrored = rho_bins_ - 1 - vote.rho_bin, last = theta_bins_ - 1;
  addToRow(vote.theta_bin, vote.rho_bin, change);
  if (vote.theta_bin > 0) {
    addToRow(vote.theta_bin - 1, vote.rho_bin, change);
  } else {
    addToRow(last, mirrored, change);
  }
  if (vote.theta_bin < last) {
    addToRow(vote.theta_bin + 1, vote.rho_bin, change);
  } else {
    addToRow(0, mirrored, change);
  }
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

bool VoteTable::takePeak(int min_votes, VotePeak& peak) {
  peak.theta = peak.rho = 0.0;
  peak.voters.clear();
  Bin center{0, 0};
  int best = 0;
  for (const Vote& vote : votes_) {
    const int sum = windows_[index(vote.theta_bin, vote.rho_bin)];
    if (sum <= best) continue;
    best = sum;
    center = {vote.theta_bin, vote.rho_bin};
  }
  if (best < min_votes) return false;
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
  peak.theta /= static_cast<double>(peak.voters.size());
  peak.rho /= static_cast<double>(peak.voters.size());
  return true;
}

void VoteTable::clear() {
  for (const Vote& vote : votes_) count(vote, -1);
  votes_.clear();
}

int significantVotes(double mean, double windows, double false_alarms, int least) {
  // P(X ≥ t) ≤ e^−mean (e mean / t)^t for t > mean.
  const double needed = std::log(windows / false_alarms);
  int votes = std::max({3, least, static_cast<int>(std::ceil(mean))});
  while (mean > 0.0 && votes * std::log(votes / mean) - (votes - mean) < needed) ++votes;
  return votes;
}

}  // namespace opp
