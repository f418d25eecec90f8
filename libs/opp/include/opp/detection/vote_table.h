// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace opp {

/// A maximum of the accumulator.
struct VotePeak {
  double theta = 0.0;                 ///< [rad] mean of the peak's votes, within a bin of [0, π)
  double rho = 0.0;                   ///< [m] mean of the peak's votes
  std::vector<std::uint32_t> voters;  ///< as given to `cast`, in that order
};

/// Accumulator over (θ, ρ) of one reference point. (θ, ρ) and (θ + π, −ρ) are the same plane: θ is
/// folded to [0, π), and the table wraps around there with ρ mirrored. A peak is the 3 × 3 bins
/// about its centre, so that no bin edge can split it.
class VoteTable {
 public:
  /// Bins of π / theta_bins and 2 radius / rho_bins.
  VoteTable(int theta_bins, int rho_bins, double radius);

  /// One vote. θ ∈ [−2π, 2π] [rad], |ρ| ≤ radius [m]; `voter` comes back with the peak.
  void cast(float theta, float rho, std::uint32_t voter);
  /// Takes the 3 × 3 bins with most votes out of the table (the one cast first wins ties) if they
  /// hold at least `min_votes` ≥ 1; the next call finds the next peak. False, and nothing taken, if
  /// they do not. O(votes).
  bool takePeak(int min_votes, VotePeak& peak);
  /// Votes still in the table.
  std::size_t votes() const { return votes_.size(); }
  void clear();

 private:
  struct Vote {
    float theta, rho;
    std::int32_t theta_bin, rho_bin;
    std::uint32_t voter;
  };
  struct Bin {
    std::int32_t theta, rho;
  };
  /// Place of a bin in windows_, whose rows of ρ have a margin of one bin on each side.
  std::size_t index(int theta_bin, int rho_bin) const {
    return static_cast<std::size_t>(theta_bin * (rho_bins_ + 2) + rho_bin + 1);
  }
  void count(const Vote& vote, std::int32_t change);
  void addToRow(int theta_bin, int rho_bin, std::int32_t change);
  bool inWindow(const Vote& vote, Bin center, double& theta, double& rho) const;

  int theta_bins_, rho_bins_;
  float radius_, theta_scale_, rho_scale_;
  std::vector<std::int32_t> windows_;  ///< votes in the 3 × 3 bins about each bin
  std::vector<Vote> votes_;
};

/// Smallest number of votes in a peak that accidental votes reach less than `false_alarms` times
/// in `windows` places, if they fall into each with expectation `mean` (Chernoff's bound of the
/// Poisson distribution). At least 3: fewer points fix no plane. It grows with `mean`; `least` is a
/// lower bound known from a smaller mean.
int significantVotes(double mean, double windows, double false_alarms, int least = 3);

}  // namespace opp
