// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/surface_shape.h"

#include "geometry/planar_spread.h"
#include "geometry/surface_turn.h"
#include "refinement/plane_bookkeeping.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <utility>

namespace opp {
namespace {

/// Distance of two layers over the standard deviation within them. Cut in halves, a Gaussian has
/// 2.7 and a uniform distribution 3.5; two that do not overlap have 4 and more.
constexpr double kSeparation = 4.5;
constexpr int kMaxSplitSteps = 20;
/// Layers stand apart at once, cut at their common mean: what is this far from it after the first
/// cut is one layer.
constexpr double kHopeless = 3.0;

/// Sums of the regression of normals on places, both in the plane's tangent coordinates.
struct TurnSums {
  Eigen::Matrix2d places = Eigen::Matrix2d::Zero();   ///< Σ t tᵀ, t from the mean place
  Eigen::Matrix2d crossed = Eigen::Matrix2d::Zero();  ///< Σ m tᵀ
  Eigen::Vector2d tilts = Eigen::Vector2d::Zero();    ///< Σ m
  Eigen::Vector2d mean_place = Eigen::Vector2d::Zero();
  double tilt_squares = 0.0;  ///< Σ |m|²
  double count = 0.0;

  /// Number by number: vectors would be stored in parts and loaded whole, which stalls the loop.
  void add(double x, double y, double tilt_x, double tilt_y) {
    places(0, 0) += x * x, places(1, 0) += y * x, places(0, 1) += x * y, places(1, 1) += y * y;
    crossed(0, 0) += tilt_x * x, crossed(1, 0) += tilt_y * x;
    crossed(0, 1) += tilt_x * y, crossed(1, 1) += tilt_y * y;
    mean_place[0] += x, mean_place[1] += y;
    tilts[0] += tilt_x, tilts[1] += tilt_y;
    tilt_squares += tilt_x * tilt_x + tilt_y * tilt_y;
    count += 1.0;
  }
};

bool turns(const TurnSums& sums, const RefinementParams& params) {
  if (sums.count < 3.0) return false;
  const Eigen::Vector2d place = sums.mean_place / sums.count, tilt = sums.tilts / sums.count;
  const Eigen::Matrix2d spread = sums.places / sums.count - place * place.transpose();
  const Eigen::Matrix2d joint = sums.crossed / sums.count - tilt * place.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(spread);
  double turn = 0.0;
  double scatter = sums.tilt_squares / sums.count - tilt.squaredNorm();
  for (int k = 0; k < 2; ++k) {
    const double deviation = std::sqrt(std::max(axes.eigenvalues()[k], 0.0));
    if (!(deviation > 0.0)) continue;
    // Tilt per standard deviation of the place; an even strip is √12 standard deviations wide.
    const double explained = (joint * axes.eigenvectors().col(k)).norm() / deviation;
    turn = std::max(turn, std::sqrt(12.0) * explained);
    scatter -= explained * explained;
  }
  scatter = std::max(0.0, scatter);
  const double error = std::sqrt(12.0 * scatter / sums.count);
  return turn > params.max_turn && turn > params.test_sigmas * error;
}

/// Whether the samples' places deny that the surface turns by max_turn across their extent. Normals
/// near its rims lean toward what it borders on, as if it were curved; places do so much less.
bool placesDeny(const std::vector<WeightedSample>& samples,
                const std::vector<std::uint32_t>& members, const PlaneFit& fit,
                const RefinementParams& params) {
  const Eigen::Matrix<double, 3, 2> tangents = tangentBasis(fit.plane.normal());
  const Eigen::Vector3d mean = fit.moments.mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(
      tangents.transpose() * fit.moments.scatter() * tangents / fit.moments.weight());
  const Eigen::Vector2d widths = PlanarSpread::widthsOf(axes.eigenvalues());
  if (!(widths.minCoeff() > 0.0)) return false;
  const Eigen::Matrix<double, 3, 2> directions = tangents * axes.eigenvectors();
  SurfaceTurn surface(widths);
  for (const std::uint32_t i : members) {
    surface.add(directions.transpose() * (samples[i].point - mean),
                fit.plane.signedDistance(samples[i].point), samples[i].variance);
  }
  const SurfaceTurn::Turns turns = surface.turns();
  const auto isSmall = [&](const SurfaceTurn::Turn& turn) {
    return turn.angle + params.test_sigmas * turn.error <= params.max_turn;
  };
  return isSmall(turns.first) && isSmall(turns.second);
}

/// Samples of one plane, in two layers.
class Layers {
 public:
  Layers(const std::vector<WeightedSample>& samples, const std::vector<std::uint32_t>& members,
         const PlaneFit& fit)
      : normal_(fit.plane.normal()), reach_(fit.reach) {
    for (const std::uint32_t i : members) {
      members_.push_back(&samples[i]);
      upper_.push_back(fit.plane.signedDistance(samples[i].point) > 0.0);
    }
  }

