// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <zlib.h>

#include <cstdint>
#include <streambuf>

namespace opp::mapping {

/// Passes all that is written on to another buffer, and sums it up.
class ChecksumBuffer : public std::streambuf {
 public:
  explicit ChecksumBuffer(std::streambuf& target) : target_(target) {}

  /// CRC-32 of all bytes so far.
  std::uint32_t checksum() const { return static_cast<std::uint32_t>(checksum_); }

 protected:
  std::streamsize xsputn(const char* bytes, std::streamsize count) override {
    if (count == 0) return 0;  // of no bytes, `bytes` may be null, with which zlib starts anew
    checksum_ =
        crc32_z(checksum_, reinterpret_cast<const Bytef*>(bytes), static_cast<z_size_t>(count));
    return target_.sputn(bytes, count);
  }
  int_type overflow(int_type letter) override {
    if (traits_type::eq_int_type(letter, traits_type::eof())) return traits_type::not_eof(letter);
    const char byte = traits_type::to_char_type(letter);
    return xsputn(&byte, 1) == 1 ? letter : traits_type::eof();
  }

 private:
  std::streambuf& target_;
  uLong checksum_ = crc32_z(0, nullptr, 0);
};

}  // namespace opp::mapping
