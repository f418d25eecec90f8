// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/tum_trajectory.h"

#include "opp/mapping/io/atomic_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <istream>
#include <stdexcept>

namespace opp::mapping {
namespace {

/// |q| may be off one by this; more is not rounding but a wrong column.
constexpr double kNormTolerance = 0.01;
constexpr std::size_t kColumns = 8;
constexpr int kTimeDecimals = 6;
constexpr int kSignificantDigits = 9;

using Row = std::array<double, kColumns>;

struct NumberedRow {
  Row row{};
  std::size_t line = 0;
};

[[noreturn]] void fail(const std::string& name, std::size_t line, const std::string& what) {
  throw std::runtime_error(name + ":" + std::to_string(line) + ": " + what);
}

std::vector<std::string> wordsOf(const std::string& text) {
  const std::string blanks = " \t\r";
  std::vector<std::string> words;
  std::size_t begin = text.find_first_not_of(blanks);
  while (begin != std::string::npos) {
    const std::size_t end = text.find_first_of(blanks, begin);
    words.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(blanks, end);
  }
  return words;
}

Row parseRow(const std::vector<std::string>& words, const std::string& name, std::size_t line) {
  if (words.size() != kColumns) {
    fail(name, line,
         "expected 8 numbers, 'timestamp tx ty tz qx qy qz qw', found " +
             std::to_string(words.size()));
  }
  Row row{};
  for (std::size_t k = 0; k < kColumns; ++k) {
    const char* const end = words[k].data() + words[k].size();
    const auto [stop, error] = std::from_chars(words[k].data(), end, row[k]);
    if (error != std::errc() || stop != end) fail(name, line, "'" + words[k] + "' is no number");
    if (!std::isfinite(row[k])) fail(name, line, "'" + words[k] + "' is not finite");
  }
  const double norm = Eigen::Vector4d(row[4], row[5], row[6], row[7]).norm();
  if (std::abs(norm - 1.0) > kNormTolerance) {
    fail(name, line, "quaternion of length " + std::to_string(norm) + ", expected 1");
  }
  return row;
}

StampedPose poseOf(const Row& row) {
  StampedPose pose;
  pose.timestamp = row[0];
  pose.map_from_body.translation() = Eigen::Vector3d(row[1], row[2], row[3]);
  pose.map_from_body.linear() =
      Eigen::Quaterniond(row[7], row[4], row[5], row[6]).normalized().toRotationMatrix();
  return pose;
}

void append(std::string& text, double value, std::chars_format format, int precision) {
  std::array<char, 512> buffer{};  // a fixed-format double has at most 309 + 1 + 6 characters
  const double positive_zero = value + 0.0;
  const auto [end, error] =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), positive_zero, format, precision);
  if (error != std::errc()) throw std::logic_error("formatTumTrajectory: buffer too small");
  text.append(buffer.data(), end);
}

}  // namespace

Trajectory readTumTrajectory(std::istream& stream, const std::string& name) {
  std::vector<NumberedRow> rows;
  std::string text;
  for (std::size_t line = 1; std::getline(stream, text); ++line) {
    const std::vector<std::string> words = wordsOf(text.substr(0, text.find('#')));
    if (!words.empty()) rows.push_back({parseRow(words, name, line), line});
  }
  if (stream.bad()) throw std::runtime_error(name + ": cannot be read to its end");
  std::stable_sort(rows.begin(), rows.end(),
                   [](const auto& a, const auto& b) { return a.row[0] < b.row[0]; });
  Trajectory trajectory;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (k > 0 && rows[k].row[0] == rows[k - 1].row[0]) {
      if (rows[k].row == rows[k - 1].row) continue;
      fail(name, rows[k].line,
           "another pose for the moment of line " + std::to_string(rows[k - 1].line) +
               "; keep one of the two");
    }
    trajectory.push_back(poseOf(rows[k].row));
  }
  return trajectory;
}

Trajectory readTumTrajectory(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file || std::filesystem::is_directory(path)) {
    throw std::runtime_error(path.string() + ": cannot be opened as a trajectory file");
  }
  return readTumTrajectory(file, path.string());
}

std::string formatTumTrajectory(const Trajectory& trajectory) {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (const StampedPose& pose : trajectory) {
    const Eigen::Vector3d& t = pose.map_from_body.translation();
    Eigen::Quaterniond q(pose.map_from_body.linear());
    if (!std::isfinite(pose.timestamp) || !t.allFinite() || !q.coeffs().allFinite()) {
      throw std::invalid_argument("formatTumTrajectory: a pose or a time is not finite");
    }
    q.normalize();
    if (q.w() < 0.0) q.coeffs() = -q.coeffs();
    append(text, pose.timestamp, std::chars_format::fixed, kTimeDecimals);
    for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
      text += ' ';
      append(text, value, std::chars_format::general, kSignificantDigits);
    }
    text += '\n';
  }
  return text;
}

void writeTumTrajectory(const std::filesystem::path& path, const Trajectory& trajectory) {
  const std::string text = formatTumTrajectory(trajectory);
  writeFileAtomically(path, [&](std::ostream& stream) { stream << text; });
}

}  // namespace opp::mapping
