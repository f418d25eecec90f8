// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/primitives/label_points.h"

#include "cloud/cell_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace opp {
namespace {

/// A plane that has samples in a cell of space; the planes of a cell form a list.
struct PlaneInCell {
  int plane;
  int next;  ///< −1: last
};

/// Which planes have samples near a place. Cells are as large as samples reach: three spacings, the
/// width of the margin without normals that windows leave at edges.
class PlanesNearby {
 public:
  explicit PlanesNearby(const OrientedCloud& samples, const std::vector<int>& labels)
      : reach_(kReach * samples.spacing), table_(lowest(samples), reach_, samples.size()) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (labels[i] >= 0) add(table_.cellOf(samples.points[i].cast<double>()), labels[i]);
    }
  }

  /// Calls f(plane) for each plane with a sample in the cells within reach; some more than once.
  template <typename F>
  void visit(const Eigen::Vector3d& point, const F& f) const {
    // Half a cell to each side: at most two cells per axis.
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * reach_);
    const CellTable::Cell low = table_.cellOf(point - half);
    for (int k = 0; k < 8; ++k) {
      const CellTable::Cell cell = low + CellTable::Cell(k & 1, (k >> 1) & 1, k >> 2);
      for (int i = table_.find(cell); i >= 0; i = planes_[static_cast<std::size_t>(i)].next) {
        f(planes_[static_cast<std::size_t>(i)].plane);
      }
    }
  }

 private:
  static constexpr double kReach = 3.0;

  static Eigen::Vector3f lowest(const OrientedCloud& samples) {
    Eigen::Vector3f low = samples.size() > 0 ? samples.points.front() : Eigen::Vector3f::Zero();
    for (const Eigen::Vector3f& point : samples.points) low = low.cwiseMin(point);
    return low;
  }

  void add(const CellTable::Cell& cell, int plane) {
    const int index = static_cast<int>(planes_.size());
    const int first = table_.findOrInsert(cell, index);
    for (int i = first; i >= 0; i = planes_[static_cast<std::size_t>(i)].next) {
      if (planes_[static_cast<std::size_t>(i)].plane == plane) return;
    }
    if (first >= 0) table_.replace(cell, index);
    planes_.push_back({plane, first});
  }

  double reach_;
  CellTable table_;
  std::vector<PlaneInCell> planes_;
};

}  // namespace

std::vector<int> labelPoints(const PointCloud& cloud, const OrientedCloud& samples,
                             const Primitives& primitives, const PrimitiveParams& params) {
  if (primitives.labels.size() != samples.size()) {
    throw std::invalid_argument("primitives need one label per sample");
  }
  std::vector<int> labels(cloud.size(), -1);
  if (samples.size() == 0 || !(samples.spacing > 0.0)) return labels;
  const PlanesNearby nearby(samples, primitives.labels);
  const Eigen::Vector3d viewpoint = cloud.viewpoint.cast<double>();
  const double slack = params.graph.flatness * samples.spacing;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.points[i].allFinite()) continue;
    const Eigen::Vector3d point = cloud.points[i].cast<double>();
    const double range = (point - viewpoint).norm();
    if (range < params.sensor.min_range || range > params.sensor.max_range) continue;
    double best = 1.0;
    nearby.visit(point, [&](int candidate) {
      const Plane& plane = primitives.planes[static_cast<std::size_t>(candidate)].plane;
      const double cosine = range > 0.0 ? plane.signedDistance(viewpoint) / range : 1.0;
      const double sigma = params.sensor.sigmaAlongNormal(range, std::min(1.0, std::abs(cosine)));
      const double share =
          std::abs(plane.signedDistance(point)) / (params.graph.noise_gate * sigma + slack);
      if (share >= best) return;
      best = share;
      labels[i] = candidate;
    });
  }
  return labels;
}

}  // namespace opp
