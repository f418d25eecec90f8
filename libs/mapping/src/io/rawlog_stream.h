// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/gz_input.h"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/serialization/CArchive.h>

#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace opp::mapping {

/// One element of a rawlog in any of its formats: exactly one of the two is set.
struct RawlogItem {
  mrpt::obs::CObservation::Ptr observation;
  mrpt::obs::CActionCollection::Ptr action;
};

/// The observations and actions of a rawlog in order, whichever way they are nested.
class RawlogStream {
 public:
  explicit RawlogStream(const std::filesystem::path& file);

  /// Nothing at the end of the file or where it is damaged.
  std::optional<RawlogItem> next();

  double progress() const;
  std::size_t objects() const { return objects_; }
  /// Objects that are neither observation nor action, by class.
  const std::map<std::string, std::size_t>& foreign() const { return foreign_; }
  const std::string& damage() const { return damage_; }

 private:
  bool readObject();
  void unpack(const mrpt::serialization::CSerializable::Ptr& object);
  void reportDamage(const std::string& reason);

  std::filesystem::path file_;
  GzInput input_;
  mrpt::serialization::CArchiveStreamBase<GzInput> archive_;
  std::deque<RawlogItem> items_;
  std::size_t objects_ = 0;
  std::map<std::string, std::size_t> foreign_;
  std::string damage_;
};

}  // namespace opp::mapping
