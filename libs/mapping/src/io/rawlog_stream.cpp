// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/rawlog_stream.h"

#include <mrpt/maps/registerAllClasses.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <mutex>

namespace opp::mapping {
namespace {

/// MRPT finds classes of a file by name only if they were registered; linking is not enough where
/// the linker drops libraries without a referenced symbol.
void registerMrptClasses() {
  static std::once_flag once;
  std::call_once(once, [] { mrpt::maps::registerAllClasses_mrpt_maps(); });
}

/// The sentence of an MRPT exception, without file, line and call stack.
std::string messageOf(const std::exception& error) {
  const std::string text = error.what();
  const std::string key = "Message:";
  const std::size_t key_at = text.find(key);
  std::size_t begin = key_at == std::string::npos ? 0 : key_at + key.size();
  begin = std::min(text.find_first_not_of(" \t\n", begin), text.size());
  return text.substr(begin, text.find('\n', begin) - begin);
}

}  // namespace

RawlogStream::RawlogStream(const std::filesystem::path& file)
    : file_(file), input_(file), archive_(input_) {
  registerMrptClasses();
}

std::optional<RawlogItem> RawlogStream::next() {
  while (items_.empty()) {
    if (!damage_.empty() || !readObject()) return std::nullopt;
  }
  const RawlogItem item = items_.front();
  items_.pop_front();
  return item;
}

bool RawlogStream::readObject() {
  const uint64_t object_begin = input_.uncompressedPosition();
  mrpt::serialization::CSerializable::Ptr object;
  try {
    archive_ >> object;
  } catch (const mrpt::serialization::CExceptionEOF&) {
    // MRPT reports any failure within an object's first byte as the end of the file.
    const bool clean = input_.error().empty() && input_.uncompressedPosition() == object_begin;
    if (!clean) reportDamage(input_.error().empty() ? "the data end too early" : input_.error());
    return false;
  } catch (const std::exception& error) {
    reportDamage(input_.error().empty() ? messageOf(error) : input_.error());
    return false;
  }
  ++objects_;
  if (object) unpack(object);
  return true;
}

void RawlogStream::unpack(const mrpt::serialization::CSerializable::Ptr& object) {
  using namespace mrpt::obs;
  if (const auto observation = std::dynamic_pointer_cast<CObservation>(object)) {
    items_.push_back({observation, nullptr});
  } else if (const auto frame = std::dynamic_pointer_cast<CSensoryFrame>(object)) {
    for (const auto& part : *frame) {
      if (part) items_.push_back({part, nullptr});
    }
  } else if (const auto action = std::dynamic_pointer_cast<CActionCollection>(object)) {
    items_.push_back({nullptr, action});
  } else if (const auto rawlog = std::dynamic_pointer_cast<CRawlog>(object)) {
    for (std::size_t i = 0; i < rawlog->size(); ++i) unpack(rawlog->getAsGeneric(i));
  } else {
    ++foreign_[object->GetRuntimeClass()->className];
  }
}

void RawlogStream::reportDamage(const std::string& reason) {
  damage_ = file_.string() + " is damaged after " + std::to_string(objects_) + " objects (byte " +
            std::to_string(input_.getPosition()) + " of " +
            std::to_string(input_.getTotalBytesCount()) + "): " + reason +
            "; what came before was read, fetch the file again for the rest";
}

double RawlogStream::progress() const {
  const uint64_t total = input_.getTotalBytesCount();
  if (total == 0) return 1.0;
  return std::min(1.0, static_cast<double>(input_.getPosition()) / static_cast<double>(total));
}

}  // namespace opp::mapping
