// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cloud/depth_image.h"
#include "narrow/grow_planes.h"
#include "narrow/inverse_depth_fit.h"
#include "narrow/known_surface.h"
#include "narrow/pixel_cells.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace opp {

/// Where a plane was found, and its fit to the pixels there.
struct PixelRegion {
  RayFrame frame;
  std::vector<PixelCell> cells;
  Eigen::Vector3d coefficients;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  std::vector<int> pixels = {};  ///< on the plane, ascending
};

/// Fits planes to the pixels of regions and judges them.
class RegionFitter {
 public:
  /// `image` must outlive this.
  RegionFitter(const DepthImage& image, std::vector<KnownSurface> surfaces, RegionRule rule);

  /// Fits the region's plane to the pixels of its cells and around them that no plane kept has; not
  /// to those whose ray would meet it beyond its edge with another surface. False if they are too
  /// few.
  bool fit(PixelRegion& region);
  bool isPlane(const PixelRegion& region) const;
  /// Whether a plane that was kept is that of the region, too.
  bool isKept(const PixelRegion& region) const;
  /// The region's pixels then are not of others.
  void keep(PixelRegion region);
  /// Fits all that were kept once more, as each now knows the others.
  std::vector<PixelPlane> refitAll();

 private:
  /// A surface near the region.
  struct Rival {
    const KnownSurface* surface;
    double side;  ///< of the region [m]
    bool parallel;
  };
  /// Pixels that a region's plane may be fitted to.
  struct Candidates {
    std::vector<int> pixels;
    RayArrays rays;
    std::vector<double> squared_ranges;
    Eigen::ArrayXd is_own;  ///< 1; 0 beyond an edge with another surface
  };
  Candidates candidatesOf(const PixelRegion& region);
  std::vector<Rival> rivalsOf(const PixelRegion& region) const;
  void markOwn(const PixelRegion& region, Candidates& candidates) const;
  /// Marks those that are the rival's. \param own_depths inverse depths of the region's plane.
  void markBeyond(const Rival& rival, const RayFrame& frame, const Eigen::ArrayXd& own_depths,
                  Candidates& candidates) const;
  /// Whether planes were kept near this one since.
  bool hasNewRivals(std::size_t kept) const;
  void claim(const PixelRegion& region);

  const DepthImage& image_;
  std::vector<KnownSurface> surfaces_;  ///< those kept follow those known
  std::size_t known_;
  std::size_t self_;  ///< surface that is fitted once more
  RegionRule rule_;
  std::vector<PixelRegion> kept_;
  std::vector<std::uint8_t> taken_;  ///< per pixel
  std::vector<int> reached_;         ///< per pixel: the last search that reached it
  int search_ = 0;
};

}  // namespace opp
