// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "registration/match_input.h"

#include "opp/mapping/registration/plane_samples.h"

#include "registration/normal_space_sampling.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace opp::mapping {

std::vector<ScanPoint> scanPoints(const ScanFeatures& scan, const SensorModel& sensor,
                                  const RegistrationParams& params) {
  const OrientedCloud& cloud = scan.cloud_in_body;
  std::vector<ScanPoint> points;
  std::map<int, double> counts;
  const std::size_t narrow = cloud.size() - cloud.narrow_samples;
  const double doubt = params.narrow_caution * params.narrow_caution;
  for (const std::uint32_t i :
       sampleNormalSpace(cloud, static_cast<std::size_t>(params.max_points))) {
    const int label = scan.primitives_in_body.labels[i];
    const double variance = (i < narrow ? 1.0 : doubt) * sampleVariance(cloud, i, sensor);
    points.push_back({cloud.points[i], cloud.normals[i], static_cast<float>(variance), label, 1.0});
    counts[label] += 1.0;
  }
  for (ScanPoint& p : points) p.worth = effectiveCount(counts[p.label], sensor) / counts[p.label];
  return points;
}

std::vector<ScanPoint> rimPoints(const ScanFeatures& scan, const SensorModel& sensor) {
  const Rims& rims = scan.rims_in_body;
  const auto count = static_cast<double>(rims.size());
  std::vector<ScanPoint> points;
  for (std::size_t i = 0; i < rims.size(); ++i) {
    points.push_back({rims.points[i], rims.normals[i], rims.sigmas[i] * rims.sigmas[i], -1,
                      effectiveCount(count, sensor) / count});
  }
  return points;
}

double rmsRange(const std::vector<ScanPoint>& points) {
  double sum = 0.0;
  for (const ScanPoint& p : points) sum += p.point_in_body.squaredNorm();
  return std::sqrt(sum / std::max<double>(1.0, static_cast<double>(points.size())));
}

std::vector<ScanPlane> scanPlanes(const ScanFeatures& scan, const SensorModel& sensor) {
  std::vector<ScanPlane> planes;
  for (const PlaneSamples& samples : planeSamples(scan, sensor)) {
    planes.push_back(
        {samples.moments_in_body.factor(), samples.moments_in_body, samples.effective_count, -1});
  }
  return planes;
}

}  // namespace opp::mapping
