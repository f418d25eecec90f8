// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/refinement/refine_planes.h"

#include "opp/refinement/find_structure.h"
#include "opp/refinement/solve_normals.h"

#include "graph/plane_support.h"
#include "refinement/candidates.h"
#include "refinement/joint_problem.h"
#include "refinement/plane_bookkeeping.h"
#include "refinement/sample_assignment.h"
#include "refinement/surface_shape.h"

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
/// Joint passes before planes, families and edges are tested: a pass leaves a fifth of the error.
constexpr int kRoughPasses = 3;
/// Families and edges are tested again after the constrained passes; a change restarts them.
constexpr int kMaxRestructurings = 3;

std::vector<WeightedSample> inOrder(const std::vector<WeightedSample>& samples,
                                    const std::vector<std::uint32_t>& order) {
  std::vector<WeightedSample> result;
  result.reserve(samples.size());
  for (const std::uint32_t i : order) result.push_back(samples[i]);
  return result;
}

class Refiner {
 public:
  Refiner(const OrientedCloud& cloud, const PlaneGraph& graph, const SensorModel& sensor,
          const RefinementParams& params)
      : cloud_(cloud),
        sensor_(sensor),
        params_(params),
        blocks_(cloud.points),
        samples_(inOrder(weightedSamples(cloud, sensor), blocks_.order())),
        search_(blocks_, samples_),
        edges_(graph.edges),
        meeting_(graph.meeting),
        labels_(cloud.size(), -1) {
    for (const PlaneNode& node : graph.nodes) {
      const double weight = node.moments.weight();
      const double rms =
          weight > 0.0 ? std::sqrt(node.moments.squaredError(node.plane) / weight) : 0;
      fits_.emplace_back();
      fits_.back().plane = node.plane;
      // Samples of a clustered node lie within their gates; a rough one may be off by a spacing.
      fits_.back().slack = node.spacing > 0.0 ? rms : std::max(rms, cloud.spacing);
      fits_.back().moments = node.moments;
      fits_.back().reach = node.reach.isEmpty() ? anywhere() : node.reach.cast<double>();
    }
  }

  Primitives refine() {
    fitAlone();
    structure_ = findStructure(normalEstimates(fits_), edges_, params_);
    // Planes that will be dropped or merged are no reason to wait until all others rest.
    fitTogether(kRoughPasses);
    for (int k = 0; k < kMaxRestructurings && restructure(); ++k) fitTogether(kRoughPasses);
    if (!converged_) fitTogether(params_.max_iterations);
    addMeetings();
    if (restructure()) fitTogether(params_.max_iterations);
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
      double weight = 0.0;
      for (const int plane : family) weight += fits_[static_cast<Index>(plane)].moments.weight();
      groups.emplace_back(weight, ParallelGroup(family.begin(), family.end()));
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
    const Candidates candidates = search_.find(groupsOf(single), fits_, params_, stride);
    for (int pass = 0; pass < kCoarsePasses; ++pass) {
      assignSamples(samples_, candidates, params_, fits_, labels_);
      bool rest = true;
      for (PlaneFit& fit : fits_) {
        if (fit.sums.support < kLeastCoarseSupport) continue;
        rest = move(fit, ownNormal(fit.moments.scatter(), fit.plane.normal())) && rest;
      }
      if (rest) break;
    }
  }

  /// Fits all planes jointly, with shared and orthogonal normals.
  void fitTogether(int max_passes) {
    solve();
    for (PlaneFit& fit : fits_) fit.rests = false;
    std::fill(labels_.begin(), labels_.end(), -1);
    const Candidates candidates = search_.find(groupsOf(structure_.families), fits_, params_, 1);
    for (int pass = 0; pass < max_passes; ++pass) {
      assignSamples(samples_, candidates, params_, fits_, labels_);
      converged_ = solve();
      if (converged_) return;
    }
  }

  /// Marks planes whose direction is not known, by the families that they fit into as they are now:
  /// they have moved since those in use were found.
  void markUncertainNow() {
    const PlaneStructure present = findStructure(normalEstimates(fits_), edges_, params_);
    markUncertain(present, normalsOf(present).normals, params_, fits_);
  }

  NormalSolution normalsOf(const PlaneStructure& structure) const {
    return solveNormals(normalProblem(structure, fits_, params_), familyNormals(structure, fits_));
  }

