// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/registration/plane_samples.h"

#include "opp/cloud/rim_error.h"

#include <Eigen/Eigenvalues>

namespace opp::mapping {
namespace {

/// Variance of a plane's offset that patches of `squared_extent` at its rims cause [m²].
double rimVariance(const PointMoments& moments, double squared_extent) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(moments.scatter(),
                                                            Eigen::EigenvaluesOnly);
  const double shift = rimError(squared_extent, axes.eigenvalues()[1] / moments.weight()).shift;
  return shift * shift;
}

}  // namespace

float sampleVariance(const OrientedCloud& cloud, std::size_t sample, const SensorModel& sensor) {
  const double sigma = sensor.withCorrelation(cloud.noise_correlation)
                           .meanSigma(static_cast<double>(cloud.sigmas[sample]),
                                      static_cast<double>(cloud.weights[sample]));
  return static_cast<float>(sigma * sigma);
}

double effectiveCount(double count, const SensorModel& sensor) {
  return count > 0.0 ? 1.0 / sensor.meanVariance(count) : 0.0;
}

std::vector<PlaneSamples> planeSamples(const ScanFeatures& scan, const SensorModel& sensor) {
  std::vector<PlaneSamples> planes(scan.primitives_in_body.planes.size());
  std::vector<double> patch_areas(planes.size());
  const OrientedCloud& cloud = scan.cloud_in_body;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const int label = scan.primitives_in_body.labels[i];
    if (label < 0) continue;
    PlaneSamples& plane = planes[static_cast<std::size_t>(label)];
    plane.moments_in_body.add(cloud.points[i].cast<double>(),
                              1.0 / sampleVariance(cloud, i, sensor));
    plane.effective_count += 1.0;
    patch_areas[static_cast<std::size_t>(label)] += cloud.patchExtent(i) * cloud.patchExtent(i);
  }
  for (std::size_t k = 0; k < planes.size(); ++k) {
    PlaneSamples& plane = planes[k];
    const double count = plane.effective_count;
    if (count == 0.0) continue;
    plane.effective_count = effectiveCount(count, sensor);
    plane.moments_in_body.scaleWeights(plane.effective_count / count);
    const double rim = rimVariance(plane.moments_in_body, patch_areas[k] / count);
    const double share = 1.0 / (1.0 + plane.moments_in_body.weight() * rim);
    plane.moments_in_body.scaleWeights(share);
    plane.effective_count *= share;
  }
  return planes;
}

}  // namespace opp::mapping
