// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/observation_to_cloud.h"

#include "opp/mapping/io/mrpt_convert.h"

#include "io/rotating_scan_to_cloud.h"

#include <mrpt/io/lazy_load_path.h>
#include <mrpt/maps/CPointsMap.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <limits>
#include <mutex>
#include <stdexcept>

namespace opp::mapping {
namespace {

using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationPointCloud;
using mrpt::obs::CObservationRotatingScan;
using mrpt::obs::CObservationVelodyneScan;

const Eigen::Vector3f kNoPoint = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());

/// Loads images that lie outside of the rawlog. MRPT keeps their folder in one global variable.
void load(const mrpt::obs::CObservation& observation, const std::filesystem::path& directory) {
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  mrpt::io::setLazyLoadPathBase(directory.string());
  try {
    observation.load();
  } catch (const std::exception&) {
    throw std::runtime_error("images outside of the rawlog not found in " + directory.string());
  }
}

PointCloud cloudOfPoints(const float* x, const float* y, const float* z, std::size_t count) {
  PointCloud cloud;
  cloud.points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) cloud.points.emplace_back(x[i], y[i], z[i]);
  return cloud;
}

void transform(const mrpt::poses::CPose3D& sensor_pose, PointCloud& cloud) {
  const Eigen::Isometry3f body_from_sensor = toIsometry(sensor_pose).cast<float>();
  for (Eigen::Vector3f& point : cloud.points) point = body_from_sensor * point;
  cloud.viewpoint = body_from_sensor.translation();
}

PointCloud unproject(const CObservation3DRangeScan& scan,
                     const std::vector<Eigen::Vector3f>& rays) {
  const auto& image = scan.rangeImage;
  const Eigen::Isometry3f body_from_sensor = toIsometry(scan.sensorPose).cast<float>();
  const Eigen::Matrix3f rotation = body_from_sensor.linear();
  const Eigen::Vector3f origin = body_from_sensor.translation();
  PointCloud cloud;
  cloud.rows = static_cast<int>(image.rows());
  cloud.cols = static_cast<int>(image.cols());
  cloud.viewpoint = origin;
  cloud.points.resize(rays.size());
  const uint16_t* ranges = &image(0, 0);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const float range = static_cast<float>(ranges[i]) * scan.rangeUnits;
    const float depth = scan.range_is_depth ? range : range / rays[i].norm();
    cloud.points[i] =
        ranges[i] == 0 ? kNoPoint : Eigen::Vector3f(rotation * (depth * rays[i]) + origin);
  }
  return cloud;
}

PointCloud convertRangeScan(const CObservation3DRangeScan& scan, PixelRayCache& cache) {
  if (scan.hasRangeImage && scan.rangeImage.size() > 0) {
    if (scan.rangeImage.cols() != static_cast<int>(scan.cameraParams.ncols) ||
        scan.rangeImage.rows() != static_cast<int>(scan.cameraParams.nrows)) {
      throw std::runtime_error("the depth image and its camera differ in size");
    }
    return unproject(scan, *cache.raysOf(scan.cameraParams));
  }
  const std::size_t count = scan.points3D_x.size();
  if (!scan.hasPoints3D || count == 0 || scan.points3D_y.size() != count ||
      scan.points3D_z.size() != count) {
    throw std::runtime_error("CObservation3DRangeScan without depth image and points");
  }
  PointCloud cloud =
      cloudOfPoints(scan.points3D_x.data(), scan.points3D_y.data(), scan.points3D_z.data(), count);
  transform(scan.sensorPose, cloud);
  return cloud;
}

PointCloud convertPoints(const CObservationPointCloud& observation) {
  if (!observation.pointcloud || observation.pointcloud->empty()) {
    throw std::runtime_error("CObservationPointCloud without points");
  }
  const auto& map = *observation.pointcloud;
  const auto& x = map.getPointsBufferRef_x();
  PointCloud cloud = cloudOfPoints(x.data(), map.getPointsBufferRef_y().data(),
                                   map.getPointsBufferRef_z().data(), x.size());
  transform(observation.sensorPose, cloud);
  return cloud;
}

PointCloud convertVelodyne(CObservationVelodyneScan& scan) {
  scan.generatePointCloud();
  const auto& points = scan.point_cloud;
  if (points.size() == 0) throw std::runtime_error("CObservationVelodyneScan without returns");
  PointCloud cloud =
      cloudOfPoints(points.x.data(), points.y.data(), points.z.data(), points.size());
  transform(scan.sensorPose, cloud);
  return cloud;
}

}  // namespace

bool ObservationConverter::isScan(const mrpt::obs::CObservation& observation) {
  if (const auto* rotating = dynamic_cast<const CObservationRotatingScan*>(&observation)) {
    return rotating->rowCount > 1;
  }
  return dynamic_cast<const CObservation3DRangeScan*>(&observation) != nullptr ||
         dynamic_cast<const CObservationPointCloud*>(&observation) != nullptr ||
         dynamic_cast<const CObservationVelodyneScan*>(&observation) != nullptr;
}

PointCloud ObservationConverter::convert(mrpt::obs::CObservation& observation,
                                         ImagesAfterwards images) {
  load(observation, images_directory_);
  PointCloud cloud;
  if (const auto* range_scan = dynamic_cast<CObservation3DRangeScan*>(&observation)) {
    cloud = convertRangeScan(*range_scan, rays_);
  } else if (const auto* points = dynamic_cast<CObservationPointCloud*>(&observation)) {
    cloud = convertPoints(*points);
  } else if (auto* velodyne = dynamic_cast<CObservationVelodyneScan*>(&observation)) {
    cloud = convertVelodyne(*velodyne);
  } else if (const auto* rotating = dynamic_cast<CObservationRotatingScan*>(&observation)) {
    cloud = rotatingScanInSensor(*rotating);
    transform(rotating->sensorPose, cloud);
  } else {
    throw std::runtime_error("not a 3D observation");
  }
  if (images == ImagesAfterwards::kFree) observation.unload();
  return cloud;
}

}  // namespace opp::mapping
