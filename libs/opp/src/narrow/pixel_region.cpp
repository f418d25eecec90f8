// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "narrow/pixel_region.h"

#include "geometry/planar_spread.h"
#include "geometry/visit_neighbours.h"
#include "narrow/cell_shape.h"
#include "narrow/inverse_depth_noise.h"
#include "narrow/pixel_blocks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace opp {
namespace {

/// Pixels around a region's cells that may be on its plane: others near it keep them from being
/// open.
constexpr int kMargin = 2;
constexpr int kPasses = 3;
/// Edges are looked for before these passes: a pass moves them little.
constexpr int kEdgeStride = 2;
/// Tukey's biweight, in standard deviations.
constexpr double kOutlier = 4.0;
/// The ray of a pixel is known to half a pixel, which side of an edge it shows no better.
constexpr double kEdgePixels = 0.5;
/// Cells in a line have two neighbours each, in two lines five: seams between surfaces are lines.
constexpr double kLeastNeighbours = 3.5;
/// What is left at the rim of a plane scatters more about it.
constexpr double kRimScatter = 1.5;
/// Surfaces that are as parallel as this have no edge with each other.
constexpr double kParallelCosine = 0.97;

double meanNeighbours(const std::vector<PixelBlock>& cells) {
  double pairs = 0.0;
  visitNeighbours(cells, [&](std::size_t, std::size_t) { pairs += 2.0; });
  return pairs / static_cast<double>(cells.size());
}

KnownSurface surfaceOf(const DepthImage& image, const PixelRegion& region) {
  Eigen::AlignedBox3f reach;
  for (const int pixel : region.pixels) reach.extend(image.point(pixel));
  const float margin = static_cast<float>(kMargin * image.pixelAngle()) * reach.center().norm();
  reach.min().array() -= margin;
  reach.max().array() += margin;
  return {region.frame.planeOf(region.coefficients), reach, image.noise()};
}

}  // namespace

RegionFitter::RegionFitter(const DepthImage& image, std::vector<KnownSurface> surfaces,
                           RegionRule rule)
    : image_(image),
      surfaces_(std::move(surfaces)),
      known_(surfaces_.size()),
      self_(std::numeric_limits<std::size_t>::max()),
      rule_(std::move(rule)),
      taken_(image.size(), 0),
      reached_(image.size(), 0) {}

RegionFitter::Candidates RegionFitter::candidatesOf(const PixelRegion& region) {
  Candidates candidates;
  ++search_;
  for (const PixelCell& cell : region.cells) {
    const int top = cell.row * PixelCell::kEdge, left = cell.col * PixelCell::kEdge;
    const int bottom = std::min(image_.rows(), top + PixelCell::kEdge + kMargin);
    const int right = std::min(image_.cols(), left + PixelCell::kEdge + kMargin);
    for (int row = std::max(0, top - kMargin); row < bottom; ++row) {
      for (int col = std::max(0, left - kMargin); col < right; ++col) {
        const int pixel = image_.indexOf(row, col);
        const auto at = static_cast<std::size_t>(pixel);
        if (reached_[at] == search_ || taken_[at] != 0) continue;
        reached_[at] = search_;
        const Eigen::Vector3f point = image_.point(pixel);
        if (!image_.inRange(point)) continue;
        const RayFrame::Ray ray = region.frame.of(point);
        if (!(ray.inverse_depth > 0.0)) continue;
        candidates.pixels.push_back(pixel);
        candidates.rays.add(ray);
        candidates.squared_ranges.push_back(static_cast<double>(point.squaredNorm()));
      }
    }
  }
  return candidates;
}

