// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"
#include "opp/geometry/point_cloud.h"
#include "opp/geometry/point_moments.h"
#include "opp/primitives/primitives.h"

#include "checkpoint/archive_eigen.h"

#include <cereal/types/array.hpp>
#include <cereal/types/common.hpp>

// How cereal stores what detection makes of a scan. Types are taken apart by structured bindings:
// a new member breaks the build here until it is stored, too. Then the checkpoint's format changes
// (kFormat in run_identity.cpp).

namespace opp {

template <typename Archive>
void save(Archive& archive, const Plane& plane) {
  archive(plane.normal(), plane.d());
}

template <typename Archive>
void load(Archive& archive, Plane& plane) {
  Eigen::Vector3d normal;
  double d = 0.0;
  archive(normal, d);
  plane = Plane::fromUnitNormal(normal, d);
}

template <typename Archive>
void save(Archive& archive, const PointMoments& moments) {
  archive(moments.weight(), moments.mean(), moments.scatter());
}

template <typename Archive>
void load(Archive& archive, PointMoments& moments) {
  double weight = 0.0;
  Eigen::Vector3d mean;
  Eigen::Matrix3d scatter;
  archive(weight, mean, scatter);
  moments = PointMoments(weight, mean, scatter);
}

template <typename Archive>
void serialize(Archive& archive, OrientedCloud& value) {
  auto& [points, normals, sigmas, weights, extents, patch_extents, viewpoint, spacing,
         noise_correlation, narrow_samples] = value;
  archive(points, normals, sigmas, weights, extents, patch_extents, viewpoint, spacing,
          noise_correlation, narrow_samples);
}

template <typename Archive>
void serialize(Archive& archive, Rims& value) {
  auto& [points, normals, sigmas] = value;
  archive(points, normals, sigmas);
}

template <typename Archive>
void serialize(Archive& archive, PlanePrimitive& value) {
  auto& [plane, moments, covariance, family, support, area, rms] = value;
  archive(plane, moments, covariance, family, support, area, rms);
}

template <typename Archive>
void serialize(Archive& archive, ParallelFamily& value) {
  auto& [normal, planes] = value;
  archive(normal, planes);
}

template <typename Archive>
void serialize(Archive& archive, OrthogonalityEdge& value) {
  auto& [planes, votes] = value;
  archive(planes, votes);
}

template <typename Archive>
void serialize(Archive& archive, LineSegment& value) {
  auto& [planes, start, end, kind] = value;
  archive(planes, start, end, kind);
}

template <typename Archive>
void serialize(Archive& archive, Corner& value) {
  auto& [planes, position, cloud_from_corner, kind, signature, view_octant, covariance] = value;
  archive(planes, position, cloud_from_corner, kind, signature, view_octant, covariance);
}

template <typename Archive>
void serialize(Archive& archive, Primitives& value) {
  auto& [planes, families, normal_covariance, edges, lines, corners, labels, converged] = value;
  archive(planes, families, normal_covariance, edges, lines, corners, labels, converged);
}

}  // namespace opp
