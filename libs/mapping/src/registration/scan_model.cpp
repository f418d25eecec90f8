// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "registration/scan_model.h"

#include "registration/normal_space_sampling.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace opp::mapping {
namespace {

std::vector<PlaneDirection> directionsOf(const std::vector<PlanePrimitive>& planes,
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
      return d.normal.dot(normal) > min_cosine;
    });
    if (same == directions.end()) same = directions.insert(same, PlaneDirection{});
    same->normal = (same->area * same->normal + area(p) * normal).normalized();
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

ScanModel::ScanModel(const ScanFeatures& scan, const GlobalAlignmentParams& params)
    : features(scan),
      directions(directionsOf(scan.primitives_in_body.planes, params)),
      voxels(scan.cloud_in_body, params.cell_ratio * scan.cloud_in_body.spacing),
      depth(scan.cloud_in_body),
      samples(sampleNormalSpace(scan.cloud_in_body, static_cast<std::size_t>(params.samples))),
      screening_samples(spread(sampleNormalSpace(
          scan.cloud_in_body, static_cast<std::size_t>(params.screening_samples)))) {}

Plane ScanModel::surfaceAt(std::uint32_t sample) const {
  const int label = labelOf(sample);
  if (label >= 0) return primitives().planes[static_cast<std::size_t>(label)].plane;
  return Plane::fromPointNormal(cloud().points[sample].cast<double>(),
                                cloud().normals[sample].cast<double>());
}

}  // namespace opp::mapping
