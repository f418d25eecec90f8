// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "registration/pose_candidates.h"

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>

namespace opp::mapping {
namespace {

/// Two directions fix a rotation well if they are at least this far from parallel.
constexpr double kMinSine = 0.5;

/// Orthonormal frame of two directions, symmetric in their errors: bisector, difference, normal.
Eigen::Matrix3d frameOf(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Eigen::Matrix3d frame;
  frame.col(0) = (a + b).normalized();
  frame.col(1) = (a - b).normalized();
  frame.col(2) = frame.col(0).cross(frame.col(1));
  return frame;
}

double angleOf(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Best rotation of all directions that coincide under `rotation` (Kabsch, weighted by area), and
/// their area.
RotationCandidate fitted(const ScanModel& target, const ScanModel& source,
                         const Eigen::Matrix3d& rotation, double min_cosine) {
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Zero();
  RotationCandidate result;
  for (const PlaneDirection& s : source.directions) {
    for (const PlaneDirection& t : target.directions) {
      const Eigen::Vector3d moved = rotation * s.normal;
      if (!target.alike(t.normal, moved, min_cosine)) continue;
      const double area = std::min(s.area, t.area);
      const double sign = t.normal.dot(moved) < 0.0 ? -1.0 : 1.0;
      correlation += sign * area * t.normal * s.normal.transpose();
      result.area += area;
    }
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(correlation,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  result.target_from_source =
      svd.matrixU() * Eigen::Vector3d(1.0, 1.0, sign).asDiagonal() * svd.matrixV().transpose();
  return result;
}

/// Normals of a scan's plane directions, both of each if their sign tells nothing.
std::vector<Eigen::Vector3d> normalsOf(const ScanModel& scan) {
  std::vector<Eigen::Vector3d> normals;
  for (const PlaneDirection& d : scan.directions) {
    normals.push_back(d.normal);
    if (!scan.sided) normals.emplace_back(-d.normal);
  }
  return normals;
}

class RotationPool {
 public:
  RotationPool(const ScanModel& target, const ScanModel& source, double tolerance)
      : target_(target),
        source_(source),
        min_cosine_(std::cos(tolerance)),
        // trace = 1 + 2 cos(angle)
        min_trace_(1.0 + 2.0 * std::cos(tolerance)) {}

  void add(const Eigen::Matrix3d& rotation) {
    if (contains(rotation)) return;
    const RotationCandidate candidate = fitted(target_, source_, rotation, min_cosine_);
    if (candidate.area > 0.0 && !contains(candidate.target_from_source)) {
      pool_.push_back(candidate);
    }
  }

  std::vector<RotationCandidate> best(std::size_t count) {
    std::stable_sort(
        pool_.begin(), pool_.end(),
        [](const RotationCandidate& a, const RotationCandidate& b) { return a.area > b.area; });
    if (pool_.size() > count) pool_.resize(count);
    return std::move(pool_);
  }

 private:
  bool contains(const Eigen::Matrix3d& rotation) const {
    return std::any_of(pool_.begin(), pool_.end(), [&](const RotationCandidate& c) {
      return c.target_from_source.cwiseProduct(rotation).sum() > min_trace_;
    });
  }

  const ScanModel& target_;
  const ScanModel& source_;
  double min_cosine_, min_trace_;
  std::vector<RotationCandidate> pool_;
};

}  // namespace

std::vector<RotationCandidate> rotationCandidates(const ScanModel& target, const ScanModel& source,
                                                  const GlobalAlignmentParams& params) {
  RotationPool pool(target, source, params.direction_tolerance);
  const auto& t = target.directions;
  const std::vector<Eigen::Vector3d> s = normalsOf(source);
  for (std::size_t a = 0; a < t.size(); ++a) {
    for (std::size_t b = a + 1; b < t.size(); ++b) {
      if (t[a].normal.cross(t[b].normal).norm() < kMinSine) continue;
      const double angle = angleOf(t[a].normal, t[b].normal);
      const Eigen::Matrix3d target_frame = frameOf(t[a].normal, t[b].normal);
      for (std::size_t c = 0; c < s.size(); ++c) {
        for (std::size_t d = 0; d < s.size(); ++d) {
          if (c == d) continue;
          if (std::abs(angleOf(s[c], s[d]) - angle) > params.direction_tolerance) continue;
          pool.add(target_frame * frameOf(s[c], s[d]).transpose());
        }
      }
    }
  }
  return pool.best(static_cast<std::size_t>(params.max_rotations));
}

}  // namespace opp::mapping
