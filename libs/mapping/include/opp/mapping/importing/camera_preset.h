// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace opp::mapping {

/// Pinhole camera of a public data set. A negative fy (ICL-NUIM) means that rows run upward; the
/// importer turns the image over, so that rawlogs have fy > 0.
struct CameraIntrinsics {
  double fx = 0.0;  ///< [px]
  double fy = 0.0;
  double cx = 0.0;
  double cy = 0.0;
};

/// Intrinsics as the data sets' authors publish them for their depth images.
struct CameraPreset {
  std::string_view name;
  CameraIntrinsics intrinsics;
  std::string_view meaning;
};

/// All presets.
const std::vector<CameraPreset>& cameraPresets();

/// A preset's name, or "fx,fy,cx,cy" in pixels.
/// \throws std::invalid_argument that lists the presets if it is neither, or if a number is not
/// finite or a focal length zero.
CameraIntrinsics intrinsicsFromText(std::string_view text);

}  // namespace opp::mapping
