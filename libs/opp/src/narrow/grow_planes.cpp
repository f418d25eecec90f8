// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "narrow/grow_planes.h"

#include "geometry/planar_spread.h"
#include "narrow/cell_mask.h"
#include "narrow/cell_shape.h"
#include "narrow/cell_windows.h"
#include "narrow/inverse_depth_fit.h"
#include "narrow/inverse_depth_noise.h"
#include "narrow/pixel_cells.h"
#include "narrow/pixel_region.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

namespace opp {
namespace {

/// A growing plane is fitted anew when it has so many times the cells of the last fit.
constexpr double kGrowth = 1.3;
constexpr double kFirstFit = 16.0;
constexpr std::size_t kLeastCells = 12;
/// A plane that is known goes on beyond gaps of one cell less.
constexpr int kGap = 4;
/// Cells in so many regions that are no planes are not tried again.
constexpr int kMostTries = 2;
constexpr int kOwned = 1000;  ///< for those of planes
/// A curved surface shows around a facet of it, within so many of its widths.
constexpr double kAround = 2.0;
/// Cells astride of edges scatter more than pixels that are fitted as far as the edges.
constexpr double kCellScatter = 1.25;

/// Region of cells and the plane through it.
struct Growth {
  RayFrame frame;
  std::vector<int> cells;
  Eigen::Vector3d coefficients;
  Eigen::Matrix3d covariance;
  double scatter = 0.0;  ///< mean squared residual of the cells over that of noise
};

class PlaneGrower {
 public:
  PlaneGrower(const DepthImage& image, const std::vector<std::uint8_t>& open,
              std::vector<KnownSurface> surfaces, const RegionRule& rule)
      : image_(image),
        cells_(image, open),
        windows_(cellWindows(image, cells_)),
        fitter_(image, std::move(surfaces), rule),
        rule_(rule),
        squared_gate_(rule.params.gate * rule.params.gate),
        tries_(static_cast<std::size_t>(cells_.size()), 0),
        reached_(static_cast<std::size_t>(cells_.size()), 0),
        open_(cells_.rows(), cells_.cols()) {}

  std::vector<PixelPlane> grow() {
    const std::vector<int> seeds = flattestFirst(windows_);
    // Strips have no windows of their own. Faces that meet at a fold grow into each other, though,
    // and are none then: what is left grows once more, to cells alone whose windows are on the
    // plane.
    for (const bool by_windows : {false, true}) {
      by_windows_ = by_windows;
      forgetTries();
      for (const int seed : seeds) {
        if (tries_[static_cast<std::size_t>(seed)] == 0) growFrom(seed);
      }
    }
    // The first were fitted when the others beside them were not known.
    return fitter_.refitAll();
  }

 private:
  /// Cells of planes are not tried again.
  void forgetTries() {
    for (int index = 0; index < cells_.size(); ++index) {
      int& tries = tries_[static_cast<std::size_t>(index)];
      if (tries >= kOwned) continue;
      tries = 0;
      open_.mark(cells_[index].row, cells_[index].col);
    }
  }

  int mostTries() const { return by_windows_ ? 1 : kMostTries; }

  void addTries(int index, int count) {
    int& tries = tries_[static_cast<std::size_t>(index)];
    tries += count;
    if (tries >= mostTries()) open_.clear(cells_[index].row, cells_[index].col);
  }

  /// The fit of a plane to the cells that are gathered for it.
  struct Gathering {
    InverseDepthNoise noise;
    InverseDepthFit fit = {};
    double squares = 0.0;  ///< residuals, over their variances
    double next_fit = kFirstFit;
  };

