// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/refinement/refine_planes.h"

#include "opp/refinement/find_structure.h"
#include "opp/refinement/solve_normals.h"

#include "refinement/plane_bookkeeping.h"
#include "refinement/sample_assignment.h"
#include "refinement/surface_shape.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace opp {
namespace {

/// A plane rests when a pass moves it by less than this part of its standard deviation. A pass
/// leaves a fifth of the error that it found, so that a hundredth remains.
constexpr double kRest = 0.05;
/// Passes on a part of the samples: enough to come from degrees and centimetres near the noise.
constexpr int kCoarsePasses = 5;
/// Planes with fewer samples in that part wait for the full passes.
constexpr int kLeastCoarseSupport = 10;
/// Families and edges are tested again after the constrained passes; a change restarts them.
constexpr int kMaxRestructurings = 3;

class Refiner {
 public:
  Refiner(const OrientedCloud& cloud, const PlaneGraph& graph, const SensorModel& sensor,
          const RefinementParams& params)
      : cloud_(cloud),
        params_(params),
        samples_(weightedSamples(cloud, sensor)),
        edges_(graph.edges),
        labels_(cloud.size(), -1) {
    for (const PlaneNode& node : graph.nodes) {
      const double weight = node.moments.weight();
      const double rms =
          weight > 0.0 ? std::sqrt(node.moments.squaredError(node.plane) / weight) : 0;
      fits_.emplace_back();
      fits_.back().plane = node.plane;
      fits_.back().slack = std::max(rms, node.spacing > 0.0 ? node.spacing : cloud.spacing);
      fits_.back().moments = node.moments;
      fits_.back().reach = node.reach.isEmpty() ? anywhere() : node.reach.cast<double>();
    }
  }

  Primitives refine() {
    fitAlone();
    structure_ = findStructure(estimates(), edges_, params_);
    fitTogether();
    for (int k = 0; k < kMaxRestructurings && restructure(); ++k) fitTogether();
    return collect();
  }

 private:
  using Index = std::size_t;

  static Eigen::AlignedBox3d anywhere() {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    return {Eigen::Vector3d::Constant(-kFar), Eigen::Vector3d::Constant(kFar)};
  }

