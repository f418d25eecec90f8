// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/joint_problem.h"

#include "refinement/plane_bookkeeping.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cstddef>

namespace opp {
namespace {

using Index = std::size_t;

}  // namespace

std::vector<NormalEstimate> normalEstimates(const std::vector<PlaneFit>& fits) {
  std::vector<NormalEstimate> result;
  for (const PlaneFit& fit : fits) {
    const Eigen::Vector3d normal = ownNormal(fit.moments.scatter(), fit.plane.normal());
    result.push_back({normal, fit.information(normal)});
  }
  return result;
}

std::vector<Eigen::Vector3d> familyNormals(const PlaneStructure& structure,
                                           const std::vector<PlaneFit>& fits) {
  std::vector<Eigen::Vector3d> normals;
  for (const std::vector<int>& family : structure.families) {
    normals.push_back(fits[static_cast<Index>(family.front())].plane.normal());
  }
  return normals;
}

NormalProblem normalProblem(const PlaneStructure& structure, const std::vector<PlaneFit>& fits,
                            const RefinementParams& params, bool rims) {
  NormalProblem problem;
  for (const std::vector<int>& family : structure.families) {
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const int plane : family) {
      const PlaneFit& fit = fits[static_cast<Index>(plane)];
      scatter += rims ? fit.information(fit.plane.normal()) : fit.moments.scatter();
    }
    problem.scatters.push_back(scatter);
  }
  problem.frames = structure.frames;
  const double variance = params.systematic_angle * params.systematic_angle;
  for (const std::array<int, 2>& edge : structure.soft_edges) {
    problem.soft_edges.push_back({edge, 1.0 / std::max(variance, kLeastAngleVariance)});
  }
  return problem;
}

void markUncertain(const PlaneStructure& structure, const std::vector<Eigen::Vector3d>& normals,
                   const RefinementParams& params, std::vector<PlaneFit>& fits) {
  const Eigen::MatrixXd covariance =
      normalCovariance(normalProblem(structure, fits, params, true), normals);
  const double limit = params.max_uncertainty * params.max_uncertainty;
  for (Index k = 0; k < fits.size(); ++k) {
    const Eigen::Index at = 2 * structure.family_of[k];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(covariance.block<2, 2>(at, at),
                                                               Eigen::EigenvaluesOnly);
    fits[k].uncertain = eigen.eigenvalues()[1] > limit;
  }
}

}  // namespace opp