  /// Gathers the cells on the plane that hang together with the seed, through gaps, too.
  void spread(int seed, Growth& growth) {
    growth.cells.clear();
    Gathering gathering{{image_.noise(), growth.coefficients}};
    CellMask untried = open_;
    const auto tryCell = [&](int row, int col) {
      const int index = cells_.indexAt(row, col);
      const Offset offset = offsetOf(index, gathering, growth);
      if (isOn(index, offset, 0.0, growth)) add(index, offset, gathering, growth);
    };
    untried.takeAround(cells_[seed].row, cells_[seed].col, 0, tryCell);
    for (std::size_t next = 0; next < growth.cells.size(); ++next) {
      const PixelCell& cell = cells_[growth.cells[next]];
      untried.takeAround(cell.row, cell.col, kGap, tryCell);
    }
    finish(gathering, growth);
  }

  /// The same while the plane is rough: its own uncertainty counts, and it is fitted anew as it
  /// grows, so that cells may be on it later.
  void spreadRoughly(int seed, Growth& growth) {
    growth.cells.clear();
    ++search_;
    Gathering gathering{{image_.noise(), growth.coefficients}};
    const auto tryCell = [&](int index) {
      const auto at = static_cast<std::size_t>(index);
      if (reached_[at] == search_ || tries_[at] >= mostTries()) return;
      const Offset offset = offsetOf(index, gathering, growth);
      const Eigen::Vector3d row = offset.ray.row();
      if (!isOn(index, offset, row.dot(growth.covariance * row), growth)) return;
      reached_[at] = search_;
      add(index, offset, gathering, growth);
      if (gathering.fit.count() < gathering.next_fit) return;
      gathering.next_fit = kGrowth * gathering.fit.count();
      take(gathering.fit, growth);
      gathering.noise = InverseDepthNoise(image_.noise(), growth.coefficients);
    };
    tryCell(seed);
    for (std::size_t next = 0; next < growth.cells.size(); ++next) {
      cells_.visitAround(cells_[growth.cells[next]], 1, tryCell);
    }
    finish(gathering, growth);
  }

  /// A cell's inverse depth against that of the plane.
  struct Offset {
    RayFrame::Ray ray;
    double residual, variance;
  };
  Offset offsetOf(int index, const Gathering& gathering, const Growth& growth) const {
    const RayFrame::Ray ray = growth.frame.of(cells_[index].point);
    return {ray, growth.coefficients.dot(ray.row()) - ray.inverse_depth,
            cellVariance(cells_[index], ray, gathering.noise, image_)};
  }

  /// \param unknown variance of the plane's own inverse depth there.
  bool isOn(int index, const Offset& offset, double unknown, const Growth& growth) const {
    if (!(offset.ray.inverse_depth > 0.0)) return false;
    const double gate = squared_gate_ * (offset.variance + unknown);
    if (!(offset.residual * offset.residual <= gate)) return false;
    return !by_windows_ || windows_[static_cast<std::size_t>(index)].isOn(
                               growth.frame, growth.coefficients, growth.covariance);
  }

  static void add(int index, const Offset& offset, Gathering& gathering, Growth& growth) {
    const double precision = 1.0 / offset.variance;
    growth.cells.push_back(index);
    gathering.fit.add(offset.ray, precision);
    gathering.squares += offset.residual * offset.residual * precision;
  }

  static void finish(const Gathering& gathering, Growth& growth) {
    take(gathering.fit, growth);
    growth.scatter = gathering.squares / gathering.fit.count();
  }

  static void take(InverseDepthFit fit, Growth& growth) {
    if (!fit.solve()) return;
    growth.coefficients = fit.coefficients();
    growth.covariance = fit.covariance();
  }

  double pixelsOf(const Growth& growth) const {
    double count = 0.0;
    for (const int index : growth.cells) count += cells_[index].count;
    return count;
  }

  void growFrom(int seed) {
    const CellWindow& window = windows_[static_cast<std::size_t>(seed)];
    Growth growth{window.frame, {}, window.coefficients, window.covariance};
    const bool found = grows(seed, growth);
    addTries(seed, 1);
    if (growth.cells.size() < kLeastCells) return;
    for (const int index : growth.cells) addTries(index, found ? kOwned : 1);
  }

