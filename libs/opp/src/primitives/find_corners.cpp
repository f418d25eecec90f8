// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/primitives/find_corners.h"

#include "opp/geometry/constants.h"

#include "primitives/labelled_samples.h"

#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace opp {
namespace {

/// Samples this near to an axis (in spacings) do not tell its sides apart: they are averages over a
/// cell of one spacing.
constexpr double kAxisMargin = 0.5;

int quadrantBit(int plane_axis, bool positive_u, bool positive_v) {
  return 4 * plane_axis + 2 * static_cast<int>(positive_v) + static_cast<int>(positive_u);
}

/// Whether planes[k] has an occupied quarter on the given side of axis l.
bool occupies(std::uint16_t signature, int k, int l, bool positive) {
  const bool l_is_u = (k + 1) % 3 == l;
  for (const bool other : {false, true}) {
    const int bit = quadrantBit(k, l_is_u ? positive : other, l_is_u ? other : positive);
    if ((signature >> bit & 1U) != 0U) return true;
  }
  return false;
}

CornerKind kindOf(std::uint16_t signature) {
  int concave = 0, convex = 0;
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3;
    const bool front_k = occupies(signature, k, l, true), front_l = occupies(signature, l, k, true);
    const bool behind_k = occupies(signature, k, l, false);
    const bool behind_l = occupies(signature, l, k, false);
    if (front_k && front_l) ++concave;
    if (!front_k && !front_l && behind_k && behind_l) ++convex;
  }
  if (concave + convex < 3) return CornerKind::kUnknown;
  if (concave == 3) return CornerKind::kConcave;
  return convex == 3 ? CornerKind::kConvex : CornerKind::kSaddle;
}

class CornerFinder {
 public:
  CornerFinder(const OrientedCloud& cloud, const Primitives& scan, const CornerParams& params)
      : scan_(scan),
        params_(params),
        viewpoint_(cloud.viewpoint.cast<double>()),
        samples_(samplesByPlane(cloud, scan)),
        spacings_(spacingsOf(cloud, scan)) {
    const auto size = static_cast<Eigen::Index>(2 * scan.families.size());
    if (scan.normal_covariance.rows() != size || scan.normal_covariance.cols() != size) {
      throw std::invalid_argument("corners need the joint covariance of the families' normals");
    }
  }

  std::optional<Corner> find(const std::array<int, 3>& triangle) const {
    Corner corner;
    corner.planes = triangle;
    Eigen::Matrix3d normals = normalsOf(corner);
    if (normals.determinant() < 0.0) {
      std::swap(corner.planes[1], corner.planes[2]);
      normals = normalsOf(corner);
    }
    // Edges join orthogonal planes: anything else is no corner.
    if (!(normals.determinant() > 0.5)) return std::nullopt;
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(normals, Eigen::ComputeFullU | Eigen::ComputeFullV);
    corner.cloud_from_corner = svd.matrixU() * svd.matrixV().transpose();
    Eigen::Vector3d offsets;
    for (int k = 0; k < 3; ++k) offsets[k] = -plane(corner, k).plane.d();
    corner.position = normals.transpose().partialPivLu().solve(offsets);
    corner.signature = signatureOf(corner);
    for (int k = 0; k < 3; ++k) {
      if ((corner.signature >> (4 * k) & 0xFU) == 0U) return std::nullopt;
      const double side = corner.cloud_from_corner.col(k).dot(viewpoint_ - corner.position);
      if (side > 0.0) corner.view_octant = static_cast<std::uint8_t>(corner.view_octant | 1U << k);
    }
    corner.kind = kindOf(corner.signature);
    corner.covariance = covarianceOf(corner, normals);
    return corner;
  }

 private:
  const PlanePrimitive& plane(const Corner& corner, int k) const {
    return scan_.planes.at(static_cast<std::size_t>(corner.planes[static_cast<std::size_t>(k)]));
  }

  Eigen::Matrix3d normalsOf(const Corner& corner) const {
    Eigen::Matrix3d normals;
    for (int k = 0; k < 3; ++k) normals.col(k) = plane(corner, k).plane.normal();
    return normals;
  }