  /// Alternates between fitting two parallel planes and giving each sample to the nearer.
  void separate() {
    bool changed = true;
    for (int step = 0; step < kMaxSplitSteps && changed; ++step) {
      fit();
      if (!(separation() > kHopeless)) return;
      const double middle = 0.5 * (positionOf(0) + positionOf(1));
      changed = false;
      for (std::size_t i = 0; i < members_.size(); ++i) {
        const bool upper = normal_.dot(members_[i]->point) > middle;
        changed = changed || upper != upper_[i];
        upper_[i] = upper;
      }
    }
    fit();
  }

  bool distinct(const RefinementParams& params) const {
    for (const SampleSums& layer : layers_) {
      if (layer.support < params.min_support) return false;
    }
    return separation() > kSeparation;
  }

  std::array<PlaneFit, 2> fits() const {
    std::array<PlaneFit, 2> result;
    for (std::size_t k = 0; k < 2; ++k) {
      result[k].plane = Plane::fromPointNormal(moments_[k].mean(), normal_);
      result[k].sums = layers_[k];
      result[k].moments = moments_[k];
      result[k].reach = reach_;
    }
    if (result[0].sums.support < result[1].sums.support) std::swap(result[0], result[1]);
    return result;
  }

 private:
  /// Distance of the layers over the standard deviation within them; NaN if one is empty.
  double separation() const {
    double squares = 0.0;
    for (const PointMoments& moments : moments_) {
      squares += normal_.dot(moments.scatter() * normal_) / moments.weight();
    }
    return (positionOf(1) - positionOf(0)) / std::sqrt(0.5 * squares);
  }

  double positionOf(std::size_t layer) const { return normal_.dot(moments_[layer].mean()); }

  void fit() {
    layers_ = {};
    for (std::size_t i = 0; i < members_.size(); ++i) {
      SampleSums& layer = layers_[upper_[i] ? 1 : 0];
      if (layer.support == 0) layer.origin = members_[i]->point;
      // Every member is an inlier: weight 1.
      layer.add(*members_[i], 0.0, 0.0, 0.0);
    }
    moments_ = {layers_[0].moments(), layers_[1].moments()};
    normal_ = ownNormal(moments_[0].scatter() + moments_[1].scatter(), normal_);
  }

  Eigen::Vector3d normal_;
  Eigen::AlignedBox3d reach_;
  std::vector<const WeightedSample*> members_;
  std::vector<bool> upper_;
  std::array<SampleSums, 2> layers_;
  std::array<PointMoments, 2> moments_;
};

}  // namespace

void markCurved(const std::vector<WeightedSample>& samples, const std::vector<int>& labels,
                const RefinementParams& params, std::vector<PlaneFit>& fits) {
  std::vector<TurnSums> sums(fits.size());
  std::vector<Eigen::Matrix<double, 3, 2>> tangents;
  for (const PlaneFit& fit : fits) tangents.push_back(tangentBasis(fit.plane.normal()));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (labels[i] < 0) continue;
    const auto k = static_cast<std::size_t>(labels[i]);
    const double sign = samples[i].normal.dot(fits[k].plane.normal()) < 0.0 ? -1.0 : 1.0;
    const Eigen::Vector3d step = samples[i].point - fits[k].moments.mean();
    sums[k].add(tangents[k].col(0).dot(step), tangents[k].col(1).dot(step),
                sign * tangents[k].col(0).dot(samples[i].normal),
                sign * tangents[k].col(1).dot(samples[i].normal));
  }
  std::vector<std::vector<std::uint32_t>> members;
  for (std::size_t k = 0; k < fits.size(); ++k) {
    fits[k].curved = turns(sums[k], params);
    if (!fits[k].curved) continue;
    if (members.empty()) members = membersOf(labels, fits.size());
    fits[k].curved = !placesDeny(samples, members[k], fits[k], params);
  }
}

std::optional<std::array<PlaneFit, 2>> splitLayers(const std::vector<WeightedSample>& samples,
                                                   const std::vector<std::uint32_t>& members,
                                                   const PlaneFit& fit,
                                                   const RefinementParams& params) {
  Layers layers(samples, members, fit);
  layers.separate();
  if (!layers.distinct(params)) return std::nullopt;
  return layers.fits();
}

bool splitPlanes(const std::vector<WeightedSample>& samples, const std::vector<int>& labels,
                 const RefinementParams& params, std::vector<PlaneFit>& fits,
                 std::vector<OrthogonalityEdge>& edges) {
  const std::size_t count = fits.size();
  const auto members = membersOf(labels, count);
  for (std::size_t k = 0; k < count; ++k) {
    if (fits[k].slack <= 0.0) continue;
    auto layers = splitLayers(samples, members[k], fits[k], params);
    if (!layers) continue;
    fits[k] = (*layers)[0];
    const int half = static_cast<int>(fits.size());
    fits.push_back((*layers)[1]);
    const std::vector<OrthogonalityEdge> before = edges;
    for (const OrthogonalityEdge& edge : before) {
      const auto [a, b] = edge.planes;
      if (a == static_cast<int>(k)) edges.push_back({{b, half}, edge.votes});
      if (b == static_cast<int>(k)) edges.push_back({{a, half}, edge.votes});
    }
  }
  return fits.size() != count;
}

}  // namespace opp