  bool grows(int seed, Growth& growth) {
    spreadRoughly(seed, growth);
    if (growth.cells.size() < kLeastCells) return false;
    spread(seed, growth);
    if (growth.cells.size() < kLeastCells) return false;
    // A part of the pixels of a plane near others is open.
    return 2.0 * pixelsOf(growth) >= rule_.params.min_pixels &&
           growth.scatter <= kCellScatter * rule_.params.max_scatter && fitAndKeep(seed, growth);
  }

  std::optional<PixelRegion> fitted(const Growth& growth) {
    PixelRegion region{growth.frame, {}, growth.coefficients};
    for (const int index : growth.cells) region.cells.push_back(cells_[index]);
    return fitter_.fit(region) ? std::optional<PixelRegion>(region) : std::nullopt;
  }

  bool fitAndKeep(int seed, Growth& growth) {
    std::optional<PixelRegion> region = fitted(growth);
    if (!region) return false;
    // What edges left the plane askew may have ended it too early.
    Growth wider = growth;
    wider.coefficients = region->coefficients;
    spread(seed, wider);
    if (static_cast<double>(wider.cells.size()) >
        kGrowth * static_cast<double>(growth.cells.size())) {
      growth = wider;
      region = fitted(growth);
    }
    if (!region || !fitter_.isPlane(*region) || isFacet(growth, *region)) return false;
    if (!fitter_.isKept(*region)) fitter_.keep(*region);
    for (const int index : wider.cells) addTries(index, kOwned);
    return true;
  }

  /// Whether the plane is a part of a curved surface that goes on around it.
  bool isFacet(const Growth& growth, const PixelRegion& region) {
    std::vector<PixelBlock> cells;
    for (const int index : withThoseAround(growth.cells)) {
      const PixelCell& cell = cells_[index];
      cells.push_back(
          {cell.row, cell.col, cell.point.cast<double>(), static_cast<double>(cell.count)});
    }
    const CellShape shape(image_, region.frame.planeOf(region.coefficients), cells);
    return shape.turns(rule_.max_turn, rule_.test_sigmas) &&
           shape.bentScatter() <= rule_.params.max_scatter;
  }

  /// Some cells, and those of no plane that hang together with them, within widths of these.
  std::vector<int> withThoseAround(std::vector<int> cells) {
    PlanarSpread grid;
    ++search_;
    for (const int index : cells) {
      grid.add(cells_[index].row, cells_[index].col);
      reached_[static_cast<std::size_t>(index)] = search_;
    }
    const int steps = static_cast<int>(std::ceil(kAround * grid.widths()[0]));
    std::size_t begin = 0;
    for (int step = 0; step < steps; ++step) {
      const std::size_t end = cells.size();
      for (; begin < end; ++begin) {
        const PixelCell& cell = cells_[cells[begin]];
        cells_.visitAround(cell, 1, [&](int other) {
          const auto at = static_cast<std::size_t>(other);
          if (reached_[at] == search_ || tries_[at] >= kOwned) return;
          if (image_.jumps(cell.range, cells_[other].range)) return;
          reached_[at] = search_;
          cells.push_back(other);
        });
      }
    }
    return cells;
  }

  const DepthImage& image_;
  PixelCells cells_;
  std::vector<CellWindow> windows_;  ///< per cell
  RegionFitter fitter_;
  RegionRule rule_;
  double squared_gate_;
  bool by_windows_ = false;
  std::vector<int> tries_;    ///< per cell: regions with it
  std::vector<int> reached_;  ///< per cell: the last search that added it
  CellMask open_;             ///< cells that may be tried once more
  int search_ = 0;
};

}  // namespace

std::vector<PixelPlane> growPlanes(const DepthImage& image, const std::vector<std::uint8_t>& open,
                                   const std::vector<KnownSurface>& surfaces,
                                   const RegionRule& rule) {
  return PlaneGrower(image, open, surfaces, rule).grow();
}

}  // namespace opp
