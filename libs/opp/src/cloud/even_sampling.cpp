// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/cloud/even_sampling.h"

#include "cloud/cell_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

std::size_t countCells(const std::vector<Eigen::Vector3f>& points, const Extent& extent,
                       double edge, std::size_t expected) {
  CellTable table(extent.low, edge, expected);
  for (const Eigen::Vector3f& p : points) {
    table.findOrInsert(table.cellOf(p.cast<double>()), 0);
  }
  return table.size();
}

/// Grows samples one entry at a time.
class Sampler {
 public:
  Sampler(const Extent& extent, double spacing, const SamplingParams& params)
      : spacing_(spacing),
        cos_merge_(static_cast<float>(std::cos(params.merge_angle))),
        gate_(params.gate),
        tilt_(std::tan(params.normal_error) * spacing),
        // A ball of radius `spacing` touches at most two cells of twice that edge per axis.
        table_(extent.low, 2.0 * spacing, static_cast<std::size_t>(params.target_samples)) {}

  void add(const Eigen::Vector3f& point, const Eigen::Vector3f& normal, float sigma, float weight) {
    const int sample = nearest(point, normal, sigma, weight);
    if (sample >= 0) {
      samples_[static_cast<std::size_t>(sample)].add(point, normal, sigma, weight);
    } else {
      insert(point, normal, sigma, weight);
    }
  }

  void write(OrientedCloud& out) const {
    for (const Sample& s : samples_) {
      const Eigen::Vector3d point = s.seed.cast<double>() + s.offset_sum / s.weight;
      const Eigen::Vector3d normal = s.normal_sum.normalized();
      // A mean of normals that all point to the viewpoint may point away where the view is grazing.
      const bool away = normal.dot(out.viewpoint.cast<double>() - point) < 0.0;
      out.points.push_back(point.cast<float>());
      out.normals.push_back((away ? Eigen::Vector3d(-normal) : normal).cast<float>());
      out.sigmas.push_back(static_cast<float>(std::sqrt(s.variance_sum / s.weight)));
      out.weights.push_back(static_cast<float>(s.weight));
    }
  }

 private:
  struct Sample {
    Eigen::Vector3f seed;    ///< its first entry: fixed, so that the cell it is found in is too
    Eigen::Vector3f normal;  ///< of its first entry
    Eigen::Vector3d offset_sum = Eigen::Vector3d::Zero();  ///< weighted, from the seed
    Eigen::Vector3d normal_sum = Eigen::Vector3d::Zero();
    double variance_sum = 0.0;
    double weight = 0.0;
    int next = -1;  ///< in the same cell

    void add(const Eigen::Vector3f& point, const Eigen::Vector3f& n, float sigma, float w) {
      offset_sum += static_cast<double>(w) * (point - seed).cast<double>();
      normal_sum += static_cast<double>(w) * n.cast<double>();
      variance_sum += static_cast<double>(w * sigma * sigma);
      weight += static_cast<double>(w);
    }
  };

  int nearest(const Eigen::Vector3f& point, const Eigen::Vector3f& normal, float sigma,
              float weight) const {
    const Eigen::Vector3d low = point.cast<double>() - Eigen::Vector3d::Constant(spacing_);
    const CellTable::Cell corner = table_.cellOf(low);
    auto best_distance = static_cast<float>(spacing_ * spacing_);
    int best = -1;
    for (int k = 0; k < 8; ++k) {
      const CellTable::Cell cell = corner + CellTable::Cell(k & 1, (k >> 1) & 1, k >> 2);
      for (int i = table_.find(cell); i >= 0; i = samples_[static_cast<std::size_t>(i)].next) {
        const Sample& sample = samples_[static_cast<std::size_t>(i)];
        // Along the surface: noise across it must not make samples.
        const Eigen::Vector3f step = point - sample.seed;
        const float across = sample.normal.dot(step);
        const float distance = step.squaredNorm() - across * across;
        if (distance < best_distance && sameSurface(sample, point, normal, sigma, weight)) {
          best_distance = distance;
          best = i;
        }
      }
    }
    return best;
  }

  bool sameSurface(const Sample& sample, const Eigen::Vector3f& point,
                   const Eigen::Vector3f& normal, float sigma, float weight) const {
    if (sample.normal.dot(normal) < cos_merge_) return false;
    const Eigen::Vector3d mean_to_point =
        (point - sample.seed).cast<double>() - sample.offset_sum / sample.weight;
    const Eigen::Vector3d direction = (sample.normal + normal).cast<double>().normalized();
    const double variance = static_cast<double>(sigma * sigma / weight) +
                            sample.variance_sum / (sample.weight * sample.weight);
    return std::abs(direction.dot(mean_to_point)) <= gate_ * std::sqrt(variance) + tilt_;
  }

  void insert(const Eigen::Vector3f& point, const Eigen::Vector3f& normal, float sigma,
              float weight) {
    const int index = static_cast<int>(samples_.size());
    const CellTable::Cell cell = table_.cellOf(point.cast<double>());
    Sample sample;
    sample.seed = point;
    sample.normal = normal;
    sample.next = table_.findOrInsert(cell, index);
    if (sample.next >= 0) table_.replace(cell, index);
    sample.add(point, normal, sigma, weight);
    samples_.push_back(sample);
  }

  double spacing_;
  float cos_merge_;
  double gate_;
  double tilt_;
  CellTable table_;
  std::vector<Sample> samples_;
};

}  // namespace

double spacingForCount(const std::vector<Eigen::Vector3f>& points, std::size_t target,
                       double minimum) {
  constexpr int kMaxSteps = 12;  // each about squares the error away; 3 are usual
  const Extent extent = extentOf(points);
  const double floor = std::max(minimum, smallestCell(extent));
  const double wanted =
      std::min(static_cast<double>(target), 0.9 * static_cast<double>(points.size()));
  if (!(extent.length > floor) || wanted < 1.0) return floor;
  double edge = std::max(floor, extent.length / std::sqrt(wanted));
  for (int step = 0; step < kMaxSteps; ++step) {
    const auto count =
        static_cast<double>(countCells(points, extent, edge, static_cast<std::size_t>(wanted)));
    const double factor = std::sqrt(count / wanted);
    if (std::abs(factor - 1.0) < 0.03 || (edge <= floor && factor < 1.0)) break;
    edge = std::max(floor, edge * factor);
  }
  return edge;
}

OrientedCloud sampleEvenly(const OrientedCloud& dense, double spacing,
                           const SamplingParams& params) {
  if (!(spacing > 0.0) || !std::isfinite(spacing)) {
    throw std::invalid_argument("the spacing of samples must be positive and finite");
  }
  OrientedCloud result;
  result.viewpoint = dense.viewpoint;
  const Extent extent = extentOf(dense.points);
  result.spacing = std::max(spacing, smallestCell(extent));
  Sampler sampler(extent, result.spacing, params);
  for (std::size_t i = 0; i < dense.size(); ++i) {
    sampler.add(dense.points[i], dense.normals[i], dense.sigmas[i], dense.weights[i]);
  }
  sampler.write(result);
  return result;
}

}  // namespace opp
