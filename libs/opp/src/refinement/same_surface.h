// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/refinement/refinement_params.h"

#include "refinement/sample_assignment.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace opp {

/// Tells whether two planes under refinement are one surface: one that nearest-plane assignment cut
/// in two, or one that the sensor's distortion bends, so that pieces of it fit planes of their own.
/// A bent surface goes on where its pieces adjoin; a layer upon another steps there.
class SameSurface {
 public:
  /// `labels`: plane of each sample, −1: none. All are kept by reference.
  SameSurface(const std::vector<WeightedSample>& samples, const std::vector<int>& labels,
              const Eigen::Vector3d& viewpoint, const SensorModel& sensor,
              const RefinementParams& params, std::size_t planes);

  /// `a`, `b`: the fits of planes number `index_a`, `index_b`. O(1) for planes that one plane does
  /// not fit within noise and distortion, else O(n log n) in their samples.
  bool operator()(const PlaneFit& a, std::size_t index_a, const PlaneFit& b,
                  std::size_t index_b) const;

  /// From now on the samples of `part` count as samples of `whole`.
  void merge(std::size_t part, std::size_t whole);

 private:
  bool goesOn(std::size_t a, std::size_t b, const Eigen::Vector3d& normal, double step) const;

  const std::vector<WeightedSample>& samples_;
  Eigen::Vector3d viewpoint_;
  const SensorModel& sensor_;
  const RefinementParams& params_;
  std::vector<std::vector<std::uint32_t>> members_;  ///< samples of each plane
};

}  // namespace opp