std::vector<RegionFitter::Rival> RegionFitter::rivalsOf(const PixelRegion& region) const {
  Eigen::AlignedBox3f box;
  Eigen::Vector3f center = Eigen::Vector3f::Zero();
  float farthest = 0.0F;
  for (const PixelCell& cell : region.cells) {
    box.extend(cell.point);
    center += cell.point / static_cast<float>(region.cells.size());
    farthest = std::max(farthest, cell.range);
  }
  const double margin = kMargin * image_.pixelAngle() * static_cast<double>(farthest);
  const Plane plane = region.frame.planeOf(region.coefficients);
  std::vector<Rival> rivals;
  for (std::size_t k = 0; k < surfaces_.size(); ++k) {
    const KnownSurface& surface = surfaces_[k];
    if (k == self_ || !surface.reach().intersects(box)) continue;
    if (!surface.isNear(box, static_cast<double>(farthest), margin, rule_.test_sigmas)) continue;
    const double cosine = plane.normal().dot(surface.normal().cast<double>());
    const double side = surface.offset(center);
    const bool parallel = std::abs(cosine) > kParallelCosine;
    const double gate = rule_.test_sigmas * rule_.test_sigmas;
    // A part of the same plane.
    if (parallel && surface.misfit(center) < gate) continue;
    rivals.push_back({&surface, side, parallel});
  }
  return rivals;
}

void RegionFitter::markBeyond(const Rival& rival, const RayFrame& frame,
                              const Eigen::ArrayXd& own_depths, Candidates& candidates) const {
  const KnownSurface& surface = *rival.surface;
  const auto depths = RayArrays::view(candidates.rays.inverse_depth);
  const Eigen::ArrayXd along = candidates.rays.times(frame.along(surface.normal().cast<double>()));
  const Eigen::ArrayXd offsets = along / depths - surface.height();
  const double gate = rule_.test_sigmas * rule_.test_sigmas;
  const Eigen::ArrayXd most =
      gate * surface.noise().variances(RayArrays::view(candidates.squared_ranges));
  for (Eigen::Index i = 0; i < offsets.size(); ++i) {
    const double offset = offsets[i];
    if (offset * offset > most[i]) continue;
    const int pixel = candidates.pixels[static_cast<std::size_t>(i)];
    if (!surface.reaches(image_.point(pixel))) continue;
    // Where the ray meets the region's plane.
    const double meeting = along[i] / own_depths[i] - surface.height();
    const double range = std::sqrt(candidates.squared_ranges[static_cast<std::size_t>(i)]) *
                         depths[i] / own_depths[i];
    const double margin = kEdgePixels * image_.pixelAngle() * range;
    // Parallel surfaces have no edge: the nearer has the pixel.
    const bool is_beyond = rival.parallel
                               ? std::abs(offset) < std::abs(meeting - offset)
                               : meeting * rival.side < 0.0 || std::abs(meeting) < margin;
    if (is_beyond) candidates.is_own[i] = 0.0;
  }
}

void RegionFitter::markOwn(const PixelRegion& region, Candidates& candidates) const {
  candidates.is_own = Eigen::ArrayXd::Ones(static_cast<Eigen::Index>(candidates.pixels.size()));
  const Eigen::ArrayXd own_depths = candidates.rays.times(region.coefficients);
  for (const Rival& rival : rivalsOf(region)) {
    markBeyond(rival, region.frame, own_depths, candidates);
  }
}

bool RegionFitter::fit(PixelRegion& region) {
  Candidates candidates = candidatesOf(region);
  const auto depths = RayArrays::view(candidates.rays.inverse_depth);
  const double gate = rule_.params.gate * rule_.params.gate;
  Eigen::ArrayXd misfits;
  for (int pass = 0; pass < kPasses; ++pass) {
    if (pass % kEdgeStride == 0) markOwn(region, candidates);
    const Eigen::ArrayXd precisions =
        1.0 / InverseDepthNoise(image_.noise(), region.coefficients)
                  .variances(RayArrays::view(candidates.squared_ranges), depths);
    misfits = (candidates.rays.times(region.coefficients) - depths).square() * precisions;
    const Eigen::ArrayXd roots =
        candidates.is_own * (1.0 - misfits / (kOutlier * kOutlier)).max(0.0);
    InverseDepthFit fit;
    fit.add(candidates.rays, roots.square() * precisions);
    if (2.0 * fit.count() < rule_.params.min_pixels || !fit.solve()) return false;
    region.coefficients = fit.coefficients();
    region.covariance = fit.covariance();
  }
  region.pixels.clear();
  for (Eigen::Index i = 0; i < misfits.size(); ++i) {
    if (candidates.is_own[i] == 0.0 || misfits[i] > gate) continue;
    region.pixels.push_back(candidates.pixels[static_cast<std::size_t>(i)]);
  }
  std::sort(region.pixels.begin(), region.pixels.end());
  return true;
}

