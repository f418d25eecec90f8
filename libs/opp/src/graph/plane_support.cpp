// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "graph/plane_support.h"

#include "opp/graph/union_find.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace opp {
namespace {

/// A sample's cell in the plane's grid; ordered row by row.
struct Cell {
  std::int64_t row, column;
  bool operator<(const Cell& other) const {
    return row != other.row ? row < other.row : column < other.column;
  }
  bool operator==(const Cell& other) const { return row == other.row && column == other.column; }
};

Eigen::Vector3d pointOf(const OrientedCloud& cloud, int i) {
  return cloud.points[static_cast<std::size_t>(i)].cast<double>();
}

/// Joins each cell of the sorted list with its neighbours in this and the previous row.
UnionFind connect(const std::vector<Cell>& cells) {
  UnionFind sets(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Cell& cell = cells[i];
    if (i > 0 && cells[i - 1].row == cell.row && cells[i - 1].column + 1 == cell.column) {
      sets.join(i - 1, i);
    }
    const Cell above_left{cell.row - 1, cell.column - 1};
    auto above = std::lower_bound(cells.begin(), cells.end(), above_left);
    for (; above != cells.end() && above->row == cell.row - 1 && above->column <= cell.column + 1;
         ++above) {
      sets.join(static_cast<std::size_t>(above - cells.begin()), i);
    }
  }
  return sets;
}

/// Second moments of plane coordinates.
struct Spread {
  double count = 0.0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();

  void add(const Eigen::Vector2d& x) {
    count += 1.0;
    sum += x;
    squares += x * x.transpose();
  }
  /// A rectangle of width w has variance w²/12.
  double width() const {
    const Eigen::Vector2d mean = sum / count;
    const Eigen::Matrix2d covariance = squares / count - mean * mean.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(covariance, Eigen::EigenvaluesOnly);
    return std::sqrt(12.0 * std::max(0.0, eigen.eigenvalues()[0]));
  }
};

/// Coordinates along the common line, in units of `cell`, of the samples within `reach` of it:
/// sorted, each cell once.
std::vector<std::int64_t> cellsAlongLine(const OrientedCloud& cloud,
                                         const std::vector<int>& samples, const Plane& other,
                                         const Eigen::Vector3d& direction, double reach,
                                         double cell) {
  std::vector<std::int64_t> cells;
  for (const int i : samples) {
    const Eigen::Vector3d x = pointOf(cloud, i);
    if (std::abs(other.signedDistance(x)) > reach) continue;
    cells.push_back(static_cast<std::int64_t>(std::floor(direction.dot(x) / cell)));
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

/// Number of cells of `cells` that lie in or beside a cell of `others`: the spacing of samples is
/// not exactly regular.
std::size_t countNear(const std::vector<std::int64_t>& cells,
                      const std::vector<std::int64_t>& others) {
  std::size_t count = 0;
  auto other = others.begin();
  for (const std::int64_t cell : cells) {
    while (other != others.end() && *other < cell - 1) ++other;
    if (other != others.end() && *other <= cell + 1) ++count;
  }
  return count;
}

}  // namespace

SampleAssigner::SampleAssigner(const OrientedCloud& cloud, const SensorModel& sensor,
                               const GraphParams& params)
    : cloud_(cloud),
      blocks_(cloud.points),
      cos_normal_gate_(static_cast<float>(std::cos(params.normal_gate))) {
  const auto count = static_cast<Eigen::Index>(cloud.size());
  points_.resize(count, 3);
  normals_.resize(count, 3);
  gates_.resize(count);
  weights_.reserve(cloud.size());
  const SensorModel shown = sensor.withCorrelation(cloud.noise_correlation);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double sigma = shown.meanSigma(static_cast<double>(cloud.sigmas[i]),
                                         static_cast<double>(cloud.weights[i]));
    weights_.push_back(1.0 / (sigma * sigma));
  }
  for (Eigen::Index row = 0; row < count; ++row) {
    const std::size_t i = blocks_.order()[static_cast<std::size_t>(row)];
    points_.row(row) = cloud.points[i].transpose();
    normals_.row(row) = cloud.normals[i].transpose();
    const double gate =
        params.noise_gate / std::sqrt(weights_[i]) + params.flatness * cloud.extent(i);
    largest_gate_ = std::max(largest_gate_, gate);
    gates_[row] = static_cast<float>(gate);
  }
}

template <typename Visit>
void SampleAssigner::forEachCandidate(const LocalPlane& local, const Visit& visit) const {
  const float *x = points_.col(0).data(), *y = points_.col(1).data(), *z = points_.col(2).data();
  const float *nx = normals_.col(0).data(), *ny = normals_.col(1).data(),
              *nz = normals_.col(2).data();
  const Eigen::Vector4f coefficients = local.plane.coefficients().cast<float>();
  const Eigen::Vector3f low = local.reach.min(), high = local.reach.max();
  const float a = coefficients[0], b = coefficients[1], c = coefficients[2], d = coefficients[3];
  blocks_.visitNear(
      local.plane, local.reach, largest_gate_, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const float distance = std::abs(a * x[i] + b * y[i] + c * z[i] + d);
          const float cosine = std::abs(a * nx[i] + b * ny[i] + c * nz[i]);
          const bool inside = (x[i] >= low.x()) & (x[i] <= high.x()) & (y[i] >= low.y()) &
                              (y[i] <= high.y()) & (z[i] >= low.z()) & (z[i] <= high.z());
          visit(i, distance, inside & (cosine > cos_normal_gate_));
        }
      });
}

