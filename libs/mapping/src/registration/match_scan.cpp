// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/registration/match_scan.h"

#include "opp/mapping/registration/plane_samples.h"

#include "registration/associate_planes.h"
#include "registration/match_input.h"
#include "registration/normal_equations.h"
#include "registration/observability.h"
#include "registration/point_matches.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace opp::mapping {
namespace {

/// A surfel averages a patch that need not be flat; until the pose has settled its offset is taken
/// to be this uncertain, in voxels. Halved at each step down to the noise: graduated non-convexity.
constexpr double kFirstAnnealing = 0.25;
/// The noise of normals is only known roughly; what may be noise shall not pass for structure.
constexpr double kNoiseCaution = 2.0;

class Matcher {
 public:
  Matcher(const ScanFeatures& scan, const LocalMap& map, const PosePrior& prior,
          const RegistrationParams& params)
      : map_(map),
        prior_(prior),
        params_(params),
        pose_(prior.map_from_body),
        points_(scanPoints(scan, map.sensor(), params)),
        rims_(rimPoints(scan, map.sensor())),
        planes_(scanPlanes(scan, map.sensor())),
        range_(rmsRange(points_)) {}

  MatchResult run() {
    MatchResult result;
    // All surfaces weigh alike until the basin is found, so that one that moved does not win by its
    // many points; then each point counts, for precision.
    weighting_ = Weighting::kBySurface;
    const std::size_t first = firstLevel();
    for (std::size_t level = first; level > 0; --level) approach(level);
    iterate(map_.fine(), params_.max_iterations, kFirstAnnealing);
    if (first > 0) compareWithFineOnly();
    associatePlanes(points_, pose_, map_, params_, planes_);
    weighting_ = Weighting::kByPoint;
    result.converged = iterate(map_.fine(), params_.max_iterations, 0.0);
    report(result);
    return result;
  }

 private:
  /// The finest level on which the points should find their surfels, as far as the prior knows the
  /// pose.
  std::size_t firstLevel() const {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> rotation(
        prior_.information.topLeftCorner<3, 3>());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> translation(
        prior_.information.bottomRightCorner<3, 3>());
    const double sigma =
        std::sqrt(range_ * range_ / rotation.eigenvalues()[0] + 1.0 / translation.eigenvalues()[0]);
    std::size_t level = 0;
    // A query reaches at least half a voxel; two sigmas shall be within it. Negated, so that an
    // unknown pose (NaN or infinite) starts on the coarsest.
    while (level + 1 < map_.levels().size() && !(0.25 * map_.levels()[level].voxelSize() > sigma))
      ++level;
    return level;
  }

  /// Iterates on a coarse level, unless that leads where the next finer one agrees less: surfels of
  /// a metre average what is no one surface.
  void approach(std::size_t level) {
    const Eigen::Isometry3d start = pose_;
    const double agreement = agreementWith(map_.levels()[level - 1]);
    iterate(map_.levels()[level], kMinIterations, kFirstAnnealing);
    if (agreementWith(map_.levels()[level - 1]) < agreement) pose_ = start;
  }

  /// Coarse surfels may lead away from a prior that was better than it knew: the finest alone, from
  /// there, must not agree more.
  void compareWithFineOnly() {
    const Eigen::Isometry3d found = pose_;
    const double agreement = agreementWith(map_.fine());
    pose_ = prior_.map_from_body;
    iterate(map_.fine(), params_.max_iterations, kFirstAnnealing);
    if (agreementWith(map_.fine()) <= agreement) pose_ = found;
  }

  /// Robust weights of the matches of points and rims, as the first step on `level` will have them;
  /// sum.
  double agreementWith(const LocalLevel& level) const {
    double agreement = 0.0;
    const auto add = [&](const ScanPoint&, const PointMatch& match) { agreement += match.kernel; };
    const double extra_variance = extraVariance(level, kFirstAnnealing * level.voxelSize());
    forEachMatch(level, extra_variance, add);
    forEachRim(level, extra_variance, add);
    return agreement;
  }

  /// Runs until the steps are small; false if that took more than `max_iterations`.
  bool iterate(const LocalLevel& level, int max_iterations, double first_annealing) {
    double annealing = first_annealing * level.voxelSize();
    const double noise_floor = 1e-3 * level.voxelSize();
    for (int k = 0; k < max_iterations; ++k) {
      const Vector6d step = stepOn(level, annealing);
      pose_ = retract(pose_, step);
      const bool small = step.head<3>().norm() < params_.rotation_tolerance &&
                         step.tail<3>().norm() < params_.translation_tolerance;
      if (small && annealing <= noise_floor) return true;
      annealing = annealing > noise_floor ? 0.5 * annealing : 0.0;
    }
    return false;
  }

