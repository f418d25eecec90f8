// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "graph/sample_assigner.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace opp {

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
  // First the means, then what scatters about them: one division per plane instead of per sample,
  // and as exact.
  struct Sums {
    double weight = 0.0, x = 0.0, y = 0.0, z = 0.0;
    double xx = 0.0, xy = 0.0, xz = 0.0, yy = 0.0, yz = 0.0, zz = 0.0;
  };
  std::vector<Sums> sums(planes);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] < 0) continue;
    Sums& s = sums[static_cast<std::size_t>(labels[i])];
    const Eigen::Vector3d point = cloud_.points[i].cast<double>();
    const double w = weights_[i];
    s.weight += w, s.x += w * point.x(), s.y += w * point.y(), s.z += w * point.z();
  }
  for (Sums& s : sums) {
    if (s.weight > 0.0) s.x /= s.weight, s.y /= s.weight, s.z /= s.weight;
  }
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] < 0) continue;
    Sums& s = sums[static_cast<std::size_t>(labels[i])];
    const Eigen::Vector3d point = cloud_.points[i].cast<double>();
    const double x = point.x() - s.x, y = point.y() - s.y, z = point.z() - s.z;
    const double wx = weights_[i] * x, wy = weights_[i] * y, wz = weights_[i] * z;
    s.xx += wx * x, s.xy += wx * y, s.xz += wx * z, s.yy += wy * y, s.yz += wy * z, s.zz += wz * z;
  }
  std::vector<PointMoments> moments;
  for (const Sums& s : sums) {
    Eigen::Matrix3d scatter;
    scatter << s.xx, s.xy, s.xz, s.xy, s.yy, s.yz, s.xz, s.yz, s.zz;
    moments.push_back(s.weight > 0.0 ? PointMoments(s.weight, {s.x, s.y, s.z}, scatter)
                                     : PointMoments());
  }
  return moments;
}

}  // namespace opp
