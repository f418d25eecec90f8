// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/refinement/find_structure.h"

#include "opp/geometry/plane.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace opp {
namespace {

/// A normal with the covariance of its direction as a 3×3 matrix of rank 2 [rad²].
struct Direction {
  Eigen::Vector3d normal;
  Eigen::Matrix3d covariance;
  Eigen::Matrix3d scatter;
};

Direction directionOf(const Eigen::Vector3d& normal, const Eigen::Matrix3d& scatter) {
  const Eigen::Matrix<double, 3, 2> tangents = tangentBasis(normal);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(tangents.transpose() * scatter *
                                                             tangents);
  // One unit of information more than the data have: unobserved directions get 1 rad².
  const Eigen::Vector2d variances = (eigen.eigenvalues().cwiseMax(0.0).array() + 1.0).inverse();
  const Eigen::Matrix<double, 3, 2> axes = tangents * eigen.eigenvectors();
  return {normal, axes * variances.asDiagonal() * axes.transpose(), scatter};
}

/// Best common normal of two sets of parallel planes.
Direction merged(const Direction& a, const Direction& b) {
  const Eigen::Matrix3d scatter = a.scatter + b.scatter;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter);
  const Eigen::Vector3d normal = eigen.eigenvectors().col(0);
  // Points on a line fix no normal: keep the direction that is known.
  if (!(std::abs(normal.dot(a.normal)) > 0.5)) return directionOf(a.normal, scatter);
  return directionOf(normal.dot(a.normal) < 0.0 ? Eigen::Vector3d(-normal) : normal, scatter);
}

class StructureFinder {
 public:
  StructureFinder(const std::vector<NormalEstimate>& planes, const RefinementParams& params)
      : planes_(planes), params_(params) {}

  PlaneStructure find(const std::vector<OrthogonalityEdge>& edges) {
    result_.family_of.assign(planes_.size(), -1);
    groupParallels();
    linkFamilies(edges);
    chooseFrames();
    return std::move(result_);
  }

 private:
  using Index = std::size_t;

  /// χ² (2 degrees of freedom) of "parallel" over its bound; > 1: denied.
  double parallelMisfit(const Direction& a, const Direction& b) const {
    const Eigen::Vector3d other = a.normal.dot(b.normal) < 0.0 ? -b.normal : b.normal;
    const double angle = std::atan2(a.normal.cross(other).norm(), a.normal.dot(other));
    if (angle > params_.max_correction) return 2.0;
    const Eigen::Matrix<double, 3, 2> tangents = tangentBasis(a.normal);
    const Eigen::Vector2d deviation = tangents.transpose() * other;
    Eigen::Matrix2d covariance = tangents.transpose() * (a.covariance + b.covariance) * tangents;
    covariance.diagonal().array() += params_.systematic_angle * params_.systematic_angle;
    // Quantile of χ²₂ for the probability of a normal variable to stay within test_sigmas.
    const double bound = -2.0 * std::log(std::erfc(params_.test_sigmas / std::sqrt(2.0)));
    return deviation.dot(covariance.inverse() * deviation) / bound;
  }

  bool orthogonal(const Direction& a, const Direction& b) const {
    const double cosine = a.normal.dot(b.normal);
    if (std::abs(cosine) > std::sin(params_.max_correction)) return false;
    const double variance = b.normal.dot(a.covariance * b.normal) +
                            a.normal.dot(b.covariance * a.normal) +
                            params_.systematic_angle * params_.systematic_angle;
    return cosine * cosine <= params_.test_sigmas * params_.test_sigmas * variance;
  }

