// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "export/embed_observation.h"

#include "opp/mapping/io/mrpt_convert.h"

#include <mrpt/img/CImage.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <cmath>
#include <vector>

namespace opp::mapping {
namespace {

/// Points beside a depth image: enough for maps of a keyframe, small beside the image itself.
constexpr double kPointsPerImage = 20000.0;

void embedImage(mrpt::img::CImage& image, bool& is_present) {
  if (!is_present || !image.isExternallyStored()) return;
  mrpt::img::CImage embedded;
  is_present = embedded.loadFromFile(image.getExternalStorageFileAbsolutePath());
  image = is_present ? embedded : mrpt::img::CImage();
}

void setPoints(const PointCloud& cloud_in_body, mrpt::obs::CObservation3DRangeScan& scan) {
  const Eigen::Isometry3f sensor_from_body = toIsometry(scan.sensorPose).inverse().cast<float>();
  const auto stride = static_cast<std::size_t>(std::max(
      1.0, std::floor(std::sqrt(static_cast<double>(cloud_in_body.size()) / kPointsPerImage))));
  const auto cols = static_cast<std::size_t>(cloud_in_body.cols);
  std::vector<std::pair<std::size_t, Eigen::Vector3f>> points;
  for (std::size_t i = 0; i < cloud_in_body.size(); ++i) {
    if (i % cols % stride != 0 || i / cols % stride != 0) continue;
    const Eigen::Vector3f& point = cloud_in_body.points[i];
    if (point.allFinite()) points.emplace_back(i, sensor_from_body * point);
  }
  scan.resizePoints3DVectors(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto& [pixel, point] = points[k];
    scan.points3D_x[k] = point.x();
    scan.points3D_y[k] = point.y();
    scan.points3D_z[k] = point.z();
    scan.points3D_idxs_x[k] = static_cast<uint16_t>(pixel % cols);
    scan.points3D_idxs_y[k] = static_cast<uint16_t>(pixel / cols);
  }
  scan.hasPoints3D = true;
}

}  // namespace

void embed(mrpt::obs::CObservation& observation, ObservationConverter& converter) {
  using mrpt::obs::CObservationPointCloud;
  if (auto* scan = dynamic_cast<mrpt::obs::CObservation3DRangeScan*>(&observation)) {
    const PointCloud cloud_in_body = converter.convert(*scan, ImagesAfterwards::kKeep);
    if (cloud_in_body.organized() && !scan->hasPoints3D) setPoints(cloud_in_body, *scan);
    scan->rangeImage_forceResetExternalStorage();
    scan->points3D_overrideExternalStoredFlag(false);
    embedImage(scan->intensityImage, scan->hasIntensityImage);
    embedImage(scan->confidenceImage, scan->hasConfidenceImage);
  } else if (auto* points = dynamic_cast<CObservationPointCloud*>(&observation)) {
    converter.convert(*points, ImagesAfterwards::kKeep);
    points->overrideExternalStorageFormatFlag(CObservationPointCloud::ExternalStorageFormat::None);
  }
}

}  // namespace opp::mapping
