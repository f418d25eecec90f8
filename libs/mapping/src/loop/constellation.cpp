// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/constellation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace opp::mapping {
namespace {

enum class Kind : std::int64_t { kSameSide, kFacing, kCorners };
constexpr std::int64_t kKinds = 3;

void count(Kind kind, double distance, double width, Constellation& words) {
  const auto step = static_cast<std::int64_t>(std::floor(distance / width - 0.5));
  for (const std::int64_t s : {step, step + 1}) {
    if (s >= 0) ++words[s * kKinds + static_cast<std::int64_t>(kind)];
  }
}

}  // namespace

Constellation constellationOf(const Primitives& primitives, double width) {
  Constellation words;
  // Families are tested for parallelism; the planes of one have the same normal or its opposite.
  for (const ParallelFamily& family : primitives.families) {
    for (std::size_t i = 0; i < family.planes.size(); ++i) {
      for (std::size_t j = i + 1; j < family.planes.size(); ++j) {
        const Plane& a = primitives.planes[static_cast<std::size_t>(family.planes[i])].plane;
        const Plane& b = primitives.planes[static_cast<std::size_t>(family.planes[j])].plane;
        const bool same_side = a.normal().dot(b.normal()) > 0.0;
        count(same_side ? Kind::kSameSide : Kind::kFacing,
              std::abs(same_side ? a.d() - b.d() : a.d() + b.d()), width, words);
      }
    }
  }
  for (std::size_t i = 0; i < primitives.corners.size(); ++i) {
    for (std::size_t j = i + 1; j < primitives.corners.size(); ++j) {
      count(Kind::kCorners,
            (primitives.corners[i].position - primitives.corners[j].position).norm(), width, words);
    }
  }
  return words;
}

void ConstellationIndex::add(const Primitives& primitives) {
  entries_.push_back(constellationOf(primitives, width_));
  for (const auto& [word, times] : entries_.back()) ++keyframes_with_[word];
}

double ConstellationIndex::rarity(std::int64_t word) const {
  const auto known = keyframes_with_.find(word);
  const double times = known == keyframes_with_.end() ? 0.0 : known->second;
  return std::log((1.0 + static_cast<double>(entries_.size())) / (1.0 + times)) + 1.0;
}

std::vector<double> ConstellationIndex::likeness(const Primitives& primitives) const {
  const Constellation scan = constellationOf(primitives, width_);
  double scan_square = 0.0;
  for (const auto& [word, times] : scan) scan_square += std::pow(times * rarity(word), 2);
  std::vector<double> result;
  for (const Constellation& entry : entries_) {
    double product = 0.0, square = 0.0;
    for (const auto& [word, times] : entry) {
      const double weight = rarity(word);
      square += std::pow(times * weight, 2);
      const auto shared = scan.find(word);
      if (shared != scan.end()) product += times * shared->second * weight * weight;
    }
    result.push_back(product > 0.0 ? product / std::sqrt(square * scan_square) : 0.0);
  }
  return result;
}

std::vector<int> ConstellationIndex::mostAlike(const Primitives& primitives, int count) const {
  const std::vector<double> scores = likeness(primitives);
  std::vector<int> ids(scores.size());
  std::iota(ids.begin(), ids.end(), 0);
  std::stable_sort(ids.begin(), ids.end(), [&](int a, int b) {
    return scores[static_cast<std::size_t>(a)] > scores[static_cast<std::size_t>(b)];
  });
  ids.erase(std::remove_if(ids.begin(), ids.end(),
                           [&](int k) { return scores[static_cast<std::size_t>(k)] <= 0.0; }),
            ids.end());
  if (ids.size() > static_cast<std::size_t>(count)) ids.resize(static_cast<std::size_t>(count));
  return ids;
}

}  // namespace opp::mapping
