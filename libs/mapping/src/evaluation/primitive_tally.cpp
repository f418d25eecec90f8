// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/evaluation/primitive_tally.h"

namespace opp::mapping {
namespace {

std::optional<double> ratio(std::size_t part, std::size_t whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

std::optional<double> PrimitiveTally::precision() const {
  return ratio(est_correct, est - est_neutral);
}

std::optional<double> PrimitiveTally::recall() const { return ratio(gt_found, gt); }

std::optional<double> PrimitiveTally::recallBySize() const {
  if (!(gt_size > 0.0)) return std::nullopt;
  return gt_size_found / gt_size;
}

void PrimitiveTally::add(const PrimitiveTally& other) {
  gt += other.gt;
  est += other.est;
  gt_found += other.gt_found;
  est_correct += other.est_correct;
  est_neutral += other.est_neutral;
  gt_size += other.gt_size;
  gt_size_found += other.gt_size_found;
  angles.insert(angles.end(), other.angles.begin(), other.angles.end());
  distances.insert(distances.end(), other.distances.begin(), other.distances.end());
  near_distances.insert(near_distances.end(), other.near_distances.begin(),
                        other.near_distances.end());
}

std::optional<double> OrthogonalityTally::falseRate() const { return ratio(wrong, checked); }

void OrthogonalityTally::add(const OrthogonalityTally& other) {
  claimed += other.claimed;
  checked += other.checked;
  wrong += other.wrong;
}

void PrimitiveTallies::add(const PrimitiveTallies& other) {
  maps += other.maps;
  planes.add(other.planes);
  lines.add(other.lines);
  corners.add(other.corners);
  orthogonality.add(other.orthogonality);
}

}  // namespace opp::mapping
