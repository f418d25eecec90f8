// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/pipeline/feature_stream.h"

#include "opp/parallel/parallel_for.h"

#include <utility>

namespace opp::mapping {
namespace {

FeatureFrame computeFeatures(const Scan& scan,
                             const std::optional<Eigen::Isometry3d>& odom_from_body,
                             const PrimitiveParams& params) {
  FeatureFrame frame;
  frame.odom_from_body = odom_from_body;
  // One thread per scan: the scans themselves run side by side.
  frame.features = detectFeatures(scan.cloud_in_body, params, 1);
  frame.features.timestamp = scan.timestamp;
  frame.features.scan_index = scan.index;
  return frame;
}

}  // namespace

FeatureStream::FeatureStream(RawlogReader& reader, const PrimitiveParams& params, int threads)
    : reader_(reader),
      params_(params),
      scans_ahead_(static_cast<std::size_t>(resolveThreads(threads))) {}

void FeatureStream::skip(std::size_t scans) {
  while (scans > 0 && readScan()) --scans;
}

std::optional<Scan> FeatureStream::readScan() {
  while (std::optional<RawlogEntry> entry = reader_.next()) {
    if (auto* scan = std::get_if<Scan>(&*entry)) return std::move(*scan);
    const auto& reading = std::get<OdometryReading>(*entry);
    odometry_.add(reading.timestamp, reading.odom_from_body);
  }
  at_end_ = true;
  return std::nullopt;
}

void FeatureStream::readAhead() {
  while (!at_end_ && pending_.size() < scans_ahead_) {
    std::optional<Scan> scan = readScan();
    if (!scan) return;
    const auto odom_from_body = odometry_.at(scan->timestamp);
    // With one thread in all, the work is done when its result is asked for, on the caller's
    // thread.
    const auto policy = scans_ahead_ > 1 ? std::launch::async : std::launch::deferred;
    pending_.push_back(std::async(policy, [scan = std::move(*scan), odom_from_body, this] {
      return computeFeatures(scan, odom_from_body, params_);
    }));
  }
}

std::optional<FeatureFrame> FeatureStream::next() {
  readAhead();
  if (pending_.empty()) return std::nullopt;
  FeatureFrame frame = pending_.front().get();
  pending_.pop_front();
  readAhead();
  return frame;
}

}  // namespace opp::mapping
