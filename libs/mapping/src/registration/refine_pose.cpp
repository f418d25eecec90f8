// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "registration/refine_pose.h"

#include "opp/mapping/registration/plane_samples.h"

#include "registration/shared_errors.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

namespace opp::mapping {
namespace {

/// Residuals beyond so many sigmas lose influence (Cauchy).
constexpr double kKernelWidth = 2.5;
/// Steps from half a cell of tolerance, halving it each time, and then without.
constexpr int kAnnealedSteps = 8;
constexpr int kFinalSteps = 4;
/// Distortion is one error for rays within this angle [rad]: see SensorModel::distortionSlope.
constexpr double kDistortedTogether = 0.1;

/// A sample of one scan on a surface of the other, in the target's axes.
struct Match {
  Eigen::Vector3d lever;  ///< from the source's origin to the sample [m]
  Eigen::Vector3d normal;
  double residual;  ///< [m]; grows when the source moves along the normal
  double weight;    ///< robust, over variance [1/m²]
  int surface;      ///< plane of the target, of the source after these; −1: none
  std::uint32_t target_sample;
  std::uint32_t source_sample;
};

/// Numbers the directions of a scan's rays within which distortion is one error.
class DistortedRays {
 public:
  /// The error of the sample's range, as it shows along `normal` (a unit vector in the scan's
  /// frame).
  SharedErrors::Part at(const ScanModel& scan, std::uint32_t sample,
                        const Eigen::Vector3d& normal) {
    const Eigen::Vector3d ray =
        (scan.cloud().points[sample] - scan.cloud().viewpoint).cast<double>();
    const double range = ray.norm();
    const std::array<int, 3> cell = {
        &scan == first_ ? 0 : 1,
        static_cast<int>(std::floor(std::atan2(ray.y(), ray.x()) / kDistortedTogether)),
        static_cast<int>(
            std::floor(std::atan2(ray.z(), ray.head<2>().norm()) / kDistortedTogether))};
    const int number = numbers_.try_emplace(cell, static_cast<int>(numbers_.size())).first->second;
    const double share = range > 0.0 ? normal.dot(ray) / range : 0.0;
    return {number, scan.sensor.distortion(range) * share};
  }
  explicit DistortedRays(const ScanModel& first) : first_(&first) {}

 private:
  const ScanModel* first_;
  std::map<std::array<int, 3>, int> numbers_;
};

class Refiner {
 public:
  Refiner(const ScanModel& target, const ScanModel& source, const Eigen::Isometry3d& pose,
          const GlobalAlignmentParams& params)
      : target_(target),
        source_(source),
        pose_(pose),
        min_cosine_(static_cast<float>(std::cos(params.normal_gate))) {}

  void refine() {
    double tolerance = 0.5 * std::max(target_.voxels.cell(), source_.voxels.cell());
    for (int k = 0; k < kAnnealedSteps; ++k, tolerance *= 0.5) step(tolerance);
    for (int k = 0; k < kFinalSteps; ++k) step(0.0);
  }

  RefinedPose result() {
    match(0.0);
    RefinedPose result;
    result.target_from_source = pose_;
    result.observability = observability();
    const std::vector<double> weights = jointWeights();
    for (std::size_t i = 0; i < matches_.size(); ++i) {
      const Vector6d j = jacobian(matches_[i], Eigen::Vector3d::Zero(), 1.0);
      result.information.noalias() += weights[i] * j * j.transpose();
    }
    return result;
  }

  Matrix6d covariance() {
    match(0.0);
    DistortedRays rays(target_);
    SharedErrors errors;
    const std::vector<double> weights = jointWeights();
    for (std::size_t i = 0; i < matches_.size(); ++i) {
      const Match& m = matches_[i];
      const Eigen::Vector3d normal_in_source = pose_.linear().transpose() * m.normal;
      errors.add(jacobian(m, Eigen::Vector3d::Zero(), 1.0), m.weight, 1.0 / weights[i],
                 {rays.at(target_, m.target_sample, m.normal),
                  rays.at(source_, m.source_sample, normal_in_source)});
    }
    return errors.covariance();
  }

 private:
  /// What the matches are worth together: samples of one plane share part of their error.
  std::vector<double> jointWeights() const {
    std::map<int, double> count;
    for (const Match& m : matches_) count[m.surface] += 1.0;
    const double correlation = target_.sensor.noise_correlation;
    std::vector<double> weights;
    for (const Match& m : matches_) {
      const double all = m.surface < 0 ? 1.0 : count[m.surface];
      const double worth = std::min(all, all / (1.0 + (all - 1.0) * correlation));
      weights.push_back(m.weight * worth / all);
    }
    return weights;
  }

  /// d residual / d(ω, v), with the lever from `middle` in units of `length`.
  static Vector6d jacobian(const Match& m, const Eigen::Vector3d& middle, double length) {
    Vector6d j;
    j << (m.lever - middle).cross(m.normal) / length, m.normal;
    return j;
  }

