// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/registration/corner_icp.h"

#include "opp/geometry/median.h"

#include <Eigen/Cholesky>
#include <nanoflann.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace opp::mapping {
namespace {

/// The view of a cloud that nanoflann asks for.
struct CloudAdaptor {
  const std::vector<Eigen::Vector3f>& points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t k) const {
    return points[i][static_cast<Eigen::Index>(k)];
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, CloudAdaptor>,
                                                 CloudAdaptor, 3>;

/// Directions of (ω about the pivot, v) that the constraint leaves free, as columns.
Eigen::Matrix<double, 6, Eigen::Dynamic> freeDirections(const CornerConstraint& constraint) {
  Eigen::Matrix<double, 6, Eigen::Dynamic> basis =
      Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, constraint.dof);
  if (constraint.dof == 6) basis.setIdentity();
  if (constraint.dof == 3) basis.topRows<3>().setIdentity();
  if (constraint.dof == 1) basis.col(0).head<3>() = constraint.axis_in_target;
  return basis;
}

struct Match {
  Vector6d jacobian;  ///< of the residual, by (ω about the pivot, v)
  double residual;    ///< [m]
};

class Icp {
 public:
  Icp(const OrientedCloud& target, const OrientedCloud& source, const CornerConstraint& constraint,
      const CornerIcpParams& params)
      : target_(target),
        source_(source),
        params_(params),
        pivot_(constraint.pivot_in_target),
        free_(freeDirections(constraint)),
        adaptor_{target.points},
        tree_(3, adaptor_, nanoflann::KDTreeSingleIndexAdaptorParams(10)) {
    result_.target_from_source = constraint.target_from_source;
    result_.dof = constraint.dof;
    result_.converged = constraint.dof == 0;
    tree_.buildIndex();
  }

  CornerIcpResult run() {
    while (!result_.converged && result_.iterations < params_.max_iterations) {
      findMatches();
      if (matches_.size() < static_cast<std::size_t>(result_.dof)) break;
      step();
    }
    findMatches();
    report();
    return result_;
  }

 private:
  void findMatches() {
    matches_.clear();
    const Eigen::Isometry3f pose = result_.target_from_source.cast<float>();
    const auto max_square = static_cast<float>(params_.max_distance * params_.max_distance);
    const auto min_cosine = static_cast<float>(std::cos(params_.normal_gate));
    for (std::size_t i = 0; i < source_.size() && target_.size() > 0; ++i) {
      const Eigen::Vector3f point = pose * source_.points[i];
      std::uint32_t nearest = 0;
      float square = 0.0F;
      tree_.knnSearch(point.data(), 1, &nearest, &square);
      const Eigen::Vector3f& normal = target_.normals[nearest];
      if (square > max_square || normal.dot(pose.linear() * source_.normals[i]) < min_cosine) {
        continue;
      }
      const Eigen::Vector3d n = normal.cast<double>();
      Match match;
      match.jacobian << (point.cast<double>() - pivot_).cross(n), n;
      match.residual = static_cast<double>(normal.dot(point - target_.points[nearest]));
      matches_.push_back(match);
    }
  }

  /// Median of the absolute residuals; robust scale of the kernel.
  double scale() const {
    std::vector<double> sizes;
    for (const Match& m : matches_) sizes.push_back(std::abs(m.residual));
    return std::max(medianOf(std::move(sizes)), 1e-9);
  }

  Eigen::MatrixXd normalEquations(Eigen::VectorXd& gradient) const {
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(result_.dof, result_.dof);
    gradient = Eigen::VectorXd::Zero(result_.dof);
    const double width = params_.kernel_width * scale();
    for (const Match& m : matches_) {
      const double weight = 1.0 / (1.0 + m.residual * m.residual / (width * width));
      const Eigen::VectorXd j = free_.transpose() * m.jacobian;
      hessian.noalias() += weight * j * j.transpose();
      gradient.noalias() += weight * m.residual * j;
    }
    // Directions that the points do not fix are left alone.
    hessian.diagonal().array() += 1e-9 * std::max(1e-9, hessian.diagonal().maxCoeff());
    return hessian;
  }

  void step() {
    Eigen::VectorXd gradient;
    const Eigen::MatrixXd hessian = normalEquations(gradient);
    const Vector6d move = free_ * -hessian.ldlt().solve(gradient);
    Eigen::Isometry3d about_pivot = Eigen::Isometry3d::Identity();
    about_pivot.linear() = retract(about_pivot, move).linear();
    about_pivot.translation() = pivot_ - about_pivot.linear() * pivot_ + move.tail<3>();
    result_.target_from_source = normalized(about_pivot * result_.target_from_source);
    ++result_.iterations;
    result_.converged = move.head<3>().norm() < params_.rotation_tolerance &&
                        move.tail<3>().norm() < params_.translation_tolerance;
  }

  void report() {
    result_.matches = static_cast<int>(matches_.size());
    if (matches_.empty()) return;
    double sum = 0.0;
    for (const Match& m : matches_) sum += m.residual * m.residual;
    result_.rms = std::sqrt(sum / static_cast<double>(matches_.size()));
    if (result_.dof == 0) return;
    Eigen::VectorXd gradient;
    const Eigen::MatrixXd hessian = normalEquations(gradient);
    const Eigen::MatrixXd inverse =
        hessian.ldlt().solve(Eigen::MatrixXd::Identity(result_.dof, result_.dof));
    // From (ω about the pivot, v) to `retract`'s: the source's origin moves by ω × (t − pivot) + v.
    Matrix6d from_pivot = Matrix6d::Identity();
    const Eigen::Vector3d arm = result_.target_from_source.translation() - pivot_;
    for (int k = 0; k < 3; ++k) {
      from_pivot.block<3, 1>(3, k) = Eigen::Vector3d::Unit(k).cross(arm);
    }
    const Eigen::MatrixXd basis = from_pivot * free_;
    result_.covariance = result_.rms * result_.rms * basis * inverse * basis.transpose();
  }

  const OrientedCloud& target_;
  const OrientedCloud& source_;
  const CornerIcpParams& params_;
  Eigen::Vector3d pivot_;
  Eigen::Matrix<double, 6, Eigen::Dynamic> free_;
  CloudAdaptor adaptor_;
  Tree tree_;
  std::vector<Match> matches_;
  CornerIcpResult result_;
};

}  // namespace

CornerIcpResult cornerIcp(const OrientedCloud& target, const OrientedCloud& source,
                          const std::vector<CornerPair>& corners,
                          const Eigen::Isometry3d& initial_target_from_source,
                          const CornerIcpParams& params) {
  validate(params);
  const CornerConstraint constraint =
      cornerConstraint(corners, initial_target_from_source, params.collinear_spread);
  return Icp(target, source, constraint, params).run();
}

}  // namespace opp::mapping
