// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <iosfwd>
#include <string>
#include <vector>

namespace opp::mapping {

/// Number of a scene file's line, for messages.
struct SceneLine {
  std::string key;
  std::string value;
  int line = 0;
  mutable bool read = false;
};

/// One section of a scene file; remembers which of its lines were asked for.
class SceneSection {
 public:
  SceneSection(std::string source, std::string kind, int line)
      : source_(std::move(source)), kind_(std::move(kind)), line_(line) {}
  void add(SceneLine line) { lines_.push_back(std::move(line)); }

  const std::string& kind() const { return kind_; }
  bool has(const std::string& key) const;
  /// `count` numbers; \throws std::invalid_argument if the key is missing, given twice or bad.
  std::vector<double> numbers(const std::string& key, std::size_t count) const;
  double number(const std::string& key) const { return numbers(key, 1)[0]; }
  double number(const std::string& key, double otherwise) const;
  Eigen::Vector2d vector2(const std::string& key) const;
  Eigen::Vector3d vector3(const std::string& key) const;
  /// Angle with its unit [rad].
  double angle(const std::string& key, double otherwise) const;
  std::string text(const std::string& key, const std::string& otherwise) const;
  /// Values of a key that may be given many times: numbers, then angles with their units [rad].
  std::vector<std::vector<double>> list(const std::string& key, std::size_t lengths,
                                        std::size_t angles = 0) const;
  /// \throws std::invalid_argument that names a line nobody asked for.
  void requireAllRead() const;
  /// std::invalid_argument with source and line of the section.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  const SceneLine* find(const std::string& key) const;
  double parsedNumber(const SceneLine& line, const std::string& word) const;
  std::vector<double> parsed(const SceneLine& line, std::size_t lengths, std::size_t angles) const;
  [[noreturn]] void fail(int line, const std::string& what) const;

  std::string source_;
  std::string kind_;
  int line_;
  std::vector<SceneLine> lines_;
};

/// Splits a scene file into sections. \throws std::invalid_argument that names source and line.
std::vector<SceneSection> sceneSections(std::istream& text, const std::string& source);

}  // namespace opp::mapping