  /// Parallel planes, the groups with most information first.
  std::vector<ParallelGroup> groupsOf(const std::vector<std::vector<int>>& families) const {
    std::vector<std::pair<double, ParallelGroup>> groups;
    for (const std::vector<int>& family : families) {
      const Eigen::Vector3d normal = fits_[static_cast<Index>(family.front())].plane.normal();
      double weight = 0.0;
      for (const int plane : family) weight += fits_[static_cast<Index>(plane)].moments.weight();
      groups.emplace_back(weight, makeGroup(normal, {family.begin(), family.end()}, fits_));
    }
    std::stable_sort(groups.begin(), groups.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<ParallelGroup> sorted;
    for (auto& group : groups) sorted.push_back(std::move(group.second));
    return sorted;
  }

  /// Fits every plane for itself, on a part of the samples.
  void fitAlone() {
    std::vector<std::vector<int>> single;
    for (Index k = 0; k < fits_.size(); ++k) single.push_back({static_cast<int>(k)});
    const Index stride = std::max<Index>(
        1, samples_.size() / static_cast<Index>(std::max(1, params_.coarse_samples)));
    for (int pass = 0; pass < kCoarsePasses; ++pass) {
      assignSamples(samples_, groupsOf(single), params_, stride, fits_, labels_);
      bool rest = true;
      for (PlaneFit& fit : fits_) {
        if (fit.sums.support < kLeastCoarseSupport) continue;
        rest = move(fit, ownNormal(fit.moments.scatter(), fit.plane.normal())) && rest;
      }
      if (rest) break;
    }
  }

  /// Fits all planes jointly, with shared and orthogonal normals.
  void fitTogether() {
    solve();
    for (int pass = 0; pass < params_.max_iterations; ++pass) {
      assignSamples(samples_, groupsOf(structure_.families), params_, 1, fits_, labels_);
      converged_ = solve();
      if (converged_) return;
    }
  }

  /// Solves the normals from the moments and moves the planes; true if they hardly moved.
  bool solve() {
    solution_ = solveNormals(normalProblem(), familyNormals());
    bool rest = solution_.converged;
    for (Index f = 0; f < structure_.families.size(); ++f) {
      for (const int plane : structure_.families[f]) {
        rest = move(fits_[static_cast<Index>(plane)], solution_.normals[f]) && rest;
      }
    }
    return rest;
  }

  std::vector<Eigen::Vector3d> familyNormals() const {
    std::vector<Eigen::Vector3d> normals;
    for (const std::vector<int>& family : structure_.families) {
      normals.push_back(fits_[static_cast<Index>(family.front())].plane.normal());
    }
    return normals;
  }

  /// What the samples say about the normals; with `rims`, less what `PlaneFit::information` doubts.
  NormalProblem normalProblem(bool rims = false) const {
    NormalProblem problem;
    for (const std::vector<int>& family : structure_.families) {
      Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
      for (const int plane : family) {
        const PlaneFit& fit = fits_[static_cast<Index>(plane)];
        scatter += rims ? fit.information(fit.plane.normal()) : fit.moments.scatter();
      }
      problem.scatters.push_back(scatter);
    }
    problem.frames = structure_.frames;
    const double variance = params_.systematic_angle * params_.systematic_angle;
    for (const std::array<int, 2>& edge : structure_.soft_edges) {
      problem.soft_edges.push_back({edge, 1.0 / std::max(variance, kLeastAngleVariance)});
    }
    return problem;
  }

  /// Tests families and edges again; true if planes or structure changed and need another fit.
  bool restructure() {
    const std::size_t before = fits_.size();
    markCurved(samples_, labels_, params_, fits_);
    markUncertain();
    dropAndMerge();
    const bool split = splitPlanes();
    PlaneStructure tested = findStructure(estimates(), edges_, params_);
    const bool changed =
        fits_.size() != before || split || tested.families != structure_.families ||
        tested.frames != structure_.frames || tested.soft_edges != structure_.soft_edges;
    structure_ = std::move(tested);
    return changed;
  }

  /// Sets the plane to ±normal through its samples' mean; true if it hardly moved.
  bool move(PlaneFit& fit, const Eigen::Vector3d& normal) const {
    const double slack = fit.slack;
    if (fit.sums.support > 0) {
      fit.slack = std::min(slack, fit.sums.excess(params_.outlier_cutoff));
    }
    const Plane old = fit.plane;
    const Eigen::Vector3d n = normal.dot(old.normal()) < 0.0 ? Eigen::Vector3d(-normal) : normal;
    const Eigen::Vector3d anchor =
        fit.moments.empty() ? old.project(Eigen::Vector3d::Zero()) : fit.moments.mean();
    fit.plane = Plane::fromPointNormal(anchor, n);
    const Eigen::Vector3d turn = n - old.normal();
    const double shift = old.signedDistance(anchor);
    const double squared_change =
        fit.moments.weight() * shift * shift + turn.dot(fit.moments.scatter() * turn);
    const double spread = std::sqrt(fit.sums.meanVariance() + fit.slack * fit.slack);
    return squared_change <= kRest * kRest && slack - fit.slack <= 0.1 * spread;
  }

  std::vector<NormalEstimate> estimates() const {
    std::vector<NormalEstimate> result;
    for (const PlaneFit& fit : fits_) {
      const Eigen::Vector3d normal = ownNormal(fit.moments.scatter(), fit.plane.normal());
      result.push_back({normal, fit.information(normal)});
    }
    return result;
  }

  /// Marks planes of whose direction neither their samples nor parallel or orthogonal planes tell
  /// enough.
  void markUncertain() {
    const Eigen::MatrixXd covariance = normalCovariance(normalProblem(true), solution_.normals);
    for (Index k = 0; k < fits_.size(); ++k) {
      const Eigen::Index at = 2 * structure_.family_of[k];
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(covariance.block<2, 2>(at, at),
                                                                 Eigen::EigenvaluesOnly);
      const double limit = params_.max_uncertainty * params_.max_uncertainty;
      fits_[k].uncertain = eigen.eigenvalues()[1] > limit;
    }
  }

  void dropAndMerge() {
    const std::vector<int> new_index = survivors(fits_, params_);
    compact(new_index, fits_, edges_);
    for (int& label : labels_) {
      if (label >= 0) label = new_index[static_cast<Index>(label)];
    }
  }

  /// Gives planes that were fitted between two parallel surfaces one to each. Both halves inherit
  /// the edges.
  bool splitPlanes() {
    const std::size_t count = fits_.size();
    for (std::size_t k = 0; k < count; ++k) {
      if (fits_[k].slack <= 0.0) continue;
      auto layers = splitLayers(samples_, labels_, static_cast<int>(k), fits_[k], params_);
      if (!layers) continue;
      fits_[k] = (*layers)[0];
      const int half = static_cast<int>(fits_.size());
      fits_.push_back((*layers)[1]);
      const std::vector<OrthogonalityEdge> edges = edges_;
      for (const OrthogonalityEdge& edge : edges) {
        const auto [a, b] = edge.planes;
        if (a == static_cast<int>(k)) edges_.push_back({{b, half}, edge.votes});
        if (b == static_cast<int>(k)) edges_.push_back({{a, half}, edge.votes});
      }
    }
    return fits_.size() != count;
  }

  Primitives collect() const {
    Primitives result;
    result.edges = structure_.edges;
    result.labels = labels_;
    result.converged = converged_ || fits_.empty();
    result.normal_covariance = normalCovariance(normalProblem(), solution_.normals);
    for (Index f = 0; f < structure_.families.size(); ++f) {
      result.families.push_back({solution_.normals[f], structure_.families[f]});
    }
    for (Index k = 0; k < fits_.size(); ++k) {
      result.planes.push_back(primitiveOf(fits_[k], structure_.family_of[k], cloud_, result));
    }
    return result;
  }

  const OrientedCloud& cloud_;
  const RefinementParams& params_;
  std::vector<WeightedSample> samples_;
  std::vector<OrthogonalityEdge> edges_;
  std::vector<int> labels_;
  std::vector<PlaneFit> fits_;
  PlaneStructure structure_;
  NormalSolution solution_;
  bool converged_ = false;
};

void check(const OrientedCloud& cloud, const PlaneGraph& graph) {
  if (cloud.normals.size() != cloud.size() || cloud.sigmas.size() != cloud.size() ||
      cloud.weights.size() != cloud.size()) {
    throw std::invalid_argument("an oriented cloud needs one normal, sigma and weight per point");
  }
  const auto valid = [&](int index) {
    return index >= 0 && static_cast<std::size_t>(index) < graph.nodes.size();
  };
  for (const OrthogonalityEdge& edge : graph.edges) {
    if (!valid(edge.planes[0]) || !valid(edge.planes[1])) {
      throw std::invalid_argument("an edge of the plane graph names a plane that is not there");
    }
  }
}

}  // namespace

Primitives refinePlanes(const OrientedCloud& cloud, const PlaneGraph& graph,
                        const SensorModel& sensor, const RefinementParams& params) {
  validate(sensor);
  validate(params);
  check(cloud, graph);
  return Refiner(cloud, graph, sensor, params).refine();
}

}  // namespace opp
