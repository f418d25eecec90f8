// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

namespace opp::mapping {

/// Random numbers that depend on (seed, stream, index) alone, so that pixels can be drawn in any
/// order and by any thread. SplitMix64 (Steele et al., OOPSLA 2014); the same on every platform,
/// normal numbers up to the last bits of log and cos.
class SeededRandom {
 public:
  SeededRandom(std::uint64_t seed, std::uint64_t stream, std::uint64_t index);

  std::uint64_t bits();
  double uniform();  ///< in [0, 1)
  /// Two independent numbers of mean 0 and standard deviation 1 (Box–Muller).
  std::array<double, 2> normalPair();
  double normal() { return normalPair()[0]; }

 private:
  std::uint64_t state_;
};

}  // namespace opp::mapping
