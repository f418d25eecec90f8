// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/importing/camera_preset.h"

#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace opp::mapping {

const std::vector<CameraPreset>& cameraPresets() {
  static const std::vector<CameraPreset> presets{
      {"tum-default", {525.0, 525.0, 319.5, 239.5}, "TUM RGB-D, nominal (ROS default)"},
      {"tum-fr1", {517.3, 516.5, 318.6, 255.3}, "TUM RGB-D, freiburg1"},
      {"tum-fr2", {520.9, 521.0, 325.1, 249.7}, "TUM RGB-D, freiburg2"},
      {"tum-fr3", {535.4, 539.2, 320.1, 247.6}, "TUM RGB-D, freiburg3"},
      {"icl-nuim", {481.2, -480.0, 319.5, 239.5}, "ICL-NUIM; fy is negative"},
      {"7scenes", {585.0, 585.0, 320.0, 240.0}, "7-Scenes"},
      {"redwood", {525.0, 525.0, 319.5, 239.5}, "Redwood"}};
  return presets;
}

CameraIntrinsics intrinsicsFromText(std::string_view text) {
  std::string names;
  for (const CameraPreset& preset : cameraPresets()) {
    if (preset.name == text) return preset.intrinsics;
    names += std::string(names.empty() ? "" : ", ") + std::string(preset.name);
  }
  std::array<double, 4> numbers{};
  const char* position = text.data();
  const char* const end = text.data() + text.size();
  bool valid = true;
  for (std::size_t k = 0; k < numbers.size() && valid; ++k) {
    const auto [stop, error] = std::from_chars(position, end, numbers[k]);
    const bool is_last = k + 1 == numbers.size();
    valid = error == std::errc() && std::isfinite(numbers[k]) &&
            (is_last ? stop == end : stop != end && *stop == ',');
    if (valid && !is_last) position = stop + 1;
  }
  if (!valid || numbers[0] == 0.0 || numbers[1] == 0.0) {
    throw std::invalid_argument("'" + std::string(text) +
                                "' is neither fx,fy,cx,cy in pixels nor one of " + names);
  }
  return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

}  // namespace opp::mapping
