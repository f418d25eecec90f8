// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/registration/plane_samples.h"

namespace opp::mapping {

float sampleVariance(const OrientedCloud& cloud, std::size_t sample, const SensorModel& sensor) {
  const double sigma = sensor.withCorrelation(cloud.noise_correlation)
                           .meanSigma(static_cast<double>(cloud.sigmas[sample]),
                                      static_cast<double>(cloud.weights[sample]));
  return static_cast<float>(sigma * sigma);
}

double effectiveCount(double count, const SensorModel& sensor) {
  return count > 0.0 ? count / (1.0 + (count - 1.0) * sensor.noise_correlation) : 0.0;
}

std::vector<PlaneSamples> planeSamples(const ScanFeatures& scan, const SensorModel& sensor) {
  std::vector<PlaneSamples> planes(scan.primitives_in_body.planes.size());
  const OrientedCloud& cloud = scan.cloud_in_body;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const int label = scan.primitives_in_body.labels[i];
    if (label < 0) continue;
    PlaneSamples& plane = planes[static_cast<std::size_t>(label)];
    plane.moments_in_body.add(cloud.points[i].cast<double>(),
                              1.0 / sampleVariance(cloud, i, sensor));
    plane.effective_count += 1.0;
  }
  for (PlaneSamples& plane : planes) {
    const double effective_count = effectiveCount(plane.effective_count, sensor);
    if (plane.effective_count > 0.0) {
      plane.moments_in_body.scaleWeights(effective_count / plane.effective_count);
    }
    plane.effective_count = effective_count;
  }
  return planes;
}

}  // namespace opp::mapping
