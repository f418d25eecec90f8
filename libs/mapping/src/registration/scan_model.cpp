// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "registration/scan_model.h"

#include "opp/mapping/registration/plane_samples.h"

#include "registration/normal_space_sampling.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace opp::mapping {
namespace {

std::vector<PlaneDirection> directionsOf(const std::vector<PlanePrimitive>& planes, bool sided,
                                         const GlobalAlignmentParams& params) {
  std::vector<int> by_area(planes.size());
  std::iota(by_area.begin(), by_area.end(), 0);
  const auto area = [&](int p) { return planes[static_cast<std::size_t>(p)].area; };
  std::stable_sort(by_area.begin(), by_area.end(), [&](int a, int b) { return area(a) > area(b); });

  const double min_cosine = std::cos(params.direction_tolerance);
  std::vector<PlaneDirection> directions;
  for (const int p : by_area) {
    const Eigen::Vector3d& normal = planes[static_cast<std::size_t>(p)].plane.normal();
    auto same = std::find_if(directions.begin(), directions.end(), [&](const PlaneDirection& d) {
      const double cosine = d.normal.dot(normal);
      return (sided ? cosine : std::abs(cosine)) > min_cosine;
    });
    if (same == directions.end()) same = directions.insert(same, PlaneDirection{});
    const double sign = same->normal.dot(normal) < 0.0 ? -1.0 : 1.0;
    same->normal = (same->area * same->normal + sign * area(p) * normal).normalized();
    same->area += area(p);
    same->planes.push_back(p);
  }
  std::stable_sort(
      directions.begin(), directions.end(),
      [](const PlaneDirection& a, const PlaneDirection& b) { return a.area > b.area; });
  const auto kept = std::min(directions.size(), static_cast<std::size_t>(params.max_directions));
  directions.resize(kept);
  return directions;
}

/// The same indices in an order whose every part is spread over all: steps of the golden section.
std::vector<std::uint32_t> spread(const std::vector<std::uint32_t>& indices) {
  const std::size_t count = indices.size();
  std::size_t step = std::max<std::size_t>(1, static_cast<std::size_t>(0.618 * double(count)));
  while (std::gcd(step, count) != 1) ++step;
  std::vector<std::uint32_t> result;
  for (std::size_t k = 0; k < count; ++k) result.push_back(indices[k * step % count]);
  return result;
}

}  // namespace

ScanModel::ScanModel(const AlignmentInput& input, const SensorModel& sensor_model,
                     const GlobalAlignmentParams& params)
    : features(*input.features),
      sided(input.sided),
      area(static_cast<double>(cloud().size()) * cloud().spacing * cloud().spacing),
      sensor(sensor_model),
      directions(directionsOf(primitives().planes, input.sided, params)),
      voxels(cloud(), params.cell_ratio * cloud().spacing, input.sided),
      free_space(input.views),
      samples(sampleNormalSpace(cloud(), static_cast<std::size_t>(params.samples))),
      screening_samples(
          spread(sampleNormalSpace(cloud(), static_cast<std::size_t>(params.screening_samples)))) {
  sigmas.reserve(cloud().size());
  for (std::size_t i = 0; i < cloud().size(); ++i) {
    sigmas.push_back(std::sqrt(sampleVariance(cloud(), i, sensor)));
  }
}

Plane ScanModel::surfaceAt(std::uint32_t sample) const {
  const int label = labelOf(sample);
  if (label >= 0) return primitives().planes[static_cast<std::size_t>(label)].plane;
  return Plane::fromPointNormal(cloud().points[sample].cast<double>(),
                                cloud().normals[sample].cast<double>());
}

}  // namespace opp::mapping
