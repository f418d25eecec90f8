// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"
#include "opp/geometry/point_moments.h"

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <vector>

namespace opp {

/// A plane found in one scan. Its index in Primitives::planes is its id.
struct PlanePrimitive {
  Plane plane;                                           ///< n points to the viewpoint's side
  PointMoments moments;                                  ///< of its inliers, weights 1/σ² [1/m²]
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (α, β, δ), see `tangentBasis`
  int family = -1;    ///< index into Primitives::families; −1: in none (before refinement)
  int support = 0;    ///< number of samples on it
  double area = 0.0;  ///< of its support, samples × spacing² [m²]
  double rms = 0.0;   ///< of the inliers' distances [m]
};

/// Parallel planes (opposite normals included) that share one normal; Sommer et al. 2020, Eq. 9.
/// A plane without a parallel is a family of its own.
struct ParallelFamily {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< planes have +normal or −normal
  std::vector<int> planes;                            ///< ascending indices
};

/// Two orthogonal planes that meet where there are points: an edge of the plane graph.
struct OrthogonalityEdge {
  std::array<int, 2> planes{};  ///< ascending indices
  double votes = 0.0;           ///< votes of the pair (Eq. 3–4)
};

enum class LineKind : std::uint8_t { kUnknown, kConvex, kConcave };
enum class CornerKind : std::uint8_t { kUnknown, kConvex, kConcave, kSaddle };

/// A stretch of the common line of two orthogonal planes that has support on both.
struct LineSegment {
  std::array<int, 2> planes{};  ///< ascending indices
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  Eigen::Vector3d end = Eigen::Vector3d::Zero();
  LineKind kind = LineKind::kUnknown;  ///< concave: room edge seen from inside; convex: box edge
                                       ///< seen from outside
};

/// Point where three mutually orthogonal planes meet, with its local reference frame (LRF).
struct Corner {
  std::array<int, 3> planes{};  ///< in the order of the LRF's axes
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  /// Rotation part of cloud_from_corner: column k is ±(normal of planes[k]), det = +1. Axis signs
  /// and order are a convention only; 24 frames describe the same corner.
  Eigen::Matrix3d cloud_from_corner = Eigen::Matrix3d::Identity();
  CornerKind kind = CornerKind::kUnknown;
  /// Occupied quarter-planes: bit 4k + q is quadrant q of planes[k], where q = 2·(v > 0) + (u > 0),
  /// and u, v are the coordinates along the LRF's axes (k+1)%3 and (k+2)%3.
  std::uint16_t signature = 0;
  /// Octant of the LRF that holds the viewpoint: bit k set where the viewpoint is on the positive
  /// side of axis k.
  std::uint8_t view_octant = 0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the position [m²]
};

/// All that detection finds in one scan, in the frame of the cloud it was given.
struct Primitives {
  std::vector<PlanePrimitive> planes;
  std::vector<ParallelFamily> families;
  /// Joint covariance of the families' normals: block (f, g) of size 2×2 [rad²], coordinates in
  /// `tangentBasis(families[f].normal)`. Of full structure, so that points where planes meet get a
  /// covariance that knows their normals turn together.
  Eigen::MatrixXd normal_covariance;
  std::vector<OrthogonalityEdge> edges;
  std::vector<LineSegment> lines;
  std::vector<Corner> corners;
  std::vector<int> labels;  ///< plane of each sample of the oriented cloud; −1: none
  bool converged = true;    ///< the joint refinement reached its tolerance
};

}  // namespace opp
