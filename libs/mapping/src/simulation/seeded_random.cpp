// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/seeded_random.h"

#include "opp/geometry/constants.h"

#include <cmath>

namespace opp::mapping {
namespace {

std::uint64_t mixed(std::uint64_t z) {
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31U);
}

}  // namespace

SeededRandom::SeededRandom(std::uint64_t seed, std::uint64_t stream, std::uint64_t index)
    : state_(mixed(mixed(mixed(seed) + stream) + index)) {}

std::uint64_t SeededRandom::bits() {
  state_ += 0x9E3779B97F4A7C15ULL;  // 2^64 / golden ratio
  return mixed(state_);
}

double SeededRandom::uniform() {
  return static_cast<double>(bits() >> 11U) * 0x1.0p-53;  // 53 bits: all that a double holds
}

std::array<double, 2> SeededRandom::normalPair() {
  const double u = 1.0 - uniform();  // in (0, 1]: its logarithm is finite
  const double radius = std::sqrt(-2.0 * std::log(u));
  const double angle = 2.0 * kPi * uniform();
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace opp::mapping
