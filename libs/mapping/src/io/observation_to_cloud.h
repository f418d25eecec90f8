// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/point_cloud.h"

#include "io/pixel_rays.h"

#include <mrpt/obs/CObservation.h>

#include <filesystem>
#include <optional>
#include <string>

namespace opp::mapping {

/// What happens to images outside of the rawlog once they have been used.
enum class ImagesAfterwards { kFree, kKeep };

/// Turns 3D observations of MRPT into clouds in the body frame.
class ObservationConverter {
 public:
  /// `images_directory`: where observations with outside images look for them.
  explicit ObservationConverter(std::filesystem::path images_directory)
      : images_directory_(std::move(images_directory)) {}

  /// Whether observations of this kind are 3D observations, with or without contents.
  static bool isScan(const mrpt::obs::CObservation& observation);

  /// The cloud of a 3D observation. \throws std::runtime_error: the
  /// observation holds no usable measurement; the message says why, without naming the file.
  PointCloud convert(mrpt::obs::CObservation& observation,
                     ImagesAfterwards images = ImagesAfterwards::kFree);

 private:
  std::filesystem::path images_directory_;
  PixelRayCache rays_;
};

}  // namespace opp::mapping
