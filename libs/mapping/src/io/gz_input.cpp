// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/gz_input.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace opp::mapping {

GzInput::GzInput(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) {
    throw std::runtime_error(file.string() + " does not exist; check the path");
  }
  if (!std::filesystem::is_regular_file(file)) {
    throw std::runtime_error(file.string() + " is not a file; give the path of a .rawlog file");
  }
  file_size_ = std::filesystem::file_size(file);
  // zlib's default buffer stays: with a bigger one all objects of a damaged block are lost.
  file_ = gzopen(file.c_str(), "rb");
  if (file_ == nullptr) {
    throw std::runtime_error(file.string() + " cannot be opened: " + std::strerror(errno));
  }
}

GzInput::~GzInput() { gzclose(file_); }

size_t GzInput::Read(void* buffer, size_t count) {
  const int result = gzread(file_, buffer, static_cast<unsigned>(count));
  const auto bytes = static_cast<size_t>(result < 0 ? 0 : result);
  if (bytes == count) return bytes;
  int code = Z_OK;
  const char* text = gzerror(file_, &code);
  if (code != Z_OK && code != Z_STREAM_END) {
    error_ = code == Z_BUF_ERROR ? "the compressed data end too early" : text;
  } else if (bytes > 0) {
    error_ = "the data end too early";
  }
  if (!error_.empty()) throw std::runtime_error(error_);
  return bytes;
}

size_t GzInput::Write(const void*, size_t) { throw std::logic_error("GzInput only reads"); }

uint64_t GzInput::Seek(int64_t, CStream::TSeekOrigin) {
  throw std::logic_error("GzInput only reads forward");
}

uint64_t GzInput::getPosition() const { return static_cast<uint64_t>(gzoffset(file_)); }

uint64_t GzInput::uncompressedPosition() const { return static_cast<uint64_t>(gztell(file_)); }

}  // namespace opp::mapping
