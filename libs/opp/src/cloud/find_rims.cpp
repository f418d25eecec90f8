// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/cloud/find_rims.h"

#include "cloud/check_cloud.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace opp {
namespace {

/// A rim must cross the line along which it was found, at no less than 45°: else it is found along
/// columns instead of rows, or the other way round.
constexpr double kLeastCrossing = 0.7;

/// The last pixel of a surface along a row or column.
struct RimPixel {
  int group;   ///< its square of the image and the side on which the surface ends
  int at;      ///< index of the point
  int inward;  ///< index of the surface's pixel beside it
};

/// Means over some rim pixels.
struct RimMoments {
  double count = 0.0;
  Eigen::Vector3d ray = Eigen::Vector3d::Zero();
  Eigen::Vector3d outward = Eigen::Vector3d::Zero();     ///< from ray to ray, away from the surface
  double range = 0.0;                                    ///< [m]
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();     ///< of the rays
  Eigen::Vector3d with_range = Eigen::Vector3d::Zero();  ///< covariance of ray and range [m]
  double range_variance = 0.0;                           ///< [m²]
};

class RimFinder {
 public:
  RimFinder(const PointCloud& cloud, const SensorModel& sensor, const RimParams& params)
      : cloud_(cloud),
        sensor_(sensor),
        params_(params),
        blocks_per_row_((cloud.cols + params.block - 1) / params.block) {}

  Rims find() {
    measureRanges();
    for (int row = 0; row < cloud_.rows; ++row) walk({row * cloud_.cols, 1, cloud_.cols}, 0);
    for (int col = 0; col < cloud_.cols; ++col) walk({col, cloud_.cols, cloud_.rows}, 2);
    std::sort(pixels_.begin(), pixels_.end(), [](const RimPixel& a, const RimPixel& b) {
      return std::tie(a.group, a.at) < std::tie(b.group, b.at);
    });
    for (std::size_t begin = 0, end = 0; begin < pixels_.size(); begin = end) {
      while (end < pixels_.size() && pixels_[end].group == pixels_[begin].group) ++end;
      fit(momentsOf(begin, end));
    }
    return std::move(rims_);
  }

 private:
  /// A row or column of the image.
  struct Line {
    int begin, stride, count;
    int at(int k) const { return begin + k * stride; }  ///< index of the point of its k-th pixel
  };

  float range(int at) const { return ranges_[static_cast<std::size_t>(at)]; }

  void measureRanges() {
    const auto least = static_cast<float>(sensor_.min_range);
    ranges_.reserve(cloud_.size());
    for (const Eigen::Vector3f& point : cloud_.points) {
      const float range = (point - cloud_.viewpoint).norm();
      // Points that are not finite compare false.
      ranges_.push_back(range >= least && range < std::numeric_limits<float>::max() ? range : 0.0F);
    }
  }

  /// Finds the steps along a line. \param side index of the side that lies forward; that backward
  /// is the next
  void walk(const Line& line, int side) {
    int last = -1;
    for (int k = 0; k < line.count; ++k) {
      if (range(line.at(k)) == 0.0F) continue;
      if (last >= 0 && k - last <= params_.max_gap + 1 && steps(line.at(last), line.at(k))) {
        const bool forward = range(line.at(k)) > range(line.at(last));
        const int front = forward ? last : k, behind = forward ? k : last;
        addPixel(line, front, behind, forward ? side : side + 1);
      }
      last = k;
    }
  }

  /// More than noise lies between two neighbours' ranges.
  bool steps(int a, int b) const {
    const double farther = static_cast<double>(std::max(range(a), range(b)));
    const double step = static_cast<double>(range(a)) - static_cast<double>(range(b));
    const double growing = sensor_.noise_quadratic * farther * farther;
    const double variance =
        2.0 * (sensor_.noise_constant * sensor_.noise_constant + growing * growing);
    return step * step > params_.step_sigmas * params_.step_sigmas * variance;
  }

