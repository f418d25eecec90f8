// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>
#include <vector>

namespace opp {

/// Joint estimation of normals. The offsets of the planes are eliminated (d = −n·mean is optimal
/// for every n), so that the energy of Sommer et al. 2020, Eq. 11, depends on the normals alone:
///
///   E(n) = Σ_f n_fᵀ scatter_f n_f + Σ_e λ_e (n_f·n_g)².
///
/// With scatter = G Gᵀ the residual of a family is Gᵀn: three numbers for all points of all its
/// planes.
struct NormalProblem {
  /// Normals that are kept orthogonal exactly: they turn together, one rotation in SO(3) for two or
  /// three of them.
  using Frame = std::vector<int>;
  struct SoftEdge {
    std::array<int, 2> normals{};
    double information = 0.0;  ///< λ = 1/σ² of the cosine [1/rad²]
  };
  std::vector<Eigen::Matrix3d> scatters;  ///< per normal: Σ w (x−mean)(x−mean)ᵀ, weights 1/σ²
  std::vector<Frame> frames;              ///< disjoint; normals in none are free on S²
  std::vector<SoftEdge> soft_edges;       ///< λ-terms of Eq. 10
};

struct NormalSolution {
  std::vector<Eigen::Vector3d> normals;
  bool converged = true;
};

/// E(n) of the problem.
double energy(const NormalProblem& problem, const std::vector<Eigen::Vector3d>& normals);

/// ½ gradient and Gauss–Newton matrix of E with respect to the problem's parameters: three per
/// frame (rotation vector ω, n ← exp(ω) n), then two per free normal (in its `tangentBasis`).
struct NormalSystem {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
};
NormalSystem linearize(const NormalProblem& problem, const std::vector<Eigen::Vector3d>& normals);

/// Moves the normals by a step in the parameters of `linearize`.
std::vector<Eigen::Vector3d> retract(const NormalProblem& problem,
                                     const std::vector<Eigen::Vector3d>& normals,
                                     const Eigen::VectorXd& step);

/// Minimizes E from `initial` unit normals (frames need not be orthogonal yet: they are projected
/// to the nearest orthonormal frame first). Dense Levenberg–Marquardt: with the offsets eliminated,
/// a scan has 3 to some 20 unknowns, which Eigen solves in microseconds; building a ceres::Problem
/// would take longer than solving.
/// \throws std::invalid_argument if sizes or indices do not fit or a frame has not 2 or 3 members.
NormalSolution solveNormals(const NormalProblem& problem,
                            const std::vector<Eigen::Vector3d>& initial);

/// Joint covariance of the solution [rad²]: the 2×2 block (f, g) belongs to the coordinates of n_f
/// and n_g in their `tangentBasis`. Directions that the data do not fix have a variance of about
/// 1 rad². \throws std::invalid_argument as `solveNormals`.
Eigen::MatrixXd normalCovariance(const NormalProblem& problem,
                                 const std::vector<Eigen::Vector3d>& normals);

}  // namespace opp
