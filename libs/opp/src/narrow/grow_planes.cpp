// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "narrow/grow_planes.h"

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

/// Cells in a window that a plane begins with, of nine.
constexpr int kLeastWindow = 6;
/// A window is no beginning if its cells scatter more, in variances of the noise.
constexpr double kMostWindowMisfit = 2.5;
/// What a missing cell of the window counts in that.
constexpr double kMissingCell = 0.1;
/// A growing plane is fitted anew when it has so many times the cells of the last fit.
constexpr double kGrowth = 1.3;
constexpr double kFirstFit = 16.0;
constexpr std::size_t kLeastCells = 12;
/// A plane that is known goes on beyond gaps of one cell less.
constexpr int kGap = 4;
/// Cells in so many regions that are no planes are not tried again.
constexpr int kMostTries = 2;
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
        fitter_(image, std::move(surfaces), rule),
        squared_gate_(rule.params.gate * rule.params.gate),
        least_pixels_(rule.params.min_pixels),
        most_scatter_(rule.params.max_scatter),
        tries_(static_cast<std::size_t>(cells_.size()), 0),
        reached_(static_cast<std::size_t>(cells_.size()), 0),
        member_(reached_) {}

  std::vector<PixelPlane> grow() {
    for (const int seed : seeds()) {
      if (tries_[static_cast<std::size_t>(seed)] == 0) growFrom(seed);
    }
    // The first were fitted when the others beside them were not known.
    return fitter_.refitAll();
  }

 private:
  /// Variance of a cell's inverse depth.
  double varianceOf(const PixelCell& cell, const RayFrame::Ray& ray,
                    const InverseDepthNoise& noise) const {
    const auto range = static_cast<double>(cell.range);
    return noise.variance(range * range, ray.inverse_depth) *
           image_.sensor().meanVariance(cell.count);
  }

  /// Plane through a cell and its neighbours, in one or more passes; the misfit per degree of
  /// freedom. Nothing if there are too few.
  std::optional<double> fitWindow(int index, int passes, Growth& growth) const {
    const PixelCell& center = cells_[index];
    // First as if seen straight, then as it is.
    growth.coefficients = {1.0 / static_cast<double>(center.range), 0.0, 0.0};
    InverseDepthFit fit;
    for (int pass = 0; pass < passes; ++pass) {
      const InverseDepthNoise noise(image_.noise(), growth.coefficients);
      fit = {};
      cells_.visitAround(center, 1, [&](int other) {
        const PixelCell& cell = cells_[other];
        if (image_.jumps(cell.range, center.range)) return;
        const RayFrame::Ray ray = growth.frame.of(cell.point);
        fit.add(ray, 1.0 / varianceOf(cell, ray, noise));
      });
      if (fit.count() < kLeastWindow || !fit.solve()) return std::nullopt;
      growth.coefficients = fit.coefficients();
      growth.covariance = fit.covariance();
    }
    return fit.misfit() / (fit.count() - 3.0) + kMissingCell * (9.0 - fit.count());
  }

  Growth beginAt(int index) const {
    return {RayFrame(cells_[index].point.cast<double>()), {}, {}, {}, 0.0};
  }

  /// Cells to begin at, the flattest neighbourhoods first.
  std::vector<int> seeds() const {
    std::vector<std::pair<double, int>> order;
    for (int index = 0; index < cells_.size(); ++index) {
      Growth growth = beginAt(index);
      const auto misfit = fitWindow(index, 1, growth);
      if (misfit && *misfit < kMostWindowMisfit) order.emplace_back(*misfit, index);
    }
    std::sort(order.begin(), order.end());
    std::vector<int> seeds;
    for (const auto& [misfit, index] : order) seeds.push_back(index);
    return seeds;
  }

  /// Gathers the cells on the plane that hang together with the seed. While the plane is `rough`,
  /// its own uncertainty counts, and it is fitted anew as it grows: cells may be on it later.
  void spread(int seed, bool rough, Growth& growth) {
    growth.cells.clear();
    ++search_;
    InverseDepthNoise noise(image_.noise(), growth.coefficients);
    InverseDepthFit fit;
    double squares = 0.0;
    double next_fit = kFirstFit;
    const auto add = [&](int index) {
      const auto at = static_cast<std::size_t>(index);
      if (reached_[at] == search_ || tries_[at] >= kMostTries) return;
      if (!rough) reached_[at] = search_;
      const PixelCell& cell = cells_[index];
      const RayFrame::Ray ray = growth.frame.of(cell.point);
      if (!(ray.inverse_depth > 0.0)) return;
      const Eigen::Vector3d row = ray.row();
      const double residual = growth.coefficients.dot(row) - ray.inverse_depth;
      const double variance = varianceOf(cell, ray, noise);
      const double unknown = rough ? row.dot(growth.covariance * row) : 0.0;
      if (!(residual * residual <= squared_gate_ * (variance + unknown))) return;
      reached_[at] = member_[at] = search_;
      growth.cells.push_back(index);
      fit.add(ray, 1.0 / variance);
      squares += residual * residual / variance;
      if (!rough || fit.count() < next_fit) return;
      next_fit = kGrowth * fit.count();
      take(fit, growth);
      noise = InverseDepthNoise(image_.noise(), growth.coefficients);
    };
    add(seed);
    for (std::size_t next = 0; next < growth.cells.size(); ++next) {
      const PixelCell& cell = cells_[growth.cells[next]];
      cells_.visitAround(cell, 1, add);
      // What is beyond others of the plane is near one of them, too.
      if (!rough && !isInside(cell)) cells_.visitAround(cell, kGap, add);
    }
    take(fit, growth);
    growth.scatter = squares / fit.count();
  }

  /// Whether the search has all cells around this one.
  bool isInside(const PixelCell& cell) const {
    int members = 0;
    cells_.visitAround(cell, 1, [&](int other) {
      members += member_[static_cast<std::size_t>(other)] == search_ ? 1 : 0;
    });
    return members == 9;
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
    ++tries_[static_cast<std::size_t>(seed)];
    Growth growth = beginAt(seed);
    if (!fitWindow(seed, 2, growth)) return;
    for (const bool rough : {true, false}) {
      spread(seed, rough, growth);
      if (growth.cells.size() < kLeastCells) return;
    }
    // A part of the pixels of a plane near others is open.
    if (2.0 * pixelsOf(growth) < least_pixels_) return;
    const bool found = growth.scatter <= kCellScatter * most_scatter_ && fitAndKeep(seed, growth);
    for (const int index : growth.cells) {
      tries_[static_cast<std::size_t>(index)] += found ? kMostTries : 1;
    }
  }

  bool fitAndKeep(int seed, Growth& growth) {
    const auto fitted = [&] {
      PixelRegion region{growth.frame, {}, growth.coefficients};
      for (const int index : growth.cells) region.cells.push_back(cells_[index]);
      return fitter_.fit(region) ? std::optional<PixelRegion>(region) : std::nullopt;
    };
    // What edges left the plane askew may have ended it too early.
    std::optional<PixelRegion> region = fitted();
    if (region) {
      const std::size_t before = growth.cells.size();
      growth.coefficients = region->coefficients;
      spread(seed, false, growth);
      if (static_cast<double>(growth.cells.size()) > kGrowth * static_cast<double>(before)) {
        region = fitted();
      }
    }
    return region && fitter_.keep(*region);
  }

  const DepthImage& image_;
  PixelCells cells_;
  RegionFitter fitter_;
  double squared_gate_;
  double least_pixels_, most_scatter_;
  std::vector<int> tries_;    ///< per cell: regions with it; those of planes have no more
  std::vector<int> reached_;  ///< per cell: the last search that decided on it
  std::vector<int> member_;   ///< per cell: the last search that added it
  int search_ = 0;
};

}  // namespace

std::vector<PixelPlane> growPlanes(const DepthImage& image, const std::vector<std::uint8_t>& open,
                                   const std::vector<KnownSurface>& surfaces,
                                   const RegionRule& rule) {
  return PlaneGrower(image, open, surfaces, rule).grow();
}

}  // namespace opp
