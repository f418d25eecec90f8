// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/checkpoint/checkpoint_file.h"

#include "opp/mapping/io/atomic_file.h"

#include "checkpoint/checksum_buffer.h"
#include "checkpoint/state_access.h"

#include <cereal/archives/portable_binary.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <ostream>
#include <stdexcept>
#include <string_view>

namespace opp::mapping {

template <typename Archive>
void serialize(Archive& archive, MappingRun& value) {
  auto& [mapper, report, sessions_read, finished] = value;
  archive(mapper, report, sessions_read, finished);
}

namespace {

/// A checkpoint is this, identity and run as cereal stores them, and the CRC-32 of all before.
constexpr std::string_view kMark = "opp-map checkpoint\n";
using Checksum = std::array<char, 4>;

/// Lowest byte first.
Checksum bytesOf(std::uint32_t number) {
  Checksum bytes{};
  for (char& byte : bytes) {
    byte = static_cast<char>(number & 0xFFU);
    number >>= 8U;
  }
  return bytes;
}

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& reason) {
  throw std::runtime_error("cannot resume from " + file.string() + ": " + reason);
}

[[noreturn]] void failDamaged(const std::filesystem::path& file) {
  fail(file, "it is damaged; run without --resume to start from the beginning");
}

/// Stored sizes are trusted by who reads them: no byte may be read before this is true.
bool isIntact(std::istream& stream, std::uintmax_t size) {
  if (size < kMark.size() + sizeof(Checksum)) return false;
  std::array<char, 1 << 16> buffer{};
  std::uintmax_t left = size - sizeof(Checksum);
  uLong checksum = crc32_z(0, nullptr, 0);
  while (left > 0) {
    const auto count = static_cast<std::size_t>(std::min<std::uintmax_t>(left, buffer.size()));
    if (!stream.read(buffer.data(), static_cast<std::streamsize>(count))) return false;
    checksum = crc32_z(checksum, reinterpret_cast<const Bytef*>(buffer.data()), count);
    left -= count;
  }
  Checksum stored{};
  stream.read(stored.data(), stored.size());
  return stream && stored == bytesOf(static_cast<std::uint32_t>(checksum));
}

}  // namespace

void writeCheckpoint(const std::filesystem::path& file, const RunIdentity& identity,
                     const MappingRun& run) {
  writeFileAtomically(file, [&](std::ostream& os) {
    ChecksumBuffer buffer(*os.rdbuf());
    std::ostream summed(&buffer);
    summed << kMark;
    try {
      cereal::PortableBinaryOutputArchive archive(summed);
      archive(identity, run);
    } catch (const cereal::Exception&) {
      os.setstate(std::ios::badbit);  // the disk is full, which writeFileAtomically reports
      return;
    }
    const Checksum checksum = bytesOf(buffer.checksum());
    os.write(checksum.data(), checksum.size());
  });
}

void readCheckpoint(const std::filesystem::path& file, const RunIdentity& identity,
                    MappingRun& run) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail(file, "it cannot be read; is it yours?");
  if (!isIntact(stream, std::filesystem::file_size(file))) failDamaged(file);
  stream.seekg(static_cast<std::streamoff>(kMark.size()));
  try {
    cereal::PortableBinaryInputArchive archive(stream);
    RunIdentity before;
    archive(before);
    if (const auto difference = differenceOf(identity, before)) {
      fail(file,
           *difference + "; call it as before, or without --resume to start from the beginning");
    }
    archive(run);
  } catch (const cereal::Exception&) {
    failDamaged(file);
  }
}

}  // namespace opp::mapping