bool RegionFitter::isPlane(const PixelRegion& region) const {
  const NarrowParams& params = rule_.params;
  const auto count = static_cast<double>(region.pixels.size());
  if (count < params.min_pixels) return false;
  PlanarSpread rays;
  for (const int pixel : region.pixels) {
    const RayFrame::Ray ray = region.frame.of(image_.point(pixel));
    rays.add(ray.u, ray.v);
  }
  if (rays.widths()[0] < params.min_width * image_.pixelAngle()) return false;
  const RayFrame::Ray middle{rays.mean().x(), rays.mean().y(), 1.0};
  const Plane plane = region.frame.planeOf(region.coefficients);
  const Eigen::Vector3d ray = region.frame.meet(middle, region.coefficients).normalized();
  if (std::abs(plane.normal().dot(ray)) < std::cos(rule_.max_incidence)) return false;
  // The errors of the pixels in a patch are correlated.
  constexpr double kPatch = kPatchEdge * kPatchEdge;
  const double angle_variance = kPatch * image_.sensor().meanVariance(kPatch) *
                                region.frame.angleVariance(region.coefficients, region.covariance);
  if (angle_variance > params.max_uncertainty * params.max_uncertainty) return false;
  const std::vector<PixelBlock> cells = pixelBlocks(image_, region.pixels, PixelCell::kEdge);
  if (meanNeighbours(cells) < kLeastNeighbours) return false;
  const CellShape shape(image_, plane, cells);
  return shape.scatter() <= params.max_scatter && !shape.turns(rule_.max_turn, rule_.test_sigmas);
}

bool RegionFitter::isKept(const PixelRegion& region) const {
  const std::vector<PixelBlock> cells = pixelBlocks(image_, region.pixels, PixelCell::kEdge);
  const KnownSurface own = surfaceOf(image_, region);
  for (std::size_t k = 0; k < kept_.size(); ++k) {
    if (!surfaces_[known_ + k].reach().intersects(own.reach())) continue;
    const Plane plane = kept_[k].frame.planeOf(kept_[k].coefficients);
    if (CellShape(image_, plane, cells).scatter() <= kRimScatter * rule_.params.max_scatter) {
      return true;
    }
  }
  return false;
}

void RegionFitter::claim(const PixelRegion& region) {
  for (const int pixel : region.pixels) taken_[static_cast<std::size_t>(pixel)] = 1;
}

void RegionFitter::keep(PixelRegion region) {
  claim(region);
  surfaces_.push_back(surfaceOf(image_, region));
  kept_.push_back(std::move(region));
}

bool RegionFitter::hasNewRivals(std::size_t kept) const {
  const KnownSurface& own = surfaces_[known_ + kept];
  return std::any_of(
      surfaces_.begin() + static_cast<std::ptrdiff_t>(known_ + kept) + 1, surfaces_.end(),
      [&](const KnownSurface& later) { return own.reach().intersects(later.reach()); });
}

std::vector<PixelPlane> RegionFitter::refitAll() {
  std::vector<PixelPlane> planes;
  std::fill(taken_.begin(), taken_.end(), std::uint8_t{0});
  for (std::size_t k = 0; k < kept_.size(); ++k) {
    self_ = known_ + k;
    PixelRegion& region = kept_[k];
    if (hasNewRivals(k)) {
      if (!fit(region) || !isPlane(region)) continue;
      surfaces_[self_] = surfaceOf(image_, region);
    }
    claim(region);
    planes.push_back({region.frame.planeOf(region.coefficients), region.pixels});
  }
  return planes;
}

}  // namespace opp