  /// Each point says where the scan moves; how much that counts against the prior is what the scan
  /// will be said to fix (`report`).
  Vector6d stepOn(const LocalLevel& level, double annealing) const {
    Residuals residuals, independent;
    const double extra_variance = extraVariance(level, annealing);
    addPoints(level, extra_variance, residuals, independent);
    addRims(level, extra_variance, residuals, independent);
    for (const ScanPlane& plane : planes_) {
      if (plane.landmark < 0) continue;
      addPlane(plane, extra_variance, residuals);
      addPlane(plane, extra_variance, independent);
    }
    const NormalEquations equations = equationsOf(residuals);
    const bool by_surface = weighting_ == Weighting::kBySurface;
    return solve(equations, withoutNormalNoise(by_surface ? equations : equationsOf(independent)));
  }

  /// Points on one surfel share its error, and a coarse one has more of them: together they say no
  /// more than one of the finest would, or they would lead astray a pose that the prior knows.
  double extraVariance(const LocalLevel& level, double annealing) const {
    return std::pow(level.voxelSize() / map_.fine().voxelSize() * annealing, 2);
  }

  NormalEquations equationsOf(const Residuals& residuals) const {
    return residuals.equations(map_.normalVariance(),
                               params_.landmark_normal_noise * params_.landmark_normal_noise,
                               params_.rim_normal_noise * params_.rim_normal_noise);
  }

  /// \param independent gets, where each point counts, what it says given all of its surface, but
  /// for those of landmark planes, which have their samples
  void addPoints(const LocalLevel& level, double extra_variance, Residuals& residuals,
                 Residuals& independent) const {
    forEachMatch(level, extra_variance, [&](const ScanPoint& p, const PointMatch& match) {
      const double weight = match.kernel / match.variance;
      if (weighting_ == Weighting::kBySurface) {
        residuals.addPoint(match, p.worth * weight);
        return;
      }
      residuals.addPoint(match, weight);
      if (!onLandmark(p)) independent.addPoint(match, p.worth * weight);
    });
  }

  void addRims(const LocalLevel& level, double extra_variance, Residuals& residuals,
               Residuals& independent) const {
    const bool by_surface = weighting_ == Weighting::kBySurface;
    forEachRim(level, extra_variance, [&](const ScanPoint& p, const PointMatch& match) {
      const double weight = match.kernel / match.variance;
      residuals.addRim(match, by_surface ? p.worth * weight : weight);
      if (!by_surface) independent.addRim(match, p.worth * weight);
    });
  }

  void addPlane(const ScanPlane& plane, double extra_variance, Residuals& residuals) const {
    const Plane& landmark = map_.landmarkPlanes()[static_cast<std::size_t>(plane.landmark)];
    const double squared_error =
        plane.moments_in_body.squaredError(transformed(pose_.inverse(), landmark));
    // Mean variance of a sample, to anneal and to robustify the plane as if it were one point.
    const double variance = plane.samples / plane.moments_in_body.weight();
    const double shrink = variance / (variance + extra_variance);
    const double weight =
        shrink * cauchy(shrink * squared_error / plane.samples, params_.kernel_width);
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector3d rotated = pose_.linear() * plane.factor.block<3, 1>(0, k);
      const double scale = plane.factor(3, k);
      const double residual = landmark.normal().dot(rotated) +
                              scale * (landmark.normal().dot(pose_.translation()) + landmark.d());
      residuals.addPlane(rotated, scale, landmark.normal(), residual, weight);
    }
  }

  template <typename F>
  void forEachMatch(const LocalLevel& level, double extra_variance, F&& f) const {
    forEachPointMatch(points_, pose_, level.surfaces, map_.landmarkPlanes(),
                      {params_.kernel_width, extra_variance}, f);
  }

  template <typename F>
  void forEachRim(const LocalLevel& level, double extra_variance, F&& f) const {
    forEachPointMatch(rims_, pose_, level.rims, {}, {params_.kernel_width, extra_variance}, f);
  }

  /// What the rims tell, given that they share a part of their error.
  void addRimsTo(Residuals& residuals) const {
    forEachRim(map_.fine(), 0.0, [&](const ScanPoint& p, const PointMatch& match) {
      residuals.addRim(match, p.worth * match.kernel / match.variance);
    });
  }

