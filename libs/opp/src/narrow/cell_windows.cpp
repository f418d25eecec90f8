// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "narrow/cell_windows.h"

#include <Eigen/LU>

#include <algorithm>
#include <utility>

namespace opp {
namespace {

/// Cells that fix a plane, of nine.
constexpr int kLeastCells = 6;
/// A window is not flat if its cells scatter more, in variances of the noise.
constexpr double kMostMisfit = 2.5;
/// What a missing cell counts in that.
constexpr double kMissingCell = 0.1;
/// χ² of three degrees of freedom, 0.3 %.
constexpr double kGate = 14.0;
constexpr int kPasses = 2;

CellWindow windowAt(const DepthImage& image, const PixelCells& cells, const PixelCell& center) {
  CellWindow window{false, RayFrame(center.point.cast<double>()), {}, {}};
  // First as if seen straight, then as it is.
  window.coefficients = {1.0 / static_cast<double>(center.range), 0.0, 0.0};
  InverseDepthFit fit;
  for (int pass = 0; pass < kPasses; ++pass) {
    const InverseDepthNoise noise(image.noise(), window.coefficients);
    fit = {};
    cells.visitAround(center, 1, [&](int other) {
      const PixelCell& cell = cells[other];
      if (image.jumps(cell.range, center.range)) return;
      const RayFrame::Ray ray = window.frame.of(cell.point);
      fit.add(ray, 1.0 / cellVariance(cell, ray, noise, image));
    });
    if (fit.count() < kLeastCells || !fit.solve()) return window;
    window.coefficients = fit.coefficients();
    window.covariance = fit.covariance();
  }
  window.misfit = fit.misfit() / (fit.count() - 3.0) + kMissingCell * (9.0 - fit.count());
  window.is_flat = window.misfit < kMostMisfit;
  return window;
}

}  // namespace

double cellVariance(const PixelCell& cell, const RayFrame::Ray& ray, const InverseDepthNoise& noise,
                    const DepthImage& image) {
  const auto range = static_cast<double>(cell.range);
  return noise.variance(range * range, ray.inverse_depth) * image.sensor().meanVariance(cell.count);
}

bool CellWindow::isOn(const RayFrame& plane_frame, const Eigen::Vector3d& plane_coefficients,
                      const Eigen::Matrix3d& plane_covariance) const {
  if (!is_flat) return false;
  const Eigen::Matrix3d turn = plane_frame.axes().transpose() * frame.axes();
  const Eigen::Vector3d off = turn * coefficients - plane_coefficients;
  const Eigen::Matrix3d unknown = turn * covariance * turn.transpose() + plane_covariance;
  return off.dot(unknown.inverse() * off) <= kGate;
}

std::vector<CellWindow> cellWindows(const DepthImage& image, const PixelCells& cells) {
  std::vector<CellWindow> windows;
  windows.reserve(static_cast<std::size_t>(cells.size()));
  for (int index = 0; index < cells.size(); ++index) {
    windows.push_back(windowAt(image, cells, cells[index]));
  }
  return windows;
}

std::vector<int> flattestFirst(const std::vector<CellWindow>& windows) {
  std::vector<std::pair<double, int>> order;
  for (std::size_t index = 0; index < windows.size(); ++index) {
    if (windows[index].is_flat) order.emplace_back(windows[index].misfit, static_cast<int>(index));
  }
  std::sort(order.begin(), order.end());
  std::vector<int> flat;
  for (const auto& [misfit, index] : order) flat.push_back(index);
  return flat;
}

}  // namespace opp
