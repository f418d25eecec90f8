// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/scan_features.h"
#include "opp/mapping/frontend/odometry_track.h"
#include "opp/mapping/io/rawlog_reader.h"
#include "opp/params/primitive_params.h"

#include <deque>
#include <future>
#include <optional>

namespace opp::mapping {

/// A scan's features with the odometry at its time.
struct FeatureFrame {
  ScanFeatures features;
  std::optional<Eigen::Isometry3d> odom_from_body;
};

/// Reads a rawlog and computes the features of its scans, some scans ahead and on several threads.
/// What comes out, and in which order, does not depend on the number of threads. Memory: that of
/// the scans ahead.
class FeatureStream {
 public:
  /// `threads` ≤ 0: all cores. The reader must outlive the stream.
  FeatureStream(RawlogReader& reader, const PrimitiveParams& params, int threads);

  /// Passes over scans without a look at them, so many or all that are left; odometry on the way
  /// is taken in. To be called before the first `next`.
  void skip(std::size_t scans);

  /// The next scan's features; nothing at the end of the rawlog. Errors of the reader pass through.
  std::optional<FeatureFrame> next();

 private:
  std::optional<Scan> readScan();
  void readAhead();

  RawlogReader& reader_;
  PrimitiveParams params_;
  std::size_t scans_ahead_;
  bool at_end_ = false;
  OdometryTrack odometry_;
  std::deque<std::future<FeatureFrame>> pending_;
};

}  // namespace opp::mapping
