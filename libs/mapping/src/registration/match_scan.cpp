// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/registration/match_scan.h"

#include "opp/geometry/point_moments.h"
#include "opp/mapping/registration/plane_samples.h"

#include "registration/normal_space_sampling.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <map>

namespace opp::mapping {
namespace {

/// A surfel averages a patch that need not be flat; until the pose has settled its offset is taken
/// to be this uncertain, in voxels. Halved at each step down to the noise: graduated non-convexity.
constexpr double kFirstAnnealing = 0.25;
/// A point agrees with its surfel if the kernel leaves it this much influence.
constexpr double kAgreementWeight = 0.1;

struct ScanPoint {
  Eigen::Vector3f point_in_body;
  Eigen::Vector3f normal_in_body;
  float variance;
  int label;
  double worth = 1.0;  ///< of one point, given all points of its surface; see effectiveCount
};

/// The scan's plane as four weighted pseudo-points that stand for all its samples: column k of the
/// factor of its moments is (s·x, s), and the residual n·(R(s·x) + s·t) + s·d has unit variance.
struct ScanPlane {
  Eigen::Matrix4d factor = Eigen::Matrix4d::Zero();
  PointMoments moments_in_body;
  double samples = 0.0;  ///< effective count
  int landmark = -1;
};

/// Normal equations of one Gauss–Newton step in (ω, v), with what the step saw.
struct NormalEquations {
  Matrix6d hessian = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  double squared_distance = 0.0;
  int agreeing = 0;

  void add(const Vector6d& jacobian, double residual, double weight) {
    hessian.noalias() += weight * jacobian * jacobian.transpose();
    gradient.noalias() += weight * residual * jacobian;
  }
};

class Matcher {
 public:
  Matcher(const ScanFeatures& scan, const LocalMap& map, const PosePrior& prior,
          const RegistrationParams& params)
      : scan_(scan), map_(map), prior_(prior), params_(params), pose_(prior.map_from_body) {
    const OrientedCloud& cloud = scan.cloud_in_body;
    for (const std::uint32_t i :
         sampleNormalSpace(cloud, static_cast<std::size_t>(params.max_points))) {
      points_.push_back({cloud.points[i], cloud.normals[i], sampleVariance(cloud, i, map.sensor()),
                         scan.primitives_in_body.labels[i], 1.0});
    }
    weightPoints();
    collectPlanes();
  }

  MatchResult run() {
    MatchResult result;
    // All surfaces weigh alike until the basin is found, so that one that moved does not win by its
    // many points; then each point counts, for precision.
    weighting_ = Weighting::kBySurface;
    for (std::size_t level = firstLevel(); level > 0; --level)
      iterate(map_.levels()[level], kMinIterations, kFirstAnnealing);
    iterate(map_.fine(), params_.max_iterations, kFirstAnnealing);
    associatePlanes();
    weighting_ = Weighting::kByPoint;
    result.converged = iterate(map_.fine(), params_.max_iterations, 0.0);
    report(result);
    return result;
  }

 private:
  /// Points of one surface share a part of their error; all that are on no plane count as one
  /// surface.
  void weightPoints() {
    std::map<int, double> counts;
    for (const ScanPoint& p : points_) counts[p.label] += 1.0;
    for (ScanPoint& p : points_)
      p.worth = effectiveCount(counts[p.label], map_.sensor()) / counts[p.label];
  }

  void collectPlanes() {
    for (const PlaneSamples& samples : planeSamples(scan_, map_.sensor())) {
      planes_.push_back(
          {samples.moments_in_body.factor(), samples.moments_in_body, samples.effective_count, -1});
    }
  }

