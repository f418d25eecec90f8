// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/evaluation/labels_at_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>

namespace opp::mapping {
namespace {

using Cell = std::array<std::int64_t, 3>;
using Entry = std::pair<Cell, std::size_t>;  ///< cell of a point, and its index

bool isSame(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  if (!a.allFinite() || !b.allFinite()) return a.allFinite() == b.allFinite();
  return ((a - b).cwiseAbs().cast<double>().array() < kSamePosition).all();
}

bool isSame(const std::vector<Eigen::Vector3f>& a, const std::vector<Eigen::Vector3f>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const auto& p, const auto& q) { return isSame(p, q); });
}

Cell cellOf(const Eigen::Vector3f& point) {
  Cell cell{};
  for (int k = 0; k < 3; ++k) {
    cell[static_cast<std::size_t>(k)] =
        static_cast<std::int64_t>(std::floor(static_cast<double>(point[k]) / kSamePosition));
  }
  return cell;
}

std::vector<Entry> entriesOf(const std::vector<Eigen::Vector3f>& points) {
  std::vector<Entry> entries;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (points[k].allFinite()) entries.emplace_back(cellOf(points[k]), k);
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

/// Index of the nearest same point, of equally near ones the first; −1 if there is none. Points
/// nearer than a cell's edge lie in the cell of `point` or one of its 26 neighbours; those that
/// differ in the last coordinate alone are neighbours in the order of the entries.
std::int64_t nearestSame(const Eigen::Vector3f& point, const std::vector<Entry>& entries,
                         const std::vector<Eigen::Vector3f>& points) {
  const Cell cell = cellOf(point);
  std::int64_t nearest = -1;
  float least = 0.0F;
  for (std::int64_t x = cell[0] - 1; x <= cell[0] + 1; ++x) {
    for (std::int64_t y = cell[1] - 1; y <= cell[1] + 1; ++y) {
      const Cell last{x, y, cell[2] + 1};
      auto entry = std::lower_bound(entries.begin(), entries.end(), Entry({x, y, cell[2] - 1}, 0));
      for (; entry != entries.end() && entry->first <= last; ++entry) {
        const float distance = (points[entry->second] - point).squaredNorm();
        if (!isSame(points[entry->second], point) || (nearest >= 0 && distance >= least)) continue;
        nearest = static_cast<std::int64_t>(entry->second);
        least = distance;
      }
    }
  }
  return nearest;
}

}  // namespace

std::vector<int> labelsAtPoints(const std::vector<Eigen::Vector3f>& points,
                                const std::vector<Eigen::Vector3f>& labelled,
                                const std::vector<int>& labels) {
  if (labels.size() != labelled.size()) {
    throw std::invalid_argument("labelsAtPoints: " + std::to_string(labels.size()) +
                                " labels for " + std::to_string(labelled.size()) + " points");
  }
  std::vector<int> result(points.size(), -1);
  if (isSame(points, labelled)) {
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (points[k].allFinite()) result[k] = labels[k];
    }
    return result;
  }
  const std::vector<Entry> entries = entriesOf(labelled);
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!points[k].allFinite()) continue;
    const std::int64_t same = nearestSame(points[k], entries, labelled);
    if (same >= 0) result[k] = labels[static_cast<std::size_t>(same)];
  }
  return result;
}

}  // namespace opp::mapping
