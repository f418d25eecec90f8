// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/primitives/primitives.h"

#include <cstdint>
#include <map>
#include <vector>

namespace opp::mapping {

/// What a scan's primitives look like from any pose: how often each distance occurs between planes
/// that face the same way, planes that face each other, and corners. Keys are kind and distance in
/// steps of a width; a distance counts for the two nearest steps, so that noise cannot move it out
/// of reach.
using Constellation = std::map<std::int64_t, int>;

/// O(planes² + corners²). \param width step of distances [m] > 0
Constellation constellationOf(const Primitives& primitives, double width);

/// Finds the keyframes of a map that a scan resembles most.
class ConstellationIndex {
 public:
  explicit ConstellationIndex(double width) : width_(width) {}

  /// Takes the next keyframe; ids count from 0.
  void add(const Primitives& primitives);
  int size() const { return static_cast<int>(entries_.size()); }

  /// Likeness of the scan to each keyframe, 0–1: shared distances weighted by rarity, as words of
  /// documents are (tf–idf with the cosine measure). O(distances of the scan · keyframes).
  std::vector<double> likeness(const Primitives& primitives) const;
  /// The at most `count` keyframes with most likeness above 0, best first.
  std::vector<int> mostAlike(const Primitives& primitives, int count) const;

 private:
  double rarity(std::int64_t word) const;

  double width_;
  std::vector<Constellation> entries_;
  std::map<std::int64_t, int> keyframes_with_;
};

}  // namespace opp::mapping