  /// The finest level on which the points should find their surfels, as far as the prior knows the
  /// pose.
  std::size_t firstLevel() const {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> rotation(
        prior_.information.topLeftCorner<3, 3>());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> translation(
        prior_.information.bottomRightCorner<3, 3>());
    double squared_ranges = 0.0;
    for (const ScanPoint& p : points_) squared_ranges += p.point_in_body.squaredNorm();
    squared_ranges /= std::max<double>(1.0, static_cast<double>(points_.size()));
    const double sigma =
        std::sqrt(squared_ranges / rotation.eigenvalues()[0] + 1.0 / translation.eigenvalues()[0]);
    std::size_t level = 0;
    // A query reaches at least half a voxel; two sigmas shall be within it. Negated, so that an
    // unknown pose (NaN or infinite) starts on the coarsest.
    while (level + 1 < map_.levels().size() && !(0.25 * map_.levels()[level].voxelSize() > sigma))
      ++level;
    return level;
  }

  /// Runs until the steps are small; false if that took more than `max_iterations`.
  bool iterate(const SurfelMap& surfels, int max_iterations, double first_annealing) {
    double annealing = first_annealing * surfels.voxelSize();
    const double noise_floor = 1e-3 * surfels.voxelSize();
    for (int k = 0; k < max_iterations; ++k) {
      const NormalEquations equations = assemble(surfels, annealing);
      const Vector6d step = solve(equations);
      pose_ = retract(pose_, step);
      const bool small = step.head<3>().norm() < params_.rotation_tolerance &&
                         step.tail<3>().norm() < params_.translation_tolerance;
      if (small && annealing <= noise_floor) return true;
      annealing = annealing > noise_floor ? 0.5 * annealing : 0.0;
    }
    return false;
  }

  NormalEquations assemble(const SurfelMap& surfels, double annealing) const {
    NormalEquations equations;
    const double extra_variance = annealing * annealing;
    addPoints(surfels, extra_variance, equations);
    for (const ScanPlane& plane : planes_) {
      if (plane.landmark >= 0) addPlane(plane, extra_variance, equations);
    }
    return equations;
  }

  void addPoints(const SurfelMap& surfels, double extra_variance,
                 NormalEquations& equations) const {
    const Eigen::Isometry3f pose = pose_.cast<float>();
    for (const ScanPoint& p : points_) {
      const Eigen::Vector3f rotated = pose.linear() * p.point_in_body;
      const Eigen::Vector3f point = rotated + pose.translation();
      const Surfel* surfel = surfels.closest(point, pose.linear() * p.normal_in_body);
      if (surfel == nullptr) continue;
      const Eigen::Vector3d normal = surfel->normal.cast<double>();
      const double residual = normal.dot((point - surfel->mean).cast<double>());
      const double variance = p.variance + 1.0 / surfel->weight + extra_variance;
      const double kernel = cauchy(residual * residual / variance);
      if (kernel > kAgreementWeight) {
        ++equations.agreeing;
        equations.squared_distance += residual * residual;
      }
      Vector6d jacobian;
      jacobian << rotated.cast<double>().cross(normal), normal;
      const double worth = weighting_ == Weighting::kBySurface ? p.worth : 1.0;
      equations.add(jacobian, residual, worth * kernel / variance);
    }
  }

  void addPlane(const ScanPlane& plane, double extra_variance, NormalEquations& equations) const {
    const Plane& landmark = map_.landmarkPlanes()[static_cast<std::size_t>(plane.landmark)];
    const double squared_error =
        plane.moments_in_body.squaredError(transformed(pose_.inverse(), landmark));
    // Mean variance of a sample, to anneal and to robustify the plane as if it were one point.
    const double variance = plane.samples / plane.moments_in_body.weight();
    const double shrink = variance / (variance + extra_variance);
    const double weight = shrink * cauchy(shrink * squared_error / plane.samples);
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector3d rotated = pose_.linear() * plane.factor.block<3, 1>(0, k);
      const double scale = plane.factor(3, k);
      const double residual = landmark.normal().dot(rotated) +
                              scale * (landmark.normal().dot(pose_.translation()) + landmark.d());
      Vector6d jacobian;
      jacobian << rotated.cross(landmark.normal()), scale * landmark.normal();
      equations.add(jacobian, residual, weight);
    }
  }

