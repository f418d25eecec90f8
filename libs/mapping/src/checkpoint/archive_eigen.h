// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cereal/cereal.hpp>
#include <cereal/types/vector.hpp>

#include <cstddef>
#include <vector>

// How cereal stores Eigen's types: bit by bit. In its namespace, which it searches for types that
// are neither its own nor ours.

namespace cereal {

template <typename Archive, typename Scalar, int Rows, int Columns, int Options, int MaxRows,
          int MaxColumns>
void serialize(Archive& archive,
               Eigen::Matrix<Scalar, Rows, Columns, Options, MaxRows, MaxColumns>& matrix) {
  Eigen::Index rows = matrix.rows(), columns = matrix.cols();
  if constexpr (Rows == Eigen::Dynamic) archive(rows);
  if constexpr (Columns == Eigen::Dynamic) archive(columns);
  matrix.resize(rows, columns);
  const auto bytes = static_cast<std::size_t>(matrix.size()) * sizeof(Scalar);
  archive(binary_data(matrix.data(), bytes));
}

template <typename Archive, int Mode>
void serialize(Archive& archive, Eigen::Transform<double, 3, Mode>& transform) {
  archive(transform.matrix());
}

/// All at once: point by point takes ten times as long.
template <typename Archive>
void save(Archive& archive, const std::vector<Eigen::Vector3f>& points) {
  archive(make_size_tag(static_cast<size_type>(points.size())));
  if (points.empty()) return;
  archive(binary_data(points.front().data(), points.size() * sizeof(Eigen::Vector3f)));
}

template <typename Archive>
void load(Archive& archive, std::vector<Eigen::Vector3f>& points) {
  size_type count = 0;
  archive(make_size_tag(count));
  points.resize(static_cast<std::size_t>(count));
  if (points.empty()) return;
  archive(binary_data(points.front().data(), points.size() * sizeof(Eigen::Vector3f)));
}

}  // namespace cereal
