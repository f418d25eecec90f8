// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp-register/read_pose.h"

#include "opp/mapping/core/se3.h"

#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace opp::apps {
namespace {

/// How far from orthonormal a matrix may be that was written with few digits.
constexpr double kTolerance = 1e-3;

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
  throw std::runtime_error(path.string() + what +
                           "; a pose is the 16 numbers of a 4x4 matrix, row by row");
}

double parse(const std::string& word, const std::filesystem::path& path, int line) {
  double value = 0.0;
  const char* end = word.data() + word.size();
  const char* start = word.data() + (word.front() == '+' ? 1 : 0);
  const auto [stop, error] = std::from_chars(start, end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) {
    fail(path, ":" + std::to_string(line) + ": '" + word + "' is not a finite number");
  }
  return value;
}

}  // namespace

Eigen::Isometry3d readPose(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  Eigen::Matrix<double, 4, 4, Eigen::RowMajor> matrix;
  int count = 0, number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    std::istringstream words(line.substr(0, line.find('#')));
    for (std::string word; words >> word; ++count) {
      const double value = parse(word, path, number);
      if (count == 16) fail(path, ":" + std::to_string(number) + ": more than 16 numbers");
      matrix.data()[count] = value;
    }
  }
  if (count != 16) fail(path, ": holds " + std::to_string(count) + " numbers");
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  const bool rigid = (rotation * rotation.transpose()).isIdentity(kTolerance) &&
                     rotation.determinant() > 0.0 &&
                     (matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).norm() < kTolerance;
  if (!rigid) fail(path, ": is not a rotation with a translation");
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation;
  pose.translation() = matrix.topRightCorner<3, 1>();
  return mapping::normalized(pose);
}

}  // namespace opp::apps