  void groupParallels() {
    std::vector<Index> order(planes_.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(), [this](Index a, Index b) {
      return planes_[a].scatter.trace() > planes_[b].scatter.trace();
    });
    for (const Index plane : order) {
      const Direction own = directionOf(planes_[plane].normal, planes_[plane].scatter);
      Index best = directions_.size();
      double least = 1.0;
      for (Index family = 0; family < directions_.size(); ++family) {
        const double misfit = parallelMisfit(directions_[family], own);
        if (misfit < least) {
          least = misfit;
          best = family;
        }
      }
      if (best == directions_.size()) {
        directions_.push_back(own);
        result_.families.emplace_back();
      } else {
        directions_[best] = merged(directions_[best], own);
      }
      result_.families[best].push_back(static_cast<int>(plane));
      result_.family_of[plane] = static_cast<int>(best);
    }
    for (std::vector<int>& family : result_.families) std::sort(family.begin(), family.end());
  }

  /// Keeps the edges that pass, and finds the components of families that they link.
  void linkFamilies(const std::vector<OrthogonalityEdge>& edges) {
    component_.resize(directions_.size());
    std::iota(component_.begin(), component_.end(), Index{0});
    for (const OrthogonalityEdge& edge : edges) {
      const auto a = static_cast<Index>(result_.family_of[static_cast<Index>(edge.planes[0])]);
      const auto b = static_cast<Index>(result_.family_of[static_cast<Index>(edge.planes[1])]);
      if (a == b || !orthogonal(directions_[a], directions_[b])) continue;
      result_.edges.push_back(edge);
      const Index from = std::max(component_[a], component_[b]);
      const Index to = std::min(component_[a], component_[b]);
      std::replace(component_.begin(), component_.end(), from, to);
    }
  }

  bool linked(Index a, Index b) const {
    return component_[a] == component_[b] && orthogonal(directions_[a], directions_[b]);
  }

  /// Greedy: the orthogonal triples with most information first, then pairs; the rest stays soft.
  void chooseFrames() {
    const Index count = directions_.size();
    std::vector<NormalProblem::Frame> candidates;
    for (Index a = 0; a < count; ++a) {
      for (Index b = a + 1; b < count; ++b) {
        if (!linked(a, b)) continue;
        result_.soft_edges.push_back({static_cast<int>(a), static_cast<int>(b)});
        candidates.push_back({static_cast<int>(a), static_cast<int>(b)});
        for (Index c = b + 1; c < count; ++c) {
          if (!linked(a, c) || !linked(b, c)) continue;
          candidates.push_back({static_cast<int>(a), static_cast<int>(b), static_cast<int>(c)});
        }
      }
    }
    const auto information = [this](const NormalProblem::Frame& frame) {
      double sum = 0.0;
      for (const int family : frame) sum += directions_[static_cast<Index>(family)].scatter.trace();
      return sum;
    };
    std::stable_sort(candidates.begin(), candidates.end(), [&](const auto& a, const auto& b) {
      return a.size() != b.size() ? a.size() > b.size() : information(a) > information(b);
    });
    std::vector<int> frame_of(count, -1);
    for (const NormalProblem::Frame& frame : candidates) {
      const auto taken = [&](int family) { return frame_of[static_cast<Index>(family)] >= 0; };
      if (std::any_of(frame.begin(), frame.end(), taken)) continue;
      for (const int family : frame) {
        frame_of[static_cast<Index>(family)] = static_cast<int>(result_.frames.size());
      }
      result_.frames.push_back(frame);
    }
    const auto exact = [&](const std::array<int, 2>& pair) {
      const int frame = frame_of[static_cast<Index>(pair[0])];
      return frame >= 0 && frame == frame_of[static_cast<Index>(pair[1])];
    };
    result_.soft_edges.erase(
        std::remove_if(result_.soft_edges.begin(), result_.soft_edges.end(), exact),
        result_.soft_edges.end());
  }

  const std::vector<NormalEstimate>& planes_;
  const RefinementParams& params_;
  PlaneStructure result_;
  std::vector<Direction> directions_;  ///< per family
  std::vector<Index> component_;       ///< per family
};

}  // namespace

PlaneStructure findStructure(const std::vector<NormalEstimate>& planes,
                             const std::vector<OrthogonalityEdge>& edges,
                             const RefinementParams& params) {
  return StructureFinder(planes, params).find(edges);
}

}  // namespace opp