  void addPixel(const Line& line, int front, int behind, int side) {
    const int outward = behind > front ? 1 : -1;
    const double slope = slopeFrom(line, front, -outward);
    if (slope < 0.0 || static_cast<double>(range(line.at(front))) > sensor_.max_range) return;
    const double slope_behind = slopeFrom(line, behind, outward);
    const double step = static_cast<double>(range(line.at(behind)) - range(line.at(front)));
    const double explained = std::max(slope, slope_behind) * std::abs(behind - front);
    if (step <= params_.step_slopes * explained) return;
    const int at = line.at(front);
    const int block =
        at / cloud_.cols / params_.block * blocks_per_row_ + at % cloud_.cols / params_.block;
    pixels_.push_back({4 * block + side, at, line.at(front - outward)});
  }

  /// By how much the range changes from pixel to pixel where a surface begins at `k`; −1: none
  /// does.
  double slopeFrom(const Line& line, int k, int inward) const {
    const int last = k + (params_.surface_pixels - 1) * inward;
    if (last < 0 || last >= line.count) return -1.0;
    for (int i = k; i != last; i += inward) {
      const int next = line.at(i + inward);
      if (range(next) == 0.0F || steps(line.at(i), next)) return -1.0;
    }
    return std::abs(static_cast<double>(range(line.at(last)) - range(line.at(k)))) /
           (params_.surface_pixels - 1);
  }

  Eigen::Vector3d ray(int at) const {
    return (cloud_.points[static_cast<std::size_t>(at)] - cloud_.viewpoint)
        .cast<double>()
        .normalized();
  }

  RimMoments momentsOf(std::size_t begin, std::size_t end) const {
    RimMoments m;
    m.count = static_cast<double>(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      m.ray += ray(pixels_[i].at) / m.count;
      m.outward += (ray(pixels_[i].at) - ray(pixels_[i].inward)) / m.count;
      m.range += static_cast<double>(range(pixels_[i].at)) / m.count;
    }
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d off = ray(pixels_[i].at) - m.ray;
      const double range_off = static_cast<double>(range(pixels_[i].at)) - m.range;
      m.scatter += off * off.transpose() / m.count;
      m.with_range += range_off * off / m.count;
      m.range_variance += range_off * range_off / m.count;
    }
    return m;
  }

  void fit(const RimMoments& m) {
    if (m.count < params_.min_pixels) return;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
    axes.computeDirect(m.scatter);
    const double pixel_angle = m.outward.norm();
    if (!(axes.eigenvalues()[2] > 0.0 && pixel_angle > 0.0)) return;
    const Eigen::Vector3d along = axes.eigenvectors().col(2);
    Eigen::Vector3d normal = along.cross(m.ray).normalized();
    if (normal.dot(m.outward) < 0.0) normal = -normal;
    if (!(normal.dot(m.outward) >= kLeastCrossing * pixel_angle)) return;
    const double allowed = params_.max_scatter * pixel_angle;
    if (normal.dot(m.scatter * normal) > allowed * allowed) return;
    // One surface's: its range changes evenly along the rim, but for noise.
    const double slope = along.dot(m.with_range) / axes.eigenvalues()[2];
    const double noise = params_.step_sigmas * sensor_.sigma(m.range);
    if (m.range_variance - slope * along.dot(m.with_range) > noise * noise) return;
    rims_.points.push_back(cloud_.viewpoint + (m.range * m.ray.normalized()).cast<float>());
    rims_.normals.push_back(normal.cast<float>());
    rims_.sigmas.push_back(static_cast<float>(
        std::max(sensor_.noise_constant, params_.noise * pixel_angle * m.range)));
  }

  const PointCloud& cloud_;
  const SensorModel& sensor_;
  const RimParams& params_;
  int blocks_per_row_;
  std::vector<float> ranges_;  ///< of each point [m]; 0: no measurement
  std::vector<RimPixel> pixels_;
  Rims rims_;
};

}  // namespace

Rims findRims(const PointCloud& cloud, const SensorModel& sensor, const RimParams& params) {
  validate(sensor);
  validate(params);
  check(cloud);
  if (!cloud.organized() || cloud.columns_wrap) return {};
  return RimFinder(cloud, sensor, params).find();
}

}  // namespace opp
