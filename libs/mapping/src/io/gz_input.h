// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/io/CStream.h>
#include <zlib.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace opp::mapping {

/// Reading stream over a gzip or plain file that remembers decompression errors: MRPT's own stream
/// cannot tell a damaged file from its end, nor its position in a compressed one.
class GzInput : public mrpt::io::CStream {
 public:
  /// \throws std::runtime_error if the file cannot be opened.
  explicit GzInput(const std::filesystem::path& file);
  ~GzInput() override;
  GzInput(const GzInput&) = delete;
  GzInput& operator=(const GzInput&) = delete;

  size_t Read(void* buffer, size_t count) override;
  size_t Write(const void* buffer, size_t count) override;
  uint64_t Seek(int64_t offset, CStream::TSeekOrigin origin) override;
  uint64_t getTotalBytesCount() const override { return file_size_; }  ///< on disk
  uint64_t getPosition() const override;                               ///< on disk
  uint64_t uncompressedPosition() const;
  /// Empty, or why the last read delivered less than it was asked for although the file goes on.
  const std::string& error() const { return error_; }

 private:
  gzFile file_;
  uint64_t file_size_;
  std::string error_;
};

}  // namespace opp::mapping
