// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "registration/refine_pose.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <map>

namespace opp::mapping {
namespace {

/// Residuals beyond so many sigmas lose influence (Cauchy).
constexpr double kKernelWidth = 2.5;
/// Steps from half a cell of tolerance down to the noise, halving it each time, and a few more.
constexpr int kPointSteps = 8;
constexpr int kPlaneSteps = 5;
/// A plane of the source is one of the target if most of its matched samples lie on that one.
constexpr double kVoteShare = 0.5;
/// Information of a plane's moments counts as if the sensor's noise had a part, of this share, that
/// all its samples have in common.
constexpr double kSystematicRatio = 0.3;

struct NormalEquations {
  Matrix6d hessian = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();

  void add(const Eigen::Vector3d& lever, double scale, const Eigen::Vector3d& normal,
           double residual, double weight) {
    Vector6d jacobian;
    jacobian << lever.cross(normal), scale * normal;
    hessian.noalias() += weight * jacobian * jacobian.transpose();
    gradient.noalias() += weight * residual * jacobian;
  }

  /// The step; directions without information are left alone by a tiny ridge.
  Vector6d solve() const {
    Matrix6d damped = hessian;
    damped.diagonal().array() += 1e-9 * std::max(1.0, hessian.diagonal().maxCoeff());
    return -damped.ldlt().solve(gradient);
  }
};

double cauchy(double squared_sigmas) {
  return 1.0 / (1.0 + squared_sigmas / (kKernelWidth * kKernelWidth));
}

class Refiner {
 public:
  Refiner(const ScanModel& target, const ScanModel& source, const Eigen::Isometry3d& pose,
          const GlobalAlignmentParams& params)
      : target_(target),
        source_(source),
        pose_(pose),
        min_cosine_(static_cast<float>(std::cos(params.normal_gate))),
        partner_(source.primitives().planes.size(), -1) {}

  RefinedPose run() {
    double tolerance = 0.5 * target_.voxels.cell();
    for (int k = 0; k < kPointSteps; ++k, tolerance *= 0.5) step(tolerance);
    pairPlanes();
    for (int k = 0; k < kPlaneSteps; ++k) step(0.0);
    return {pose_, assemble(0.0).hessian};
  }

 private:
  void step(double tolerance) { pose_ = retract(pose_, assemble(tolerance).solve()); }

  NormalEquations assemble(double tolerance) const {
    NormalEquations equations;
    for (const std::uint32_t i : source_.samples) {
      const int label = source_.labelOf(i);
      const bool in_pair = label >= 0 && partner_[static_cast<std::size_t>(label)] >= 0;
      if (!in_pair) addPoint(i, tolerance, equations);
    }
    for (std::size_t q = 0; q < partner_.size(); ++q) {
      if (partner_[q] >= 0) addPlane(q, equations);
    }
    return equations;
  }

  std::int32_t partnerOf(std::uint32_t sample) const {
    const Eigen::Isometry3f pose = pose_.cast<float>();
    return target_.voxels.near(pose * source_.cloud().points[sample],
                               pose.linear() * source_.cloud().normals[sample], min_cosine_);
  }

  void addPoint(std::uint32_t i, double tolerance, NormalEquations& equations) const {
    const std::int32_t nearest = partnerOf(i);
    if (nearest < 0) return;
    const auto k = static_cast<std::uint32_t>(nearest);
    const Plane surface = target_.surfaceAt(k);
    const Eigen::Vector3d lever = pose_.linear() * source_.cloud().points[i].cast<double>();
    const double residual = surface.signedDistance(lever + pose_.translation());
    const double variance = std::pow(target_.cloud().sigmas[k], 2) +
                            std::pow(source_.cloud().sigmas[i], 2) + tolerance * tolerance;
    equations.add(lever, 1.0, surface.normal(), residual,
                  cauchy(residual * residual / variance) / variance);
  }

  /// All samples of source plane q against its partner, see PointMoments::factor.
  void addPlane(std::size_t q, NormalEquations& equations) const {
    const PlanePrimitive& moving = source_.primitives().planes[q];
    const Plane& fixed = target_.primitives().planes[static_cast<std::size_t>(partner_[q])].plane;
    const double squared_error =
        moving.moments.squaredError(transformed(pose_.inverse(), fixed)) / moving.support;
    const double weight =
        cauchy(squared_error) / (1.0 + kSystematicRatio * kSystematicRatio * moving.support);
    const Eigen::Matrix4d factor = moving.moments.factor();
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector3d lever = pose_.linear() * factor.block<3, 1>(0, k);
      const double scale = factor(3, k);
      const double residual =
          fixed.normal().dot(lever + scale * pose_.translation()) + scale * fixed.d();
      equations.add(lever, scale, fixed.normal(), residual, weight);
    }
  }

  /// Each plane of the source votes, by its samples, for the target's planes they came to lie on.
  void pairPlanes() {
    std::vector<std::map<int, int>> votes(partner_.size());
    std::vector<int> matched(partner_.size(), 0);
    for (const std::uint32_t i : source_.samples) {
      const std::int32_t nearest = source_.labelOf(i) < 0 ? -1 : partnerOf(i);
      if (nearest < 0) continue;
      const auto q = static_cast<std::size_t>(source_.labelOf(i));
      ++matched[q];
      const int p = target_.labelOf(static_cast<std::uint32_t>(nearest));
      if (p >= 0) ++votes[q][p];
    }
    for (std::size_t q = 0; q < votes.size(); ++q) {
      const auto best =
          std::max_element(votes[q].begin(), votes[q].end(),
                           [](const auto& a, const auto& b) { return a.second < b.second; });
      if (best == votes[q].end() || best->second <= kVoteShare * matched[q]) continue;
      if (source_.primitives().planes[q].support > 0) partner_[q] = best->first;
    }
  }

  const ScanModel& target_;
  const ScanModel& source_;
  Eigen::Isometry3d pose_;
  float min_cosine_;
  std::vector<int> partner_;  ///< target plane of each source plane; −1: none
};

}  // namespace

RefinedPose refinePose(const ScanModel& target, const ScanModel& source,
                       const Eigen::Isometry3d& target_from_source,
                       const GlobalAlignmentParams& params) {
  return Refiner(target, source, target_from_source, params).run();
}

}  // namespace opp::mapping
