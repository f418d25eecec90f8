// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud/main_directions.h"

#include "opp/geometry/constants.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace opp {
namespace {

using Directions = std::vector<Eigen::Vector3d>;

/// More normals make no better means.
constexpr std::size_t kMostNormals = 8000;
/// Each off by 5°, they leave 0.9°.
constexpr std::size_t kLeastNormals = 32;
/// Clutter has directions, too, with few normals each: a mode has one in so many.
constexpr std::size_t kLeastShare = 40;
constexpr std::size_t kMostModes = 8;
/// Normals within two of their standard deviations make a mean, and within three they belong to it.
constexpr double kMeanAngle = degToRad(10.0);
constexpr double kOwnAngle = degToRad(15.0);
constexpr int kMeanSteps = 3;

/// Sum of the normals, turned to the side of the first, and their number.
struct NormalSum {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::size_t count = 0;

  void add(const Eigen::Vector3d& normal) {
    sum += normal.dot(sum) < 0.0 ? Eigen::Vector3d(-normal) : normal;
    ++count;
  }
};

/// The fullest of the cells, about 7° wide, into which lines through a cube's centre fall.
NormalSum fullestCell(const Directions& normals) {
  constexpr int kSide = 16;
  std::vector<NormalSum> cells(static_cast<std::size_t>(3 * kSide * kSide));
  const auto indexOf = [](double x) {
    return std::min(kSide - 1, static_cast<int>(0.5 * (x + 1.0) * kSide));
  };
  for (const Eigen::Vector3d& n : normals) {
    Eigen::Index axis = 0;
    n.cwiseAbs().maxCoeff(&axis);
    const int u = indexOf(n[(axis + 1) % 3] / n[axis]), v = indexOf(n[(axis + 2) % 3] / n[axis]);
    cells[static_cast<std::size_t>((static_cast<int>(axis) * kSide + u) * kSide + v)].add(n);
  }
  return *std::max_element(cells.begin(), cells.end(), [](const NormalSum& a, const NormalSum& b) {
    return a.count < b.count;
  });
}

/// Moves to the mean of the normals around, a few times.
NormalSum meanAround(const Directions& normals, NormalSum mean) {
  const double least_cosine = std::cos(kMeanAngle);
  for (int step = 0; step < kMeanSteps && mean.count > 0; ++step) {
    const Eigen::Vector3d center = mean.sum.normalized();
    mean = {};
    for (const Eigen::Vector3d& n : normals) {
      if (std::abs(n.dot(center)) >= least_cosine) mean.add(n);
    }
  }
  return mean;
}

bool along(const Eigen::Vector3d& direction, const Eigen::Vector3d& normal) {
  static const double kLeastCosine = std::cos(kOwnAngle);
  return std::abs(direction.dot(normal)) > kLeastCosine;
}

/// Adds the third axes of pairs that are orthogonal within what the means leave uncertain.
void addThirdAxes(Directions& directions) {
  const double most_cosine = std::sin(degToRad(2.0));
  const std::size_t count = directions.size();
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = a + 1; b < count; ++b) {
      if (std::abs(directions[a].dot(directions[b])) > most_cosine) continue;
      const Eigen::Vector3d third = directions[a].cross(directions[b]).normalized();
      const auto known = [&](const Eigen::Vector3d& d) { return along(d, third); };
      if (std::none_of(directions.begin(), directions.end(), known)) directions.push_back(third);
    }
  }
}

}  // namespace

std::vector<Eigen::Vector3d> mainDirections(const std::vector<Eigen::Vector3d>& normals) {
  Directions directions, left;
  const std::size_t stride = (normals.size() + kMostNormals - 1) / kMostNormals;
  for (std::size_t i = 0; i < normals.size(); i += stride) left.push_back(normals[i]);
  const std::size_t least = std::max(kLeastNormals, left.size() / kLeastShare);
  while (directions.size() < kMostModes && left.size() >= least) {
    const NormalSum mean = meanAround(left, fullestCell(left));
    if (mean.count < least) break;
    const Eigen::Vector3d direction = mean.sum.normalized();
    const auto owned = [&](const Eigen::Vector3d& normal) { return along(direction, normal); };
    left.erase(std::remove_if(left.begin(), left.end(), owned), left.end());
    directions.push_back(direction);
  }
  addThirdAxes(directions);
  return directions;
}

}  // namespace opp
