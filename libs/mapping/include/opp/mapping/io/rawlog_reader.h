// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/scan.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace opp::mapping {

/// Which 3D observations of a rawlog are wanted.
struct RawlogOptions {
  /// ECMAScript regular expression that a whole sensor label must match; empty: every sensor.
  std::string sensor_label;
  /// Half-open range [from_index, to_index) of Scan::index.
  std::size_t from_index = 0;
  std::size_t to_index = std::numeric_limits<std::size_t>::max();
  std::size_t every = 1;  ///< keep each K-th of the range, the first one included
  /// Folder of depth images stored outside of the rawlog; empty: see imagesDirectoryOf.
  std::filesystem::path images_directory;
};

/// Odometry of the body. Absolute readings and the increments of action/frame rawlogs both come as
/// poses in one odometry frame.
struct OdometryReading {
  double timestamp = 0.0;  ///< Unix time [s]; increments: of the first observation they lead to
  Eigen::Isometry3d odom_from_body = Eigen::Isometry3d::Identity();
};

using RawlogEntry = std::variant<OdometryReading, Scan>;

/// What became of the contents of a rawlog so far. Nothing is left out without being counted here.
struct RawlogCounts {
  std::size_t objects = 0;     ///< top-level objects read from the file
  std::size_t scans = 0;       ///< 3D observations delivered
  std::size_t odometry = 0;    ///< odometry readings delivered
  std::size_t deselected = 0;  ///< 3D observations outside of RawlogOptions
  /// Objects that hold no 3D measurement, by reason (a class name or a sentence).
  std::map<std::string, std::size_t> skipped;
  std::map<std::string, std::size_t> labels;  ///< 3D observations by sensor label
};

/// Reads a rawlog from front to back, one entry in memory at a time, whatever its length.
///
/// 3D observations: CObservation3DRangeScan (organized; depth inside or outside of the file),
/// CObservationPointCloud, CObservationVelodyneScan, CObservationRotatingScan (organized).
/// Odometry: CObservationOdometry, CActionRobotMovement2D and 3D. Formats: observations only,
/// action/frame pairs, lone frames, one CRawlog object; gzip or plain.
///
/// Scan::index counts the 3D observations whose label matches RawlogOptions::sensor_label.
/// Not safe for use by two threads at once; several readers are.
class RawlogReader {
 public:
  /// Opens the file. \throws std::runtime_error if it is missing, a folder or unreadable;
  /// std::invalid_argument for a bad regular expression, an empty range or every = 0.
  explicit RawlogReader(const std::filesystem::path& file, RawlogOptions options = {});
  ~RawlogReader();
  RawlogReader(RawlogReader&&) noexcept;
  RawlogReader& operator=(RawlogReader&&) noexcept;

  /// The next entry in the order of the file; nothing at its end. A damaged file ends where the
  /// damage starts, see damage(). \throws std::runtime_error at the end of a file that delivered no
  /// scan: says what the file holds instead and what to do.
  std::optional<RawlogEntry> next();

  /// As next(), but passes over odometry.
  std::optional<Scan> nextScan();

  double progress() const;             ///< part of the file that has been read, in [0, 1]
  const RawlogCounts& counts() const;  ///< up to now
  /// Empty, or what is wrong with the file from here on: where, how many objects came before (all
  /// of them have been delivered), and what to do. Known once next() has returned nothing.
  const std::string& damage() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Folder of the images that belong to a rawlog: the first of <stem>_Images, <stem>_images,
/// <stem>_IMAGES and Images beside the file that exists; else the file's own folder.
std::filesystem::path imagesDirectoryOf(const std::filesystem::path& rawlog);

}  // namespace opp::mapping
