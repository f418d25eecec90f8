// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/atomic_file.h"

#include <unistd.h>

#include <atomic>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>

namespace opp::mapping {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
  throw std::runtime_error("cannot write " + path.string() + ": " + reason);
}

/// A name beside `path` that no other process or thread uses.
fs::path temporaryBeside(const fs::path& path) {
  static std::atomic<unsigned> counter{0};
  const std::string mark = std::to_string(getpid()) + "-" + std::to_string(counter++);
  return path.parent_path() / (".part-" + mark + "-" + path.filename().string());
}

/// Removes the file when it goes; after a rename there is nothing to remove.
struct Remover {
  fs::path path;
  ~Remover() {
    std::error_code ignored;  // no worse than a leftover file
    fs::remove(path, ignored);
  }
};

void writeStream(const fs::path& file, const fs::path& path_for_people,
                 const std::function<void(std::ostream&)>& write) {
  std::ofstream stream(file, std::ios::binary);
  if (!stream) fail(path_for_people, "does its folder exist, and may you write there?");
  write(stream);
  if (!stream.flush()) fail(path_for_people, "is the disk full?");
}

bool isDeviceOrPipe(const fs::path& path) {
  const fs::file_status status = fs::status(path);
  if (fs::is_directory(status)) fail(path, "it is a folder");
  return fs::exists(status) && !fs::is_regular_file(status);
}

}  // namespace

void writeFileAtomically(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  if (isDeviceOrPipe(path)) return writeStream(path, path, write);
  replaceFileAtomically(path,
                        [&](const fs::path& temporary) { writeStream(temporary, path, write); });
}

void replaceFileAtomically(const fs::path& path,
                           const std::function<void(const fs::path&)>& write) {
  if (path.filename().empty()) fail(path, "it names no file");
  if (isDeviceOrPipe(path)) fail(path, "it is no regular file");
  const fs::path target = fs::exists(path) ? fs::canonical(path) : path;
  const Remover temporary{temporaryBeside(target)};
  write(temporary.path);
  std::error_code error;
  fs::rename(temporary.path, target, error);
  if (error) fail(path, error.message());
}

}  // namespace opp::mapping
