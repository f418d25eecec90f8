// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/rotating_scan_to_cloud.h"

#include "opp/geometry/constants.h"

#include <mrpt/obs/VelodyneCalibration.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

namespace opp::mapping {
namespace {

using mrpt::obs::CObservationRotatingScan;
using mrpt::obs::VelodyneCalibration;

/// A sweep that lacks less than this part of a turn is a whole revolution: drivers cut it at packet
/// boundaries.
constexpr double kMaxGapOfRevolution = 0.01;

/// Elevation of each beam [rad]. The class stores none; they follow from the model's name.
std::vector<double> beamElevations(const CObservationRotatingScan& scan) {
  std::string model;
  std::copy_if(scan.lidarModel.begin(), scan.lidarModel.end(), std::back_inserter(model),
               [](char c) { return c != '-'; });
  if (model == "HDL32E") model = "HDL32";
  const auto& beams = VelodyneCalibration::LoadDefaultCalibration(model).laser_corrections;
  if (beams.size() != scan.rowCount) {
    throw std::runtime_error("CObservationRotatingScan of lidar model '" + scan.lidarModel +
                             "', whose beam angles are not known");
  }
  std::vector<double> elevations;
  for (const auto& beam : beams) elevations.push_back(degToRad(beam.verticalCorrection));
  return elevations;
}

bool hasReturn(const CObservationRotatingScan& scan, int col) {
  for (int row = 0; row < scan.rangeImage.rows(); ++row) {
    if (scan.rangeImage(row, col) != 0) return true;
  }
  return false;
}

/// Number of firings of the sweep. MRPT 2.5 makes the image of multi-beam lidars as many times too
/// wide as there are rows and fills its first part only.
int firingCount(const CObservationRotatingScan& scan) {
  const int cols = static_cast<int>(scan.rangeImage.cols());
  const int firings = cols / scan.rowCount;
  for (int col = firings; col < cols; ++col) {
    if (hasReturn(scan, col)) return cols;
  }
  return firings;
}

Eigen::Vector3f pointOf(double range, double elevation, double azimuth) {
  // Velodyne's azimuth runs clockwise seen from above.
  return Eigen::Vector3d(range * std::cos(elevation) * std::cos(azimuth),
                         -range * std::cos(elevation) * std::sin(azimuth),
                         range * std::sin(elevation))
      .cast<float>();
}

}  // namespace

PointCloud rotatingScanInSensor(const CObservationRotatingScan& scan) {
  if (scan.rangeImage.size() == 0 || scan.rangeImage.rows() != scan.rowCount) {
    throw std::runtime_error("CObservationRotatingScan without range image");
  }
  const std::vector<double> elevations = beamElevations(scan);
  std::vector<int> beams(elevations.size());
  std::iota(beams.begin(), beams.end(), 0);
  std::sort(beams.begin(), beams.end(), [&](int a, int b) {
    return elevations[static_cast<std::size_t>(a)] > elevations[static_cast<std::size_t>(b)];
  });
  const int firings = firingCount(scan);
  std::vector<int> columns;
  for (int col = 0; col < firings; ++col) {
    if (hasReturn(scan, col)) columns.push_back(col);
  }
  if (columns.empty()) throw std::runtime_error("CObservationRotatingScan without returns");

  PointCloud cloud;
  cloud.rows = scan.rowCount;
  cloud.cols = static_cast<int>(columns.size());
  cloud.columns_wrap = std::abs(scan.azimuthSpan) > (1.0 - kMaxGapOfRevolution) * 2.0 * kPi;
  for (const int beam : beams) {
    const double elevation = elevations[static_cast<std::size_t>(beam)];
    for (const int col : columns) {
      const double range = scan.rangeImage(beam, col) * scan.rangeResolution;
      const double azimuth = scan.startAzimuth + scan.azimuthSpan * col / firings;
      const double measured = range > 0.0 ? range : std::numeric_limits<double>::quiet_NaN();
      cloud.points.push_back(pointOf(measured, elevation, azimuth));
    }
  }
  return cloud;
}

}  // namespace opp::mapping
