// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/frontend/build_local_map.h"
#include "opp/mapping/pipeline/mapper.h"

#include "checkpoint/archive_map.h"

#include <cereal/types/optional.hpp>

#include <optional>

namespace opp::mapping {

/// Stores the state of classes that keep it to themselves, of which it is a friend. Left out are
/// parameters, which whoever resumes gives anew, and what follows from the rest to the bit.
struct StateAccess {
  template <typename Archive>
  static void serialize(Archive& archive, MotionModel& motion) {
    auto& [anchor_time, anchor_odometry, anchor_covariance] = motion.anchor_;
    archive(motion.started_, motion.timestamp_, motion.last_, motion.last_odom_from_body_);
    archive(anchor_time, anchor_odometry, anchor_covariance, motion.squared_unrest_);
  }

  /// But for the local map.
  template <typename Archive>
  static void serialize(Archive& archive, Tracker& tracker) {
    serialize(archive, tracker.motion_);
    archive(tracker.last_scan_, tracker.intervals_, tracker.lost_, tracker.follows_,
            tracker.surprised_);
  }

  template <typename Archive>
  static void serialize(Archive& archive, LoopCloser& closer) {
    archive(closer.claims_.claims_);
  }

  template <typename Archive>
  static void serialize(Archive& archive, Mapper& mapper) {
    archive(mapper.initial_pose_, mapper.local_, mapper.continues_, mapper.lost_in_a_row_,
            mapper.next_part_);
    serialize(archive, mapper.tracker_);
    serialize(archive, mapper.loop_closer_);
    serialize(archive, mapper.passages_);
    serializeParts(archive, mapper);
    if constexpr (Archive::is_loading::value) {
      if (mapper.local_.empty()) return;
      mapper.tracker_.setLocalMap(localMapOf(mapper.active(), mapper.local_, mapper.params_));
    }
  }

 private:
  template <typename Archive>
  static void serialize(Archive& archive, OpenPassage::Leg& leg) {
    archive(leg.keyframe, leg.timestamp, leg.tied, leg.begins, leg.scans);
  }

  template <typename Archive>
  static void serialize(Archive& archive, OpenPassage::LaterPose& later) {
    archive(later.pose, later.information);
  }

  template <typename Archive, typename T>
  static void serializeAll(Archive& archive, std::vector<T>& values) {
    std::size_t count = values.size();
    archive(count);
    values.resize(count);
    for (T& value : values) serialize(archive, value);
  }

  template <typename Archive>
  static void serialize(Archive& archive, PassageWatch& watch) {
    bool is_passed = watch.passage_.has_value();
    archive(watch.begins_, watch.is_known_, watch.open_, is_passed);
    serialize(archive, watch.since_keyframe_);
    if (!is_passed) return;
    if constexpr (Archive::is_loading::value) watch.passage_.emplace();
    serializeAll(archive, watch.passage_->legs_);
    serializeAll(archive, watch.passage_->later_);
  }

  template <typename Archive>
  static void serializeParts(Archive& archive, Mapper& mapper) {
    std::size_t count = mapper.parts_.size();
    archive(count);
    for (std::size_t p = 0; p < count; ++p) {
      if constexpr (Archive::is_loading::value) mapper.parts_.emplace_back(0, mapper.params_.loop);
      MapPart& part = mapper.parts_[p];
      archive(part.id, part.history, part.map);
      if constexpr (Archive::is_loading::value) part.indexFrom(0);
    }
  }
};

template <typename Archive>
void serialize(Archive& archive, Mapper& mapper) {
  StateAccess::serialize(archive, mapper);
}

}  // namespace opp::mapping
