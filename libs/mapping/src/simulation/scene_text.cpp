// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "scene_text.h"

#include "opp/geometry/constants.h"

#include <cmath>
#include <istream>
#include <sstream>
#include <stdexcept>

namespace opp::mapping {
namespace {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

[[noreturn]] void failAt(const std::string& source, int line, const std::string& what) {
  throw std::invalid_argument(source + ":" + std::to_string(line) + ": " + what);
}

}  // namespace

void SceneSection::fail(const std::string& what) const { fail(line_, what); }

void SceneSection::fail(int line, const std::string& what) const {
  failAt(source_, line, "[" + kind_ + "] " + what);
}

const SceneLine* SceneSection::find(const std::string& key) const {
  const SceneLine* found = nullptr;
  for (const SceneLine& line : lines_) {
    if (line.key != key) continue;
    if (found != nullptr) fail(line.line, "'" + key + "' is given twice");
    found = &line;
  }
  if (found != nullptr) found->read = true;
  return found;
}

bool SceneSection::has(const std::string& key) const {
  for (const SceneLine& line : lines_) {
    if (line.key == key) return true;
  }
  return false;
}

double SceneSection::parsedNumber(const SceneLine& line, const std::string& word) const {
  std::size_t used = 0;
  double value = 0.0;
  try {
    value = std::stod(word, &used);
  } catch (const std::logic_error&) {
    used = 0;
  }
  if (used != word.size() || !std::isfinite(value)) {
    fail(line.line, "'" + line.key + "': '" + word + "' is not a number");
  }
  return value;
}

std::vector<double> SceneSection::parsed(const SceneLine& line, std::size_t lengths,
                                         std::size_t angles) const {
  std::vector<double> result;
  std::istringstream words(line.value);
  for (std::string word; words >> word;) {
    result.push_back(parsedNumber(line, word));
    if (result.size() <= lengths) continue;
    std::string unit;
    words >> unit;
    if (unit != "deg" && unit != "rad") {
      fail(line.line, "'" + line.key + "': the angle " + word + " needs 'deg' or 'rad'");
    }
    if (unit == "deg") result.back() = degToRad(result.back());
  }
  if (result.size() != lengths + angles) {
    fail(line.line, "'" + line.key + "' needs " + std::to_string(lengths + angles) +
                        " numbers, has " + std::to_string(result.size()));
  }
  return result;
}

std::vector<double> SceneSection::numbers(const std::string& key, std::size_t count) const {
  const SceneLine* line = find(key);
  if (line == nullptr) fail("'" + key + "' is missing");
  return parsed(*line, count, 0);
}

double SceneSection::number(const std::string& key, double otherwise) const {
  return has(key) ? number(key) : otherwise;
}

Eigen::Vector2d SceneSection::vector2(const std::string& key) const {
  const auto values = numbers(key, 2);
  return {values[0], values[1]};
}

Eigen::Vector3d SceneSection::vector3(const std::string& key) const {
  const auto values = numbers(key, 3);
  return {values[0], values[1], values[2]};
}

double SceneSection::angle(const std::string& key, double otherwise) const {
  const SceneLine* line = find(key);
  return line == nullptr ? otherwise : parsed(*line, 0, 1)[0];
}

std::string SceneSection::text(const std::string& key, const std::string& otherwise) const {
  const SceneLine* line = find(key);
  return line == nullptr ? otherwise : line->value;
}

std::vector<std::vector<double>> SceneSection::list(const std::string& key, std::size_t lengths,
                                                    std::size_t angles) const {
  std::vector<std::vector<double>> result;
  for (const SceneLine& line : lines_) {
    if (line.key != key) continue;
    line.read = true;
    result.push_back(parsed(line, lengths, angles));
  }
  return result;
}

void SceneSection::requireAllRead() const {
  for (const SceneLine& line : lines_) {
    if (!line.read) fail(line.line, "unknown key '" + line.key + "'");
  }
}

std::vector<SceneSection> sceneSections(std::istream& text, const std::string& source) {
  std::vector<SceneSection> result;
  int number = 0;
  for (std::string raw; std::getline(text, raw);) {
    ++number;
    const std::string line = trimmed(raw.substr(0, raw.find('#')));
    if (line.empty()) continue;
    if (line.front() == '[') {
      if (line.back() != ']') failAt(source, number, "section header without ']'");
      std::istringstream header(line.substr(1, line.size() - 2));
      std::string kind;
      header >> kind;  // the rest is a name for people
      result.emplace_back(source, kind, number);
      continue;
    }
    const auto equals = line.find('=');
    if (equals == std::string::npos) failAt(source, number, "neither [section] nor key = value");
    if (result.empty()) failAt(source, number, "a key before the first [section]");
    result.back().add({trimmed(line.substr(0, equals)), trimmed(line.substr(equals + 1)), number});
  }
  return result;
}

}  // namespace opp::mapping
