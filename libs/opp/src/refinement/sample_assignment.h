// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/geometry/plane.h"
#include "opp/geometry/point_cloud.h"
#include "opp/geometry/point_moments.h"
#include "opp/refinement/refinement_params.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace opp {

/// A sample as the passes need it.
struct WeightedSample {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;
  double variance;    ///< of its offset: of n raw points whose errors are correlated [m²]
  double area;        ///< [m²] of the surface that it stands for
  double patch_area;  ///< [m²] of one of the patches that it is the mean of
};

std::vector<WeightedSample> weightedSamples(const OrientedCloud& cloud, const SensorModel& sensor);

/// The samples of each of `planes` planes, ascending, from the plane of each sample (−1: none).
std::vector<std::vector<std::uint32_t>> membersOf(const std::vector<int>& labels,
                                                  std::size_t planes);

/// Sums over the samples of a plane; ω is Tukey's weight in (0, 1].
struct SampleSums {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of the coordinates below, near the mean
  double weight = 0.0;                               ///< Σ w, w = ω / variance [1/m²]
  Eigen::Vector3d first = Eigen::Vector3d::Zero();   ///< Σ w x
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  ///< Σ w x xᵀ, lower triangle
  double robust_weight = 0.0;                        ///< Σ ω
  double square_sum = 0.0;                           ///< Σ ω r² [m²]
  double variance_sum = 0.0;                         ///< Σ ω × variance of the sample [m²]
  double area = 0.0;                                 ///< of all samples [m²]
  double patch_area = 0.0;                           ///< Σ of the samples' patch_area [m²]
  int support = 0;                                   ///< samples

  PointMoments moments() const;
  void merge(const SampleSums& other);
  /// Adds a sample at `distance` from the plane [m]; false if it is an outlier. `weight_slope`:
  /// 1/c² of Tukey's weight (1 − r²/c²)².
  bool add(const WeightedSample& sample, double distance, double squared_slack,
           double weight_slope) {
    const double precision = 1.0 / (sample.variance + squared_slack);
    const double square = distance * distance;
    const double root = 1.0 - square * precision * weight_slope;
    if (!(root > 0.0)) return false;
    const double robust = root * root, w = robust * precision;
    // Number by number: vectors would be stored in parts and loaded whole, which stalls the loop.
    const double x = sample.point[0] - origin[0], y = sample.point[1] - origin[1],
                 z = sample.point[2] - origin[2];
    const double wx = w * x, wy = w * y, wz = w * z;
    weight += w;
    first[0] += wx, first[1] += wy, first[2] += wz;
    second(0, 0) += wx * x, second(1, 0) += wy * x, second(2, 0) += wz * x;
    second(1, 1) += wy * y, second(2, 1) += wz * y, second(2, 2) += wz * z;
    robust_weight += robust;
    square_sum += robust * square;
    variance_sum += robust * sample.variance;
    area += sample.area;
    patch_area += sample.patch_area;
    ++support;
    return true;
  }
  /// Mean variance that the sensor's noise explains [m²].
  double meanVariance() const { return robust_weight > 0.0 ? variance_sum / robust_weight : 0.0; }
  double meanSquare() const { return robust_weight > 0.0 ? square_sum / robust_weight : 0.0; }
  /// Standard deviation of the residuals beyond the sensor's noise [m]; 0 if it could be chance.
  double excess(double outlier_cutoff) const;
};

/// A plane under refinement and what its samples add up to.
struct PlaneFit {
  Plane plane;
  double slack = 0.0;  ///< [m] misfit beyond the sensor's noise; gates are wide while it is large
  SampleSums sums;
  PointMoments moments;       ///< of the sums
  bool rests = false;         ///< the last step hardly moved it
  bool curved = false;        ///< its samples' normals say that it is no plane
  bool uncertain = false;     ///< its direction is not known
  Eigen::AlignedBox3d reach;  ///< where its samples can be

  /// What the samples say about the normal, as a scatter matrix [1/rad²] about `normal`. What the
  /// rims turn a strip by (RimError) counts as a standard deviation.
  Eigen::Matrix3d information(const Eigen::Vector3d& normal) const;
};

struct Candidates;

/// Gives every sample that `candidates` names to a plane whose normal agrees, if it is no outlier
/// there, and sums it up in that plane's fit (IV-b (1), (2)): to the nearest of the first group
/// (the one with most support) that explains it, so that no small plane grows askew into a large
/// one; else to the nearest of all. Labels of the other samples stay. A plane that rests, as all
/// its rivals do, keeps its samples and sums.
void assignSamples(const std::vector<WeightedSample>& samples, const Candidates& candidates,
                   const RefinementParams& params, std::vector<PlaneFit>& fits,
                   std::vector<int>& labels);

}  // namespace opp
