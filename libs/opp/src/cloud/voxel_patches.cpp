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

class NearestWindows final : public PatchWindows {
 public:
  explicit NearestWindows(const Patches& patches)
      : patches_(patches), adaptor_{patches.means}, tree_(3, adaptor_) {
    tree_.buildIndex();
  }

  WindowSums sums(int patch, int radius) override {
    WindowSums window;
    for (const int i : nearest(patch, radius)) {
      const auto k = static_cast<std::size_t>(i);
      window.add(patches_.sums[k], patches_.means[k]);
    }
    return window;
  }

  void members(int patch, int radius, std::vector<int>& members) override {
    members = nearest(patch, radius);
  }

  void shifted(int patch, int radius, std::vector<int>& centers) override {
    centers = nearest(patch, radius);
  }

 private:
  using Tree =
      nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, MeansAdaptor>,
                                          MeansAdaptor, 3>;
  /// The last window is kept: its sums and members are asked for in turn.
  const std::vector<int>& nearest(int patch, int radius) {
    if (patch == patch_ && radius == radius_) return window_;
    const auto side = static_cast<std::size_t>(2 * radius + 1);
    indices_.resize(std::min(patches_.size(), side * side));
    distances_.resize(indices_.size());
    const std::size_t found =
        tree_.knnSearch(patches_.means[static_cast<std::size_t>(patch)].data(), indices_.size(),
                        indices_.data(), distances_.data());
    window_.assign(indices_.begin(), indices_.begin() + static_cast<std::ptrdiff_t>(found));
    patch_ = patch;
    radius_ = radius;
    return window_;
  }

  const Patches& patches_;
  MeansAdaptor adaptor_;
  Tree tree_;
  int patch_ = -1, radius_ = -1;
  std::vector<int> window_;
  std::vector<unsigned int> indices_;
  std::vector<double> distances_;
};

}  // namespace

Patches makeVoxelPatches(const std::vector<Eigen::Vector3f>& points, double edge) {
  Patches patches;
  if (points.empty()) return patches;
  Eigen::Vector3f low = points.front();
  for (const Eigen::Vector3f& p : points) low = low.cwiseMin(p);
  patches.origin = low.cast<double>();
  patches.edge = edge;
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

std::unique_ptr<PatchWindows> nearestPatches(const Patches& patches) {
  return std::make_unique<NearestWindows>(patches);
}

}  // namespace opp