  double cauchy(double squared_sigmas) const {
    return 1.0 / (1.0 + squared_sigmas / (params_.kernel_width * params_.kernel_width));
  }

  Vector6d solve(const NormalEquations& equations) const {
    // The prior pulls (ω, v) toward difference(pose, prior); its Jacobian is taken as the identity,
    // exact for translation and to second order in the rotation left to go.
    const Matrix6d hessian = equations.hessian + prior_.information;
    const Vector6d gradient =
        equations.gradient - prior_.information * difference(pose_, prior_.map_from_body);
    // A direction that neither scan nor prior fixes has a zero pivot: LDLT with a tiny ridge leaves
    // it alone.
    Matrix6d damped = hessian;
    damped.diagonal().array() += 1e-9 * std::max(1.0, hessian.diagonal().maxCoeff());
    return -damped.ldlt().solve(gradient);
  }

  /// Each scan plane votes for the landmarks of the surfels that its points match.
  void associatePlanes() {
    std::vector<std::map<int, int>> votes(planes_.size());
    std::vector<int> matched(planes_.size(), 0);
    const Eigen::Isometry3f pose = pose_.cast<float>();
    for (const ScanPoint& p : points_) {
      if (p.label < 0) continue;
      const Surfel* surfel =
          map_.fine().closest(pose * p.point_in_body, pose.linear() * p.normal_in_body);
      if (surfel == nullptr) continue;
      const auto plane = static_cast<std::size_t>(p.label);
      ++matched[plane];
      if (surfel->landmark >= 0) ++votes[plane][surfel->landmark];
    }
    for (std::size_t k = 0; k < planes_.size(); ++k) {
      const auto best =
          std::max_element(votes[k].begin(), votes[k].end(),
                           [](const auto& a, const auto& b) { return a.second < b.second; });
      if (best == votes[k].end() || best->second < params_.plane_vote_share * matched[k]) continue;
      if (fits(planes_[k], best->first)) planes_[k].landmark = best->first;
    }
  }

  /// The samples' root mean square distance to the landmark, over its noise, is within the gate.
  bool fits(const ScanPlane& plane, int landmark) const {
    const Plane in_body =
        transformed(pose_.inverse(), map_.landmarkPlanes()[static_cast<std::size_t>(landmark)]);
    const double squared_sigmas = plane.moments_in_body.squaredError(in_body) / plane.samples;
    return squared_sigmas < params_.plane_gate_sigmas * params_.plane_gate_sigmas;
  }

  void report(MatchResult& result) {
    result.map_from_body = pose_;
    result.information = assemble(map_.fine(), 0.0).hessian;
    for (std::size_t k = 0; k < planes_.size(); ++k) {
      if (planes_[k].landmark >= 0)
        result.planes.push_back({static_cast<int>(k), planes_[k].landmark});
    }
    NormalEquations points;
    addPoints(map_.fine(), 0.0, points);
    if (points.agreeing == 0) return;
    // What the points share of their error does not average out, as in the planes' moments.
    const double count = points.agreeing;
    result.point_information = effectiveCount(count, map_.sensor()) / count * points.hessian;
    result.overlap = count / static_cast<double>(points_.size());
    result.rms = std::sqrt(points.squared_distance / count);
  }

  /// Steps that the annealing takes from a quarter of a voxel down to a thousandth of it.
  static constexpr int kMinIterations = 9;

  enum class Weighting { kBySurface, kByPoint };

  const ScanFeatures& scan_;
  const LocalMap& map_;
  const PosePrior& prior_;
  const RegistrationParams& params_;
  Eigen::Isometry3d pose_;
  std::vector<ScanPoint> points_;
  std::vector<ScanPlane> planes_;
  Weighting weighting_ = Weighting::kBySurface;
};

}  // namespace

MatchResult matchScan(const ScanFeatures& scan, const LocalMap& map, const PosePrior& prior,
                      const RegistrationParams& params) {
  return Matcher(scan, map, prior, params).run();
}

}  // namespace opp::mapping
