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
  /// `labels`: plane of each sample, −1: none. Fits, samples, sensor and parameters are kept by
  /// reference; fits may change, but not their number.
  SameSurface(const std::vector<PlaneFit>& fits, const std::vector<WeightedSample>& samples,
              const std::vector<int>& labels, const Eigen::Vector3d& viewpoint,
              const SensorModel& sensor, const RefinementParams& params);

  /// Planes number `a` and `b`. O(1) where one plane does not fit both within noise and distortion,
  /// else O(n log n) for n samples of the two.
  bool operator()(std::size_t a, std::size_t b) const;

  /// From now on the samples of `part` count as samples of `whole`.
  void merge(std::size_t part, std::size_t whole);

 private:
  bool goesOn(std::size_t a, std::size_t b, const Eigen::Vector3d& normal, double step) const;

  const std::vector<PlaneFit>& fits_;
  const std::vector<WeightedSample>& samples_;
  Eigen::Vector3d viewpoint_;
  const SensorModel& sensor_;
  const RefinementParams& params_;
  std::vector<std::vector<std::uint32_t>> members_;  ///< samples that count for each plane
};

}  // namespace opp
