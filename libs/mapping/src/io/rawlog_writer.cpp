// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/rawlog_writer.h"

#include "opp/mapping/io/mrpt_convert.h"

#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <system_error>

namespace opp::mapping {
namespace {

mrpt::obs::CObservation3DRangeScan::Ptr toObservation(const RawlogStamp& stamp,
                                                      const RawlogDepthImage& image) {
  const auto pixels =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.width < 1 || image.height < 1 || image.counts.size() != pixels) {
    throw std::invalid_argument("depth image: width × height is not the number of counts");
  }
  if (!(image.fx > 0.0) || !(image.fy > 0.0) || !(image.range_unit > 0.0)) {
    throw std::invalid_argument("depth image: focal lengths and range unit must be positive");
  }
  auto observation = mrpt::obs::CObservation3DRangeScan::Create();
  observation->timestamp = mrpt::Clock::fromDouble(stamp.timestamp);
  observation->sensorLabel = stamp.label;
  observation->sensorPose = toCPose3D(stamp.body_from_sensor);
  observation->hasRangeImage = true;
  observation->range_is_depth = true;
  observation->rangeUnits = static_cast<float>(image.range_unit);
  observation->maxRange = static_cast<float>(image.max_range);
  auto& camera = observation->cameraParams;
  camera.ncols = static_cast<std::uint32_t>(image.width);
  camera.nrows = static_cast<std::uint32_t>(image.height);
  camera.setIntrinsicParamsFromValues(image.fx, image.fy, image.cx, image.cy);
  observation->cameraParamsIntensity = camera;
  observation->rangeImage_setSize(image.height, image.width);
  std::copy(image.counts.begin(), image.counts.end(), observation->rangeImage.data());
  return observation;
}

mrpt::obs::CObservationPointCloud::Ptr toObservation(const RawlogStamp& stamp,
                                                     const std::vector<Eigen::Vector3f>& points) {
  auto map = mrpt::maps::CSimplePointsMap::Create();
  map->reserve(points.size());
  for (const auto& point : points) map->insertPointFast(point.x(), point.y(), point.z());
  auto observation = mrpt::obs::CObservationPointCloud::Create();
  observation->timestamp = mrpt::Clock::fromDouble(stamp.timestamp);
  observation->sensorLabel = stamp.label;
  observation->sensorPose = toCPose3D(stamp.body_from_sensor);
  observation->pointcloud = map;
  return observation;
}

}  // namespace

struct RawlogWriter::Impl {
  std::filesystem::path file;
  std::filesystem::path unfinished;
  RawlogWriterOptions options;
  mrpt::io::CFileGZOutputStream stream;
  Eigen::Isometry3d increment = Eigen::Isometry3d::Identity();  ///< since the last pair
  Eigen::Isometry3d odom_from_body = Eigen::Isometry3d::Identity();
  bool has_odometry = false;
  bool open = true;

  void put(const mrpt::serialization::CSerializable& object) {
    auto archive = mrpt::serialization::archiveFrom(stream);
    archive << object;
  }
  void putObservation(const mrpt::obs::CObservation::Ptr& observation);
  ~Impl() {
    if (!open) return;
    stream.close();
    std::error_code ignored;
    std::filesystem::remove(unfinished, ignored);
  }
};

void RawlogWriter::Impl::putObservation(const mrpt::obs::CObservation::Ptr& observation) {
  if (!options.action_format) return put(*observation);
  // MRPT 2.5.8's computeFromOdometry gets the mean of 3D increments wrong: filled by hand.
  mrpt::obs::CActionRobotMovement3D movement;
  movement.timestamp = observation->timestamp;
  movement.estimationMethod = mrpt::obs::CActionRobotMovement3D::emOdometry;
  movement.rawOdometryIncrementReading = toCPose3D(increment);
  movement.poseChange.mean = movement.rawOdometryIncrementReading;
  movement.poseChange.cov.setIdentity();
  movement.poseChange.cov *= 1e-4;  // (1 cm)², (0.6°)²: an order of magnitude; readers need > 0
  mrpt::obs::CActionCollection actions;
  actions.insert(movement);
  mrpt::obs::CSensoryFrame frame;
  frame.insert(observation);
  put(actions);
  put(frame);
  increment.setIdentity();
}

RawlogWriter::RawlogWriter(const std::filesystem::path& file, const RawlogWriterOptions& options)
    : impl_(std::make_unique<Impl>()) {
  if (options.compression < 0 || options.compression > 9) {
    throw std::invalid_argument("rawlog: gzip level must be from 0 to 9");
  }
  impl_->file = file;
  impl_->unfinished = file.string() + ".unfinished";
  impl_->options = options;
  if (!impl_->stream.open(impl_->unfinished.string(), options.compression)) {
    throw std::runtime_error("cannot write '" + impl_->unfinished.string() +
                             "'; does the folder exist, and may you write there?");
  }
}

RawlogWriter::~RawlogWriter() = default;
RawlogWriter::RawlogWriter(RawlogWriter&&) noexcept = default;
RawlogWriter& RawlogWriter::operator=(RawlogWriter&&) noexcept = default;

void RawlogWriter::writeOdometry(double timestamp, const Eigen::Isometry3d& odom_from_body) {
  if (impl_->has_odometry) {
    impl_->increment = impl_->increment * impl_->odom_from_body.inverse() * odom_from_body;
  }
  impl_->odom_from_body = odom_from_body;
  impl_->has_odometry = true;
  if (impl_->options.action_format) return;
  mrpt::obs::CObservationOdometry observation;
  observation.timestamp = mrpt::Clock::fromDouble(timestamp);
  observation.sensorLabel = "ODOMETRY";
  observation.odometry = mrpt::poses::CPose2D(toCPose3D(odom_from_body));
  impl_->put(observation);
}

void RawlogWriter::write(const RawlogStamp& stamp, const RawlogDepthImage& image) {
  impl_->putObservation(toObservation(stamp, image));
}

void RawlogWriter::write(const RawlogStamp& stamp,
                         const std::vector<Eigen::Vector3f>& points_in_sensor) {
  impl_->putObservation(toObservation(stamp, points_in_sensor));
}

void RawlogWriter::close() {
  impl_->stream.close();
  impl_->open = false;
  std::error_code error;
  std::filesystem::rename(impl_->unfinished, impl_->file, error);
  if (error) {
    throw std::runtime_error("cannot write '" + impl_->file.string() + "': " + error.message());
  }
}

}  // namespace opp::mapping