std::vector<int> SampleAssigner::inCloudOrder(const std::vector<int>& labels) const {
  std::vector<int> result(labels.size());
  for (std::size_t row = 0; row < labels.size(); ++row) {
    result[blocks_.order()[row]] = labels[row];
  }
  return result;
}

std::vector<int> SampleAssigner::assign(const std::vector<LocalPlane>& planes) const {
  std::vector<int> labels(static_cast<std::size_t>(gates_.size()), -1);
  std::vector<float> nearest(gates_.data(), gates_.data() + gates_.size());
  for (std::size_t p = 0; p < planes.size(); ++p) {
    const int plane = static_cast<int>(p);
    forEachCandidate(planes[p], [&](std::size_t i, float distance, bool parallel) {
      const bool nearer = parallel & (distance < nearest[i]);
      nearest[i] = nearer ? distance : nearest[i];
      labels[i] = nearer ? plane : labels[i];
    });
  }
  return inCloudOrder(labels);
}

std::vector<int> SampleAssigner::assignToFirst(const std::vector<LocalPlane>& planes) const {
  std::vector<int> labels(static_cast<std::size_t>(gates_.size()), -1);
  const float* gates = gates_.data();
  for (std::size_t p = planes.size(); p-- > 0;) {
    const int plane = static_cast<int>(p);
    forEachCandidate(planes[p], [&](std::size_t i, float distance, bool parallel) {
      labels[i] = parallel & (distance < gates[i]) ? plane : labels[i];
    });
  }
  return inCloudOrder(labels);
}

std::vector<PointMoments> SampleAssigner::moments(const std::vector<int>& labels,
                                                  std::size_t planes) const {
  std::vector<PointMoments> moments(planes);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] < 0) continue;
    moments[static_cast<std::size_t>(labels[i])].add(cloud_.points[i].cast<double>(), weights_[i]);
  }
  return moments;
}

SupportPatch leastSupport(const OrientedCloud& cloud, const GraphParams& params) {
  return cloud.extents.empty() ? SupportPatch{params.min_area, params.min_width}
                               : SupportPatch{params.detail_min_area, params.detail_min_width};
}

double meanExtent(const OrientedCloud& cloud, const std::vector<int>& samples) {
  double sum = 0.0;
  for (const int i : samples) sum += cloud.extent(static_cast<std::size_t>(i));
  return samples.empty() ? 0.0 : sum / static_cast<double>(samples.size());
}

SupportPatch largestPatch(const OrientedCloud& cloud, const Plane& plane,
                          const std::vector<int>& samples) {
  if (samples.empty()) return {};
  const Eigen::Matrix<double, 3, 2> tangents = tangentBasis(plane.normal());
  const Eigen::Vector3d origin = pointOf(cloud, samples.front());
  const double extent = meanExtent(cloud, samples);
  const double cell = 2.0 * extent;
  std::vector<Eigen::Vector2d> coordinates;
  std::vector<Cell> cell_of, cells;
  for (const int i : samples) {
    coordinates.emplace_back(tangents.transpose() * (pointOf(cloud, i) - origin));
    // Samples without an extent all lie at one point.
    const Eigen::Array2d index = cell > 0.0
                                     ? Eigen::Array2d((coordinates.back().array() / cell).floor())
                                     : Eigen::Array2d::Zero();
    cell_of.push_back({static_cast<std::int64_t>(index[0]), static_cast<std::int64_t>(index[1])});
  }
  cells = cell_of;
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  UnionFind sets = connect(cells);
  std::vector<Spread> spreads(cells.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const auto found = std::lower_bound(cells.begin(), cells.end(), cell_of[k]);
    spreads[sets.root(static_cast<std::size_t>(found - cells.begin()))].add(coordinates[k]);
  }
  const auto largest =
      std::max_element(spreads.begin(), spreads.end(),
                       [](const Spread& a, const Spread& b) { return a.count < b.count; });
  return {largest->count, largest->width() / extent};
}

double commonEdgeLength(const OrientedCloud& cloud, const EdgeSide& a, const EdgeSide& b,
                        double reach) {
  const Eigen::Vector3d cross = a.plane.normal().cross(b.plane.normal());
  if (cross.norm() < std::numeric_limits<double>::epsilon()) return 0.0;
  const Eigen::Vector3d direction = cross.normalized();
  const double cell = std::max(a.spacing, b.spacing);
  const auto cells_a =
      cellsAlongLine(cloud, a.samples, b.plane, direction, reach * a.spacing, cell);
  const auto cells_b =
      cellsAlongLine(cloud, b.samples, a.plane, direction, reach * b.spacing, cell);
  return static_cast<double>(std::min(countNear(cells_a, cells_b), countNear(cells_b, cells_a)));
}

}  // namespace opp