  /// What the scan really fixes moves as it says; the rest is left to the prior, which pulls (ω, v)
  /// toward difference(pose, prior). Its Jacobian is taken as the identity, exact for translation
  /// and to second order in the rotation left to go. Else the pose would slide along a bare wall
  /// wherever the noise of its surfels leads. \param equations say where the scan moves; \param
  /// observed how much that counts
  Vector6d solve(const NormalEquations& equations, const Matrix6d& observed) const {
    const Vector6d of_scan = solveDamped(equations.hessian, equations.gradient);
    const Vector6d of_prior = difference(pose_, prior_.map_from_body);
    return solveDamped(observed + prior_.information,
                       prior_.information * of_prior - observed * of_scan);
  }

  /// A direction that neither scan nor prior fixes has a zero pivot: LDLT with a tiny ridge leaves
  /// it alone.
  static Vector6d solveDamped(const Matrix6d& matrix, const Vector6d& vector) {
    Matrix6d damped = matrix;
    damped.diagonal().array() += 1e-9 * std::max(1.0, matrix.diagonal().maxCoeff());
    return damped.ldlt().solve(vector);
  }

  Matrix6d withoutNormalNoise(const NormalEquations& equations) const {
    if (range_ <= 0.0) return equations.hessian;
    return withoutNoise(equations.hessian, kNoiseCaution * equations.noise, range_);
  }

  /// What the points and rims fix. \param worthOf weight of a point, 0: left out
  template <typename F>
  Matrix6d observedByPoints(F&& worthOf) const {
    Residuals residuals;
    forEachMatch(map_.fine(), 0.0, [&](const ScanPoint& p, const PointMatch& match) {
      residuals.addPoint(match, worthOf(p) * match.kernel / match.variance);
    });
    addRimsTo(residuals);
    return withoutNormalNoise(equationsOf(residuals));
  }

  void report(MatchResult& result) const {
    result.map_from_body = pose_;
    // Planes stand for their points; of the others, what one says given all of its surface.
    Residuals residuals;
    for (std::size_t k = 0; k < planes_.size(); ++k) {
      if (planes_[k].landmark < 0) continue;
      addPlane(planes_[k], 0.0, residuals);
      result.planes.push_back({static_cast<int>(k), planes_[k].landmark});
    }
    forEachMatch(map_.fine(), 0.0, [&](const ScanPoint& p, const PointMatch& match) {
      if (!onLandmark(p)) residuals.addPoint(match, p.worth * match.kernel / match.variance);
    });
    addRimsTo(residuals);
    result.information = withoutNormalNoise(equationsOf(residuals));
    result.covariance = covarianceOf(result.information + prior_.information);
    double squared_distance = 0.0, agreeing = 0.0;
    forEachMatch(map_.fine(), 0.0, [&](const ScanPoint&, const PointMatch& match) {
      if (!match.agrees()) return;
      agreeing += 1.0;
      squared_distance += match.residual * match.residual;
    });
    if (agreeing == 0.0) return;
    // What the points share of their error does not average out, as in the planes' moments.
    const double worth = effectiveCount(agreeing, map_.sensor()) / agreeing;
    result.point_information = observedByPoints([&](const ScanPoint&) { return worth; });
    result.overlap = agreeing / static_cast<double>(points_.size());
    result.rms = std::sqrt(squared_distance / agreeing);
  }

  bool onLandmark(const ScanPoint& p) const {
    return p.label >= 0 && planes_[static_cast<std::size_t>(p.label)].landmark >= 0;
  }

  /// Steps that the annealing takes from a quarter of a voxel down to a thousandth of it.
  static constexpr int kMinIterations = 9;

  enum class Weighting { kBySurface, kByPoint };

  const LocalMap& map_;
  const PosePrior& prior_;
  const RegistrationParams& params_;
  Eigen::Isometry3d pose_;
  std::vector<ScanPoint> points_, rims_;
  std::vector<ScanPlane> planes_;
  double range_;  ///< of the points, root mean square [m]
  Weighting weighting_ = Weighting::kBySurface;
};

}  // namespace

MatchResult matchScan(const ScanFeatures& scan, const LocalMap& map, const PosePrior& prior,
                      const RegistrationParams& params) {
  return Matcher(scan, map, prior, params).run();
}

}  // namespace opp::mapping