  void step(double tolerance) {
    match(tolerance);
    Matrix6d hessian = Matrix6d::Zero();
    Vector6d gradient = Vector6d::Zero();
    for (const Match& m : matches_) {
      const Vector6d j = jacobian(m, Eigen::Vector3d::Zero(), 1.0);
      hessian.noalias() += m.weight * j * j.transpose();
      gradient.noalias() += m.weight * m.residual * j;
    }
    // Directions without information are left alone by a tiny ridge.
    hessian.diagonal().array() += 1e-9 * std::max(1.0, hessian.diagonal().maxCoeff());
    pose_ = retract(pose_, -hessian.ldlt().solve(gradient));
  }

  /// While far off, the samples of the smaller scan do.
  void match(double tolerance) {
    matches_.clear();
    if (tolerance <= 0.0 || source_.area <= target_.area) matchSourceSamples(tolerance);
    if (tolerance <= 0.0 || source_.area > target_.area) matchTargetSamples(tolerance);
  }

  void matchSourceSamples(double tolerance) {
    const Eigen::Isometry3f pose = pose_.cast<float>();
    for (const std::uint32_t i : source_.samples) {
      const std::int32_t nearest =
          target_.voxels.near(pose * source_.cloud().points[i],
                              pose.linear() * source_.cloud().normals[i], min_cosine_);
      if (nearest < 0) continue;
      const auto k = static_cast<std::uint32_t>(nearest);
      const Plane surface = target_.surfaceAt(k);
      const Eigen::Vector3d lever = pose_.linear() * source_.cloud().points[i].cast<double>();
      const double residual = surface.signedDistance(lever + pose_.translation());
      matches_.push_back({lever, surface.normal(), residual,
                          weight(residual, target_.sigmas[k], source_.sigmas[i], tolerance),
                          target_.labelOf(k), k, i});
    }
  }

  /// The same with the scans' parts exchanged: the surface moves instead of the sample.
  void matchTargetSamples(double tolerance) {
    const Eigen::Isometry3d source_from_target = pose_.inverse();
    const Eigen::Isometry3f pose = source_from_target.cast<float>();
    const int target_planes = static_cast<int>(target_.primitives().planes.size());
    for (const std::uint32_t i : target_.samples) {
      const std::int32_t nearest =
          source_.voxels.near(pose * target_.cloud().points[i],
                              pose.linear() * target_.cloud().normals[i], min_cosine_);
      if (nearest < 0) continue;
      const auto k = static_cast<std::uint32_t>(nearest);
      const Plane surface = source_.surfaceAt(k);
      const Eigen::Vector3d point = target_.cloud().points[i].cast<double>();
      const double residual = -surface.signedDistance(source_from_target * point);
      const int label = source_.labelOf(k);
      matches_.push_back({point - pose_.translation(), pose_.linear() * surface.normal(), residual,
                          weight(residual, source_.sigmas[k], target_.sigmas[i], tolerance),
                          label < 0 ? -1 : target_planes + label, i, k});
    }
  }

  static double weight(double residual, float sigma_a, float sigma_b, double tolerance) {
    const auto a = static_cast<double>(sigma_a), b = static_cast<double>(sigma_b);
    const double variance = a * a + b * b + tolerance * tolerance;
    const double sigmas = residual * residual / (variance * kKernelWidth * kKernelWidth);
    return 1.0 / (variance * (1.0 + sigmas));
  }

  Vector6d observability() const {
    if (matches_.empty()) return Vector6d::Zero();
    const auto count = static_cast<double>(matches_.size());
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const Match& m : matches_) middle += m.lever / count;
    double length = 0.0;
    for (const Match& m : matches_) length += (m.lever - middle).norm() / count;
    Matrix6d mean = Matrix6d::Zero();
    for (const Match& m : matches_) {
      const Vector6d j = jacobian(m, middle, std::max(length, 1e-6));
      mean.noalias() += j * j.transpose() / count;
    }
    return Eigen::SelfAdjointEigenSolver<Matrix6d>(mean).eigenvalues();
  }

  const ScanModel& target_;
  const ScanModel& source_;
  Eigen::Isometry3d pose_;
  float min_cosine_;
  std::vector<Match> matches_;
};

}  // namespace

RefinedPose refinePose(const ScanModel& target, const ScanModel& source,
                       const Eigen::Isometry3d& target_from_source,
                       const GlobalAlignmentParams& params) {
  Refiner refiner(target, source, target_from_source, params);
  refiner.refine();
  return refiner.result();
}

Matrix6d covarianceAt(const ScanModel& target, const ScanModel& source,
                      const Eigen::Isometry3d& target_from_source,
                      const GlobalAlignmentParams& params) {
  return Refiner(target, source, target_from_source, params).covariance();
}

RefinedPose informationAt(const ScanModel& target, const ScanModel& source,
                          const Eigen::Isometry3d& target_from_source,
                          const GlobalAlignmentParams& params) {
  return Refiner(target, source, target_from_source, params).result();
}

}  // namespace opp::mapping
