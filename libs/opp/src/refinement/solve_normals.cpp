// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/refinement/solve_normals.h"

#include "opp/geometry/plane.h"

#include "refinement/normal_components.h"
#include "refinement/solve_alone.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <stdexcept>

namespace opp {
namespace {

using Normals = std::vector<Eigen::Vector3d>;

/// Where each normal's parameters begin, and how many there are in all.
struct Layout {
  std::vector<Eigen::Index> first;
  std::vector<bool> in_frame;
  Eigen::Index size = 0;
};

Layout layoutOf(const NormalProblem& problem) {
  Layout layout;
  layout.first.assign(problem.scatters.size(), -1);
  layout.in_frame.assign(problem.scatters.size(), false);
  for (const NormalProblem::Frame& frame : problem.frames) {
    for (const int normal : frame) {
      layout.first[static_cast<std::size_t>(normal)] = layout.size;
      layout.in_frame[static_cast<std::size_t>(normal)] = true;
    }
    layout.size += 3;
  }
  for (Eigen::Index& first : layout.first) {
    if (first >= 0) continue;
    first = layout.size;
    layout.size += 2;
  }
  return layout;
}

/// ∂n/∂parameters (3×3, or 3×2 for a free normal).
Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> derivative(const Eigen::Vector3d& n,
                                                             bool in_frame) {
  if (!in_frame) return tangentBasis(n);
  Eigen::Matrix3d minus_cross;  // ω × n = −n × ω
  minus_cross << 0.0, n.z(), -n.y(), -n.z(), 0.0, n.x(), n.y(), -n.x(), 0.0;
  return minus_cross;
}

void check(const NormalProblem& problem, std::size_t normals) {
  const auto fail = [] {
    throw std::invalid_argument("a normal problem's normals, frames and edges do not fit together");
  };
  if (normals != problem.scatters.size()) fail();
  std::vector<bool> used(normals, false);
  const auto valid = [&](int index) {
    return index >= 0 && static_cast<std::size_t>(index) < normals;
  };
  for (const NormalProblem::Frame& frame : problem.frames) {
    if (frame.size() != 2 && frame.size() != 3) fail();
    for (const int index : frame) {
      if (!valid(index) || used[static_cast<std::size_t>(index)]) fail();
      used[static_cast<std::size_t>(index)] = true;
    }
  }
  for (const NormalProblem::SoftEdge& edge : problem.soft_edges) {
    if (!valid(edge.normals[0]) || !valid(edge.normals[1])) fail();
  }
}

/// Nearest orthonormal frame to the frame's normals (polar decomposition).
void orthonormalize(const NormalProblem::Frame& frame, Normals& normals) {
  Eigen::Matrix<double, 3, Eigen::Dynamic> columns(3, static_cast<Eigen::Index>(frame.size()));
  for (std::size_t k = 0; k < frame.size(); ++k) {
    columns.col(static_cast<Eigen::Index>(k)) = normals[static_cast<std::size_t>(frame[k])];
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(columns, Eigen::ComputeThinU | Eigen::ComputeThinV);
  columns = svd.matrixU() * svd.matrixV().transpose();
  for (std::size_t k = 0; k < frame.size(); ++k) {
    normals[static_cast<std::size_t>(frame[k])] = columns.col(static_cast<Eigen::Index>(k));
  }
}

}  // namespace

double energy(const NormalProblem& problem, const Normals& normals) {
  double sum = 0.0;
  for (std::size_t k = 0; k < normals.size(); ++k) {
    sum += normals[k].dot(problem.scatters[k] * normals[k]);
  }
  for (const NormalProblem::SoftEdge& edge : problem.soft_edges) {
    const double cosine = normals[static_cast<std::size_t>(edge.normals[0])].dot(
        normals[static_cast<std::size_t>(edge.normals[1])]);
    sum += edge.information * cosine * cosine;
  }
  return sum;
}

NormalSystem linearize(const NormalProblem& problem, const Normals& normals) {
  const Layout layout = layoutOf(problem);
  NormalSystem system{Eigen::MatrixXd::Zero(layout.size, layout.size),
                      Eigen::VectorXd::Zero(layout.size)};
  for (std::size_t k = 0; k < normals.size(); ++k) {
    const auto jacobian = derivative(normals[k], layout.in_frame[k]);
    const Eigen::Index at = layout.first[k], size = jacobian.cols();
    system.information.block(at, at, size, size) +=
        jacobian.transpose() * problem.scatters[k] * jacobian;
    system.gradient.segment(at, size) += jacobian.transpose() * (problem.scatters[k] * normals[k]);
  }
  for (const NormalProblem::SoftEdge& edge : problem.soft_edges) {
    const auto a = static_cast<std::size_t>(edge.normals[0]);
    const auto b = static_cast<std::size_t>(edge.normals[1]);
    const auto jacobian_a = derivative(normals[a], layout.in_frame[a]);
    const auto jacobian_b = derivative(normals[b], layout.in_frame[b]);
    // The cosine's derivative has these two parts; only their blocks change.
    const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> row_a =
        jacobian_a.transpose() * normals[b];
    const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> row_b =
        jacobian_b.transpose() * normals[a];
    const auto add = [&](std::size_t k, const auto& row_k, std::size_t l, const auto& row_l) {
      system.information.block(layout.first[k], layout.first[l], row_k.size(), row_l.size()) +=
          edge.information * row_k * row_l.transpose();
    };
    add(a, row_a, a, row_a);
    add(a, row_a, b, row_b);
    add(b, row_b, a, row_a);
    add(b, row_b, b, row_b);
    const double pull = edge.information * normals[a].dot(normals[b]);
    system.gradient.segment(layout.first[a], row_a.size()) += pull * row_a;
    system.gradient.segment(layout.first[b], row_b.size()) += pull * row_b;
  }
  return system;
}

Normals retract(const NormalProblem& problem, const Normals& normals, const Eigen::VectorXd& step) {
  const Layout layout = layoutOf(problem);
  Normals moved(normals.size());
  for (std::size_t k = 0; k < normals.size(); ++k) {
    if (layout.in_frame[k]) {
      const Eigen::Vector3d omega = step.segment<3>(layout.first[k]);
      const double angle = omega.norm();
      moved[k] = angle > 0.0 ? Eigen::AngleAxisd(angle, omega / angle) * normals[k] : normals[k];
    } else {
      moved[k] = normals[k] + tangentBasis(normals[k]) * step.segment<2>(layout.first[k]);
    }
    moved[k].normalize();
  }
  return moved;
}

namespace {

Normals partOf(const Normals& normals, const NormalComponent& component) {
  Normals part;
  for (const std::size_t k : component.normals) part.push_back(normals[k]);
  return part;
}

NormalSolution solveJointly(const NormalProblem& problem, const Normals& initial) {
  NormalSolution solution;
  solution.normals = initial;
  solution.converged = initial.empty();
  for (const auto& frame : problem.frames) orthonormalize(frame, solution.normals);
  double rounding = 0.0;
  for (const auto& scatter : problem.scatters) rounding += kEnergyRounding * scatter.trace();
  StepDamping damping(energy(problem, solution.normals), rounding);
  for (int step_count = 0; step_count < kMaxSteps && !solution.converged; ++step_count) {
    NormalSystem system = linearize(problem, solution.normals);
    system.information.diagonal() *= 1.0 + damping.value();
    system.information.diagonal().array() += kPriorInformation;
    const Eigen::VectorXd step = -system.information.llt().solve(system.gradient);
    solution.converged = step.lpNorm<Eigen::Infinity>() < kStepTolerance;
    const Normals candidate = retract(problem, solution.normals, step);
    if (damping.accepts(energy(problem, candidate))) solution.normals = candidate;
  }
  for (const auto& frame : problem.frames) orthonormalize(frame, solution.normals);
  return solution;
}

Eigen::MatrixXd jointCovariance(const NormalProblem& problem, const Normals& normals) {
  const Layout layout = layoutOf(problem);
  Eigen::MatrixXd information = linearize(problem, normals).information;
  information.diagonal().array() += kPriorInformation;
  const auto count = static_cast<Eigen::Index>(normals.size());
  Eigen::MatrixXd tangent_from_parameters = Eigen::MatrixXd::Zero(2 * count, layout.size);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto index = static_cast<std::size_t>(k);
    const auto jacobian = derivative(normals[index], layout.in_frame[index]);
    tangent_from_parameters.block(2 * k, layout.first[index], 2, jacobian.cols()) =
        tangentBasis(normals[index]).transpose() * jacobian;
  }
  return tangent_from_parameters * information.llt().solve(tangent_from_parameters.transpose());
}

}  // namespace

NormalSolution solveNormals(const NormalProblem& problem, const Normals& initial) {
  check(problem, initial.size());
  NormalSolution solution{initial, true};
  for (const NormalComponent& component : normalComponents(problem)) {
    if (component.normals.size() == 1) {
      Eigen::Vector3d& normal = solution.normals[component.normals.front()];
      solution.converged =
          solveAlone(component.problem.scatters.front(), normal) && solution.converged;
      continue;
    }
    const NormalSolution part = solveJointly(component.problem, partOf(initial, component));
    solution.converged = solution.converged && part.converged;
    for (std::size_t k = 0; k < component.normals.size(); ++k) {
      solution.normals[component.normals[k]] = part.normals[k];
    }
  }
  return solution;
}

Eigen::MatrixXd normalCovariance(const NormalProblem& problem, const Normals& normals) {
  check(problem, normals.size());
  const auto size = static_cast<Eigen::Index>(2 * normals.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
  for (const NormalComponent& component : normalComponents(problem)) {
    const Eigen::MatrixXd part = jointCovariance(component.problem, partOf(normals, component));
    for (std::size_t k = 0; k < component.normals.size(); ++k) {
      for (std::size_t l = 0; l < component.normals.size(); ++l) {
        covariance.block<2, 2>(static_cast<Eigen::Index>(2 * component.normals[k]),
                               static_cast<Eigen::Index>(2 * component.normals[l])) =
            part.block<2, 2>(static_cast<Eigen::Index>(2 * k), static_cast<Eigen::Index>(2 * l));
      }
    }
  }
  return covariance;
}

}  // namespace opp
