// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace opp::test {

/// A new, empty folder that is removed with all it holds when the object goes.
class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(std::string_view name) const { return path_ / name; }
  /// Paths of everything inside, at any depth and hidden or not, relative to path(), in ascending
  /// order.
  std::vector<std::string> contents() const;

 private:
  std::filesystem::path path_;
};

/// The bytes of a file. \throws std::runtime_error if it cannot be read.
std::string readFile(const std::filesystem::path& path);

/// Makes a file of these bytes. \throws std::runtime_error if that fails.
void writeFile(const std::filesystem::path& path, std::string_view bytes);

}  // namespace opp::test
