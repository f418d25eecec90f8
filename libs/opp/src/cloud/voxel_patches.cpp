// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud/voxel_patches.h"

#include "cloud/cell_table.h"

#include <nanoflann.hpp>

#include <algorithm>

namespace opp {
namespace {

/// The view of the patches' means that nanoflann asks for.
struct MeansAdaptor {
  const std::vector<Eigen::Vector3d>& means;
  std::size_t kdtree_get_point_count() const { return means.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return means[i][static_cast<Eigen::Index>(axis)];
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

struct MeansTree {
  using Tree =
      nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, MeansAdaptor>,
                                          MeansAdaptor, 3>;
  explicit MeansTree(const std::vector<Eigen::Vector3d>& means) : adaptor{means}, tree(3, adaptor) {
    tree.buildIndex();
  }
  MeansAdaptor adaptor;
  Tree tree;
};

}  // namespace

Patches makeVoxelPatches(const std::vector<Eigen::Vector3f>& points, double edge) {
  Patches patches;
  if (points.empty()) return patches;
  Eigen::Vector3f low = points.front();
  for (const Eigen::Vector3f& p : points) low = low.cwiseMin(p);
  patches.origin = low.cast<double>();
  CellTable table(low, edge, points.size() / 2);
  std::vector<MomentSums> sums;
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3d p = point.cast<double>() - patches.origin;
    const int next = static_cast<int>(sums.size());
    const int found = table.findOrInsert(table.cellOf(point.cast<double>()), next);
    if (found < 0) sums.emplace_back(MomentSums::Zero());
    MomentSums single;
    single << 1.0, p, p.x() * p, p.y() * p.tail<2>(), p.z() * p.z();
    sums[static_cast<std::size_t>(found < 0 ? next : found)] += single;
  }
  for (const MomentSums& s : sums) patches.add(s);
  return patches;
}

Neighborhood nearestPatches(const Patches& patches) {
  const auto tree = std::make_shared<const MeansTree>(patches.means);
  return [tree, &patches](int patch, int radius, std::vector<int>& window) {
    const auto side = static_cast<std::size_t>(2 * radius + 1);
    const std::size_t count = std::min(patches.size(), side * side);
    std::vector<unsigned int> indices(count);
    std::vector<double> distances(count);
    const std::size_t found =
        tree->tree.knnSearch(patches.means[static_cast<std::size_t>(patch)].data(), count,
                             indices.data(), distances.data());
    window.clear();
    for (std::size_t k = 0; k < found; ++k) window.push_back(static_cast<int>(indices[k]));
  };
}

}  // namespace opp