  /// Solves the normals from the moments and moves the planes; true if they hardly moved.
  bool solve() {
    solution_ = normalsOf(structure_);
    bool rest = solution_.converged;
    for (Index f = 0; f < structure_.families.size(); ++f) {
      for (const int plane : structure_.families[f]) {
        rest = move(fits_[static_cast<Index>(plane)], solution_.normals[f]) && rest;
      }
    }
    return rest;
  }

  /// Tests families and edges again; true if planes or structure changed and need another fit.
  bool restructure() {
    const std::size_t before = fits_.size();
    markCurved(samples_, labels_, params_, fits_);
    markUncertainNow();
    dropAndMerge();
    const bool split = splitPlanes(samples_, labels_, params_, fits_, edges_);
    PlaneStructure tested = findStructure(normalEstimates(fits_), edges_, params_);
    const bool changed =
        fits_.size() != before || split || tested.families != structure_.families ||
        tested.frames != structure_.frames || tested.soft_edges != structure_.soft_edges;
    structure_ = std::move(tested);
    return changed;
  }

  /// The samples of each plane, by their index in the cloud.
  std::vector<std::vector<int>> samplesInCloud() const {
    std::vector<std::vector<int>> samples;
    for (const std::vector<std::uint32_t>& members : membersOf(labels_, fits_.size())) {
      samples.emplace_back();
      for (const std::uint32_t i : members)
        samples.back().push_back(static_cast<int>(blocks_.order()[i]));
    }
    return samples;
  }

  /// Adds edges between planes that meet only now: those of the graph were rough, and some had not
  /// yet the samples that other planes have lost since.
  void addMeetings() {
    std::vector<std::array<int, 2>> known;
    for (const OrthogonalityEdge& edge : edges_) known.push_back(edge.planes);
    std::sort(known.begin(), known.end());
    const std::vector<std::vector<int>> samples = samplesInCloud();
    std::vector<EdgeSide> sides;
    for (Index k = 0; k < fits_.size(); ++k) {
      sides.push_back({fits_[k].plane, samples[k], meanExtent(cloud_, samples[k])});
    }
    for (Index a = 0; a < fits_.size(); ++a) {
      for (Index b = a + 1; b < fits_.size(); ++b) {
        const std::array<int, 2> planes{static_cast<int>(a), static_cast<int>(b)};
        if (std::binary_search(known.begin(), known.end(), planes)) continue;
        if (samples[a].empty() || samples[b].empty()) continue;
        if (meet(cloud_, sides[a], sides[b], meeting_)) edges_.push_back({planes, 0.0});
      }
    }
    std::stable_sort(edges_.begin(), edges_.end(),
                     [](const auto& a, const auto& b) { return a.planes < b.planes; });
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
    fit.rests = squared_change <= kRest * kRest && slack - fit.slack <= 0.1 * spread;
    return fit.rests;
  }

  void dropAndMerge() {
    SameSurface same_surface(fits_, samples_, labels_, cloud_.viewpoint.cast<double>(), sensor_,
                             params_);
    const std::vector<int> new_index = survivors(same_surface, params_, fits_);
    compact(new_index, fits_, edges_);
    for (int& label : labels_) {
      if (label >= 0) label = new_index[static_cast<Index>(label)];
    }
  }

  Primitives collect() const {
    Primitives result;
    result.edges = structure_.edges;
    result.labels.resize(labels_.size());
    for (Index i = 0; i < labels_.size(); ++i) result.labels[blocks_.order()[i]] = labels_[i];
    result.converged = converged_ || fits_.empty();
    result.normal_covariance =
        normalCovariance(normalProblem(structure_, fits_, params_), solution_.normals);
    for (Index f = 0; f < structure_.families.size(); ++f) {
      result.families.push_back({solution_.normals[f], structure_.families[f]});
    }
    for (Index k = 0; k < fits_.size(); ++k) {
      result.planes.push_back(primitiveOf(fits_[k], structure_.family_of[k], cloud_, result));
    }
    return result;
  }

  const OrientedCloud& cloud_;
  const SensorModel& sensor_;
  const RefinementParams& params_;
  SampleBlocks blocks_;
  std::vector<WeightedSample> samples_;  ///< in the order of the blocks, as labels_
  CandidateSearch search_;
  std::vector<OrthogonalityEdge> edges_;
  MeetingRule meeting_;
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
