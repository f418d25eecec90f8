// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud/voxel_patches.h"

#include "cloud/cell_table.h"

#include <nanoflann.hpp>

#include <algorithm>
#include <cstdint>

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
      : patches_(patches),
        adaptor_{patches.means},
        tree_(3, adaptor_, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize)),
        nearest_(patches.size()) {
    tree_.buildIndex();
  }

  WindowSums sums(int patch, int radius) override {
    WindowSums window;
    const Nearest nearest = nearestTo(patch, radius);
    for (const std::uint32_t* i = nearest.begin; i != nearest.end; ++i) {
      window.add(patches_.sums[*i], patches_.means[*i]);
    }
    return window;
  }

  void members(int patch, int radius, std::vector<int>& members) override {
    const Nearest nearest = nearestTo(patch, radius);
    members.assign(nearest.begin, nearest.end);
  }

  void shifted(int patch, int radius, std::vector<int>& centers) override {
    members(patch, radius, centers);
  }

 private:
  /// Of the tree: fewer make it deep, more are searched in vain.
  static constexpr std::size_t kLeafSize = 20;
  /// Most patches of a spinning lidar need more than the smallest window.
  static constexpr int kLeastRadius = 2;

  using Tree =
      nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, MeansAdaptor>,
                                          MeansAdaptor, 3>;
  struct Nearest {
    const std::uint32_t *begin, *end;
  };

  /// As many patches as a square window of that radius has, the nearest first.
  Nearest nearestTo(int patch, int radius) {
    const auto countFor = [this](int window_radius) {
      const auto side = static_cast<std::size_t>(2 * window_radius + 1);
      return std::min(patches_.size(), side * side);
    };
    const std::size_t count = countFor(radius);
    const auto k = static_cast<std::size_t>(patch);
    std::vector<std::uint32_t>& nearest = nearest_[k];
    if (nearest.size() < count) {
      nearest.resize(countFor(std::max(radius, kLeastRadius)));
      distances_.resize(nearest.size());
      tree_.knnSearch(patches_.means[k].data(), nearest.size(), nearest.data(), distances_.data());
    }
    return {nearest.data(), nearest.data() + count};
  }

  const Patches& patches_;
  MeansAdaptor adaptor_;
  Tree tree_;
  /// Of each patch, those of its widest window so far: sums, members and smaller windows are asked
  /// for in turn.
  std::vector<std::vector<std::uint32_t>> nearest_;
  std::vector<double> distances_;  ///< scratch
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