  std::uint16_t signatureOf(const Corner& corner) const {
    std::array<int, 12> counts{};
    for (int k = 0; k < 3; ++k) {
      const auto index = static_cast<std::size_t>(corner.planes[static_cast<std::size_t>(k)]);
      const double radius = params_.radius * spacings_[index];
      const double margin = kAxisMargin * spacings_[index];
      for (const Eigen::Vector3d& x : samples_[index]) {
        const Eigen::Vector3d offset = x - corner.position;
        if (offset.squaredNorm() > radius * radius) continue;
        const Eigen::Vector3d local = corner.cloud_from_corner.transpose() * offset;
        const double u = local[(k + 1) % 3], v = local[(k + 2) % 3];
        if (std::abs(u) < margin || std::abs(v) < margin) continue;
        ++counts[static_cast<std::size_t>(quadrantBit(k, u > 0.0, v > 0.0))];
      }
    }
    const double full = kPi / 4.0 * params_.radius * params_.radius;
    unsigned signature = 0;
    for (std::size_t bit = 0; bit < counts.size(); ++bit) {
      if (counts[bit] >= std::max(1.0, params_.min_fill * full)) signature |= 1U << bit;
    }
    return static_cast<std::uint16_t>(signature);
  }

  /// n_k·c + d_k = 0 with d_k = −n_k·mean_k + ε_k gives n_k·δc = δn_k·(mean_k − c) − ε_k, where the
  /// δn of the families have a joint covariance and the ε_k are independent of all.
  Eigen::Matrix3d covarianceOf(const Corner& corner, const Eigen::Matrix3d& normals) const {
    Eigen::Matrix<double, 3, 6> lever = Eigen::Matrix<double, 3, 6>::Zero();
    Eigen::Matrix<double, 6, 6> turns;
    Eigen::Matrix3d right = Eigen::Matrix3d::Zero();
    for (int k = 0; k < 3; ++k) {
      const PlanePrimitive& own = plane(corner, k);
      const Eigen::Vector3d& shared =
          scan_.families.at(static_cast<std::size_t>(own.family)).normal;
      const double sign = shared.dot(own.plane.normal()) < 0.0 ? -1.0 : 1.0;
      lever.block<1, 2>(k, 2 * k) =
          sign * (own.moments.mean() - corner.position).transpose() * tangentBasis(shared);
      right(k, k) = 1.0 / (1.0 + own.moments.weight());
      for (int l = 0; l < 3; ++l) {
        turns.block<2, 2>(2 * k, 2 * l) =
            scan_.normal_covariance.block<2, 2>(2 * own.family, 2 * plane(corner, l).family);
      }
    }
    right += lever * turns * lever.transpose();
    const Eigen::Matrix3d inverse = normals.transpose().inverse();
    return inverse * right * inverse.transpose();
  }

  const Primitives& scan_;
  const CornerParams& params_;
  Eigen::Vector3d viewpoint_;
  std::vector<std::vector<Eigen::Vector3d>> samples_;
  std::vector<double> spacings_;  ///< of each plane's samples [m]
};

}  // namespace

std::vector<std::array<int, 3>> findTriangles(const std::vector<OrthogonalityEdge>& edges) {
  std::vector<std::array<int, 2>> pairs;
  for (const OrthogonalityEdge& edge : edges) pairs.push_back(edge.planes);
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::array<int, 3>> triangles;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (std::size_t j = i + 1; j < pairs.size() && pairs[j][0] == pairs[i][0]; ++j) {
      const std::array<int, 2> closing{pairs[i][1], pairs[j][1]};
      if (std::binary_search(pairs.begin(), pairs.end(), closing)) {
        triangles.push_back({pairs[i][0], closing[0], closing[1]});
      }
    }
  }
  return triangles;
}

std::vector<Corner> findCorners(const OrientedCloud& cloud, const Primitives& scan,
                                const CornerParams& params) {
  validate(params);
  const CornerFinder finder(cloud, scan, params);
  std::vector<Corner> corners;
  for (const std::array<int, 3>& triangle : findTriangles(scan.edges)) {
    if (auto corner = finder.find(triangle)) corners.push_back(*corner);
  }
  return corners;
}

}  // namespace opp
