// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "importing/dataset_folder.h"

#include <Eigen/SVD>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace opp::mapping {
namespace {

namespace fs = std::filesystem;

/// Published matrices are rounded to some digits; more than this is no rotation.
constexpr double kRotationTolerance = 0.01;
constexpr const char* kDigits = "0123456789";

bool endsWith(const std::string& text, const std::string& suffix) {
  return text.size() >= suffix.size() &&
         text.compare(text.size() - suffix.size(), suffix.size(), suffix) == 0;
}

/// First or last number in a name; −1 if there is none that fits.
long numberIn(const std::string& name, NumberIn which) {
  std::size_t begin = name.find_first_of(kDigits);
  if (which == NumberIn::kLast && begin != std::string::npos) {
    const std::size_t end = name.find_last_of(kDigits);
    begin = name.find_last_not_of(kDigits, end) + 1;
  }
  if (begin == std::string::npos) return -1;
  long number = -1;
  std::from_chars(name.data() + begin, name.data() + name.size(), number);
  return number;
}

}  // namespace

Eigen::Isometry3d opticalFromBody() {
  Eigen::Isometry3d optical_from_body = Eigen::Isometry3d::Identity();
  optical_from_body.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return optical_from_body;
}

std::map<long, fs::path> numberedFiles(const fs::path& folder, const std::string& suffix,
                                       NumberIn which) {
  if (!fs::is_directory(folder)) throw std::runtime_error(folder.string() + ": is no folder");
  std::map<long, fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!endsWith(name, suffix)) continue;
    const long number = numberIn(name.substr(0, name.size() - suffix.size()), which);
    if (number < 0) continue;
    const auto [other, is_new] = files.emplace(number, entry.path());
    if (!is_new) {
      throw std::runtime_error(folder.string() + ": " + name + " and " +
                               other->second.filename().string() + " have the same number");
    }
  }
  if (files.empty()) {
    throw std::runtime_error(folder.string() + ": holds no numbered *" + suffix +
                             " file; is this the folder of the right format?");
  }
  return files;
}

void addNumberedFrames(const std::map<long, fs::path>& files, double default_rate,
                       const ImportOptions& options, ImportPlan& plan) {
  const double rate = options.rate.value_or(default_rate);
  long expected = files.begin()->first;
  for (const auto& [number, file] : files) {
    if (number > expected) {
      const std::string missing =
          file.parent_path().string() + ": number " + std::to_string(expected) +
          (number > expected + 1 ? " to " + std::to_string(number - 1) : "") + " missing before " +
          file.filename().string();
      if (!options.skip_missing) {
        throw std::runtime_error(missing + "; --skip-missing leaves such frames out");
      }
      plan.missing.push_back(missing);
    }
    plan.frames.push_back({options.start_time + static_cast<double>(number) / rate, file});
    expected = number + 1;
  }
}

fs::path subfolderIfAny(const fs::path& folder, const std::string& name) {
  return fs::is_directory(folder / name) ? folder / name : folder;
}

fs::path onlyFile(const fs::path& folder, const std::vector<std::string>& suffixes,
                  const std::string& what) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const auto matches = [&](const std::string& suffix) { return endsWith(name, suffix); };
    if (std::any_of(suffixes.begin(), suffixes.end(), matches)) found.push_back(entry.path());
  }
  if (found.size() > 1) {
    throw std::runtime_error(folder.string() + ": holds " + std::to_string(found.size()) +
                             " files of " + what + "; choose one with --poses");
  }
  return found.empty() ? fs::path() : found.front();
}

std::vector<std::vector<double>> readNumbers(const fs::path& file) {
  std::ifstream stream(file);
  if (!stream || fs::is_directory(file)) {
    throw std::runtime_error(file.string() + ": cannot be opened");
  }
  std::vector<std::vector<double>> lines;
  std::string text;
  for (std::size_t line = 1; std::getline(stream, text); ++line) {
    std::istringstream words(text);
    std::vector<double> numbers;
    for (std::string word; words >> word;) {
      double number = 0.0;
      const char* const begin = word.data() + (word[0] == '+' ? 1 : 0);
      const auto [stop, error] = std::from_chars(begin, word.data() + word.size(), number);
      if (error != std::errc() || stop != word.data() + word.size()) {
        throw std::runtime_error(file.string() + ":" + std::to_string(line) + ": '" + word +
                                 "' is no number");
      }
      numbers.push_back(number);
    }
    if (!numbers.empty()) lines.push_back(std::move(numbers));
  }
  return lines;
}

std::optional<Eigen::Isometry3d> poseFromRows(const std::vector<double>& rows,
                                              const std::string& where) {
  constexpr std::size_t kMinNumbers = 12;  // three rows of four
  if (rows.size() < kMinNumbers) {
    throw std::runtime_error(where + ": a pose needs 12 or 16 numbers, found " +
                             std::to_string(rows.size()));
  }
  Eigen::Matrix<double, 3, 4> matrix;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) matrix(r, c) = rows[static_cast<std::size_t>(4 * r + c)];
  }
  if (!matrix.allFinite()) return std::nullopt;
  const Eigen::Matrix3d rotation = matrix.leftCols<3>();
  const Eigen::Matrix3d deviation = rotation.transpose() * rotation - Eigen::Matrix3d::Identity();
  if (deviation.cwiseAbs().maxCoeff() > kRotationTolerance || rotation.determinant() < 0.0) {
    throw std::runtime_error(where + ": is no rotation");
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(rotation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = svd.matrixU() * svd.matrixV().transpose();
  pose.translation() = matrix.col(3);
  return pose;
}

}  // namespace opp::mapping
