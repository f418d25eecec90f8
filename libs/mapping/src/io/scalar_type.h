// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace opp::mapping {

/// How a number is stored in a binary file.
struct ScalarType {
  enum class Kind { kSigned, kUnsigned, kFloat };
  Kind kind = Kind::kFloat;
  std::size_t bytes = 4;  ///< 1, 2, 4 or 8; floats 4 or 8
};

/// Value of the number at `bytes`. 64-bit integers above 2^53 are rounded.
inline double decodeScalar(const char* bytes, ScalarType type, bool big_endian) {
  std::uint64_t bits = 0;
  for (std::size_t k = 0; k < type.bytes; ++k) {
    const std::size_t at = big_endian ? k : type.bytes - 1 - k;
    bits = bits << 8 | static_cast<unsigned char>(bytes[at]);
  }
  if (type.kind == ScalarType::Kind::kFloat) {
    if (type.bytes == 8) {
      double value = 0.0;
      std::memcpy(&value, &bits, sizeof value);
      return value;
    }
    const auto low = static_cast<std::uint32_t>(bits);
    float value = 0.0F;
    std::memcpy(&value, &low, sizeof value);
    return static_cast<double>(value);
  }
  if (type.kind == ScalarType::Kind::kUnsigned) return static_cast<double>(bits);
  const std::size_t unused = 64 - 8 * type.bytes;
  return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
}

}  // namespace opp::mapping
