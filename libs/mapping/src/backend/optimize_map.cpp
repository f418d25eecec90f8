// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/backend/optimize_map.h"

#include "backend/cost_functions.h"

#include <ceres/ceres.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace opp::mapping {
namespace {

struct PoseBlock {
  Eigen::Quaterniond q;
  Eigen::Vector3d t;
};

struct PlaneBlock {
  Eigen::Vector3d n;
  double d;
};

void requireIndex(int index, std::size_t size, const char* what) {
  if (index < 0 || static_cast<std::size_t>(index) >= size) {
    throw std::invalid_argument("optimizeMap: a factor names " + std::string(what) + " " +
                                std::to_string(index) + " of " + std::to_string(size));
  }
}

class MapProblem {
 public:
  MapProblem(const MapFactors& factors, int first_free, const BackendParams& params,
             const std::vector<Eigen::Isometry3d>& map_from_keyframe,
             const std::vector<Plane>& planes_in_map)
      : first_free_(first_free), params_(params), problem_(problemOptions()) {
    for (const Eigen::Isometry3d& pose : map_from_keyframe) {
      poses_.push_back({Eigen::Quaterniond(pose.linear()), pose.translation()});
    }
    for (const Plane& plane : planes_in_map) planes_.push_back({plane.normal(), plane.d()});
    plane_is_free_.assign(planes_.size(), false);
    for (const PlaneFactor& f : factors.planes) {
      requireIndex(f.keyframe, poses_.size(), "keyframe");
      requireIndex(f.landmark, planes_.size(), "landmark");
      if (f.keyframe >= first_free_) plane_is_free_[static_cast<std::size_t>(f.landmark)] = true;
    }
    for (const PlaneFactor& f : factors.planes) addPlaneFactor(f);
    for (const RelativePoseFactor& f : factors.relative_poses) addRelativePose(f);
    for (const OrthogonalityFactor& f : factors.orthogonalities) {
      addAngle<OrthogonalityCost, 1>(f.landmarks, params_.orthogonality_sigma);
    }
    for (const ParallelismFactor& f : factors.parallelisms) {
      addAngle<ParallelismCost, 3>(f.landmarks, params_.parallelism_sigma);
    }
    setManifolds();
  }

  OptimizationReport solve() {
    if (problem_.NumResidualBlocks() == 0) return {};
    ceres::Solver::Options options;
    options.max_num_iterations = params_.max_iterations;
    options.linear_solver_type = ceres::SPARSE_SCHUR;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    // The plane blocks are eliminated first: they share no residuals but those of orthogonality.
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    return {summary.termination_type == ceres::CONVERGENCE,
            static_cast<int>(summary.iterations.size()), summary.initial_cost, summary.final_cost};
  }

  void write(std::vector<Eigen::Isometry3d>& map_from_keyframe,
             std::vector<Plane>& planes_in_map) const {
    for (std::size_t k = static_cast<std::size_t>(first_free_); k < poses_.size(); ++k) {
      map_from_keyframe[k].linear() = poses_[k].q.normalized().toRotationMatrix();
      map_from_keyframe[k].translation() = poses_[k].t;
    }
    for (std::size_t k = 0; k < planes_.size(); ++k) {
      if (plane_is_free_[k]) planes_in_map[k] = Plane::fromCoefficients(planes_[k].n, planes_[k].d);
    }
  }

 private:
  static ceres::Problem::Options problemOptions() {
    ceres::Problem::Options options;
    options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }

  void addPlaneFactor(const PlaneFactor& f) {
    if (!plane_is_free_[static_cast<std::size_t>(f.landmark)] || f.effective_samples <= 0.0) return;
    PoseBlock& pose = poses_[static_cast<std::size_t>(f.keyframe)];
    PlaneBlock& plane = planes_[static_cast<std::size_t>(f.landmark)];
    // A factor stands for `effective_samples` residuals of unit variance: the kernel acts on their
    // mean square.
    auto* loss = new ceres::CauchyLoss(params_.kernel_width * std::sqrt(f.effective_samples));
    problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<PlaneMomentCost, 4, 4, 3, 3, 1>(
                                  new PlaneMomentCost(f.moments_in_body)),
                              loss, pose.q.coeffs().data(), pose.t.data(), plane.n.data(),
                              &plane.d);
  }

  void addRelativePose(const RelativePoseFactor& f) {
    requireIndex(f.first, poses_.size(), "keyframe");
    requireIndex(f.second, poses_.size(), "keyframe");
    if (f.first < first_free_ && f.second < first_free_) return;
    PoseBlock& first = poses_[static_cast<std::size_t>(f.first)];
    PoseBlock& second = poses_[static_cast<std::size_t>(f.second)];
    problem_.AddResidualBlock(
        new ceres::AutoDiffCostFunction<RelativePoseCost, 6, 4, 3, 4, 3>(new RelativePoseCost(f)),
        f.is_loop ? new ceres::CauchyLoss(params_.loop_kernel_width) : nullptr,
        first.q.coeffs().data(), first.t.data(), second.q.coeffs().data(), second.t.data());
  }

  template <typename Cost, int kResiduals>
  void addAngle(const std::array<int, 2>& landmarks, double sigma) {
    for (const int landmark : landmarks) requireIndex(landmark, planes_.size(), "landmark");
    const auto a = static_cast<std::size_t>(landmarks[0]);
    const auto b = static_cast<std::size_t>(landmarks[1]);
    if (!params_.angles || (!plane_is_free_[a] && !plane_is_free_[b])) return;
    // Robust: a pair that other scans deny (a door that was moved) must not bend the map.
    problem_.AddResidualBlock(
        new ceres::AutoDiffCostFunction<Cost, kResiduals, 3, 3>(new Cost(sigma)),
        new ceres::CauchyLoss(params_.kernel_width), planes_[a].n.data(), planes_[b].n.data());
  }

  void setManifolds() {
    for (std::size_t k = 0; k < poses_.size(); ++k) {
      double* q = poses_[k].q.coeffs().data();
      if (!problem_.HasParameterBlock(q)) continue;
      problem_.SetManifold(q, &quaternion_manifold_);
      if (k >= static_cast<std::size_t>(first_free_)) continue;
      problem_.SetParameterBlockConstant(q);
      problem_.SetParameterBlockConstant(poses_[k].t.data());
    }
    for (std::size_t k = 0; k < planes_.size(); ++k) {
      if (!problem_.HasParameterBlock(planes_[k].n.data())) continue;
      problem_.SetManifold(planes_[k].n.data(), &sphere_manifold_);
      if (!plane_is_free_[k]) problem_.SetParameterBlockConstant(planes_[k].n.data());
    }
  }

  int first_free_;
  const BackendParams& params_;
  std::vector<PoseBlock> poses_;
  std::vector<PlaneBlock> planes_;
  std::vector<bool> plane_is_free_;
  ceres::EigenQuaternionManifold quaternion_manifold_;
  ceres::SphereManifold<3> sphere_manifold_;
  ceres::Problem problem_;
};

}  // namespace

OptimizationReport optimizeMap(const MapFactors& factors, int first_free,
                               const BackendParams& params,
                               std::vector<Eigen::Isometry3d>& map_from_keyframe,
                               std::vector<Plane>& planes_in_map) {
  if (first_free < 1) throw std::invalid_argument("optimizeMap: keyframe 0 must stay fixed");
  MapProblem problem(factors, first_free, params, map_from_keyframe, planes_in_map);
  const OptimizationReport report = problem.solve();
  problem.write(map_from_keyframe, planes_in_map);
  return report;
}

}  // namespace opp::mapping
