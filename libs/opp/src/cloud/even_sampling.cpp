// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/cloud/even_sampling.h"

#include "cloud/cell_table.h"
#include "cloud/seed_lists.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace opp {
namespace {

/// Smallest corner of the points' bounding box, and its largest edge.
struct Extent {
  Eigen::Vector3f low = Eigen::Vector3f::Zero();
  double length = 0.0;
};

Extent extentOf(const std::vector<Eigen::Vector3f>& points) {
  if (points.empty()) return {};
  Eigen::Vector3f low = points.front();
  Eigen::Vector3f high = points.front();
  for (const Eigen::Vector3f& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return {low, (high.cast<double>() - low.cast<double>()).maxCoeff()};
}

/// The shortest cell edge whose indices fit a CellTable, with room for a neighbour on each side.
double smallestCell(const Extent& extent) { return extent.length / ((1 << 21) - 4); }

std::size_t countCells(const std::vector<Eigen::Vector3f>& points, double edge, CellTable& table) {
  table.reset(edge);
  for (const Eigen::Vector3f& p : points) {
    table.findOrInsert(table.cellOf(p.cast<double>()), 0);
  }
  return table.size();
}

/// Grows samples one entry at a time.
class Sampler {
 public:
  /// Room for `expected` samples before memory has to grow.
  Sampler(const Extent& extent, double spacing, std::size_t expected, const SamplingParams& params)
      : spacing_(spacing),
        cos_merge_(static_cast<float>(std::cos(params.merge_angle))),
        gate_(params.gate),
        tilt_(std::tan(params.normal_error) * spacing),
        lists_(extent.low, spacing, expected) {
    seeds_.reserve(expected);
    sums_.reserve(expected);
  }

  /// Returns the sample that the entry joins.
  int add(const Eigen::Vector3f& point, const Eigen::Vector3f& normal, float sigma, float weight) {
    int sample = nearest(point, normal, sigma, weight);
    if (sample < 0) sample = insert(point, normal);
    const auto k = static_cast<std::size_t>(sample);
    const auto w = static_cast<double>(weight);
    sums_[k].offset += w * (point - seeds_[k].point).cast<double>();
    sums_[k].normal += w * normal.cast<double>();
    sums_[k].variance += w * static_cast<double>(sigma * sigma);
    sums_[k].weight += w;
    return sample;
  }

  void write(OrientedCloud& out) const {
    out.points.reserve(seeds_.size());
    out.normals.reserve(seeds_.size());
    out.sigmas.reserve(seeds_.size());
    out.weights.reserve(seeds_.size());
    for (std::size_t i = 0; i < seeds_.size(); ++i) {
      const Sums& s = sums_[i];
      const Eigen::Vector3d mean = seeds_[i].point.cast<double>() + s.offset / s.weight;
      const Eigen::Vector3f point = mean.cast<float>();
      const Eigen::Vector3d normal = s.normal.normalized();
      // A mean of normals that all point to the viewpoint may point away where the view is grazing,
      // and where coordinates are so large that rounding moves the point.
      const bool away = normal.dot((out.viewpoint - point).cast<double>()) < 0.0;
      out.points.push_back(point);
      out.normals.push_back((away ? Eigen::Vector3d(-normal) : normal).cast<float>());
      out.sigmas.push_back(static_cast<float>(std::sqrt(s.variance / s.weight)));
      out.weights.push_back(static_cast<float>(s.weight));
    }
  }

 private:
  /// First entry of a sample: fixed, so that the cell in which it is found is too.
  struct Seed {
    Eigen::Vector3f point;
    Eigen::Vector3f normal;
    int next;  ///< in the same list; −1: none
  };

  /// Weighted sums over the entries of a sample.
  struct Sums {
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< from the seed
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    double variance = 0.0;
    double weight = 0.0;
  };

  /// The sample that an entry joins; −1: none.
  int nearest(const Eigen::Vector3f& point, const Eigen::Vector3f& normal, float sigma,
              float weight) const {
    auto best_distance = static_cast<float>(spacing_ * spacing_);
    int best = -1;
    const SeedLists::Heads heads = lists_.near(point);
    for (int k = 0; k < heads.count; ++k) {
      for (int i = heads.first[static_cast<std::size_t>(k)]; i >= 0;
           i = seeds_[static_cast<std::size_t>(i)].next) {
        const float distance = distanceAlong(i, point);
        if (distance >= best_distance || !sameSurface(i, point, normal, sigma, weight)) continue;
        best_distance = distance;
        best = i;
      }
    }
    return best;
  }

  /// Squared distance from a seed along its surface: noise across it must not make samples.
  float distanceAlong(int sample, const Eigen::Vector3f& point) const {
    const Seed& seed = seeds_[static_cast<std::size_t>(sample)];
    const Eigen::Vector3f step = point - seed.point;
    const float across = seed.normal.dot(step);
    return step.squaredNorm() - across * across;
  }

  bool sameSurface(int sample, const Eigen::Vector3f& point, const Eigen::Vector3f& normal,
                   float sigma, float weight) const {
    const Seed& seed = seeds_[static_cast<std::size_t>(sample)];
    if (seed.normal.dot(normal) < cos_merge_) return false;
    const Sums& sums = sums_[static_cast<std::size_t>(sample)];
    const Eigen::Vector3d mean_to_point =
        (point - seed.point).cast<double>() - sums.offset / sums.weight;
    const Eigen::Vector3d direction = (seed.normal + normal).cast<double>().normalized();
    const double variance =
        static_cast<double>(sigma * sigma / weight) + sums.variance / (sums.weight * sums.weight);
    return std::abs(direction.dot(mean_to_point)) <= gate_ * std::sqrt(variance) + tilt_;
  }

  int insert(const Eigen::Vector3f& point, const Eigen::Vector3f& normal) {
    const int index = static_cast<int>(seeds_.size());
    seeds_.push_back({point, normal, lists_.push(point, index)});
    sums_.emplace_back();
    return index;
  }

  double spacing_;
  float cos_merge_;
  double gate_;
  double tilt_;
  SeedLists lists_;
  std::vector<Seed> seeds_;
  std::vector<Sums> sums_;
};

}  // namespace

double spacingForCount(const std::vector<Eigen::Vector3f>& points, std::size_t target,
                       double minimum) {
  constexpr int kMaxSteps = 12;  // 3 are usual
  constexpr double kTolerance = 0.05;
  const Extent extent = extentOf(points);
  const double floor = std::max(minimum, smallestCell(extent));
  const double wanted =
      std::min(static_cast<double>(target), 0.9 * static_cast<double>(points.size()));
  if (!(extent.length > floor) || wanted < 1.0) return floor;
  double edge = std::max(floor, extent.length / std::sqrt(wanted));
  CellTable table(extent.low, edge, static_cast<std::size_t>(wanted));
  for (int step = 0; step < kMaxSteps; ++step) {
    const auto count = static_cast<double>(countCells(points, edge, table));
    const double factor = std::sqrt(count / wanted);
    if (std::abs(factor - 1.0) < kTolerance || (edge <= floor && factor < 1.0)) break;
    edge = std::max(floor, edge * factor);
  }
  return edge;
}

OrientedCloud sampleEvenly(const OrientedCloud& dense, double spacing, const SamplingParams& params,
                           std::vector<int>* sample_of_entry) {
  if (!(spacing > 0.0) || !std::isfinite(spacing)) {
    throw std::invalid_argument("the spacing of samples must be positive and finite");
  }
  OrientedCloud result;
  result.viewpoint = dense.viewpoint;
  const Extent extent = extentOf(dense.points);
  result.spacing = std::max(spacing, smallestCell(extent));
  const auto target = static_cast<std::size_t>(params.target_samples);
  Sampler sampler(extent, result.spacing, std::min(dense.size(), target), params);
  if (sample_of_entry != nullptr) sample_of_entry->clear();
  for (std::size_t i = 0; i < dense.size(); ++i) {
    const int sample =
        sampler.add(dense.points[i], dense.normals[i], dense.sigmas[i], dense.weights[i]);
    if (sample_of_entry != nullptr) sample_of_entry->push_back(sample);
  }
  sampler.write(result);
  return result;
}

}  // namespace opp
