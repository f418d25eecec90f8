// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sampling_params.h"
#include "opp/cloud/sensor_model.h"
#include "opp/geometry/point_cloud.h"
#include "opp/primitives/stage_timings.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace opp {

struct GridPatches;

/// Samples of a scan and the patches that they were averaged from.
struct ScanSurface {
  OrientedCloud samples;
  OrientedCloud patches;             ///< with extents; empty if points came with normals
  std::vector<int> sample_of_patch;  ///< index into samples
  /// Of an organized cloud, if the patches are its blocks; for the library's own use.
  std::shared_ptr<const GridPatches> grid = nullptr;
};

/// Turns raw points into evenly spaced surface samples with normals (Sommer et al. 2020, V-b).
///
/// Points outside the sensor's range and points that are not finite are ignored. Given normals are
/// normalized and used as they are (points without a finite, non-zero one are dropped); otherwise
/// planes are fitted in windows that grow until the normal is certain enough for the sensor's noise
/// at that range: in the grid of an organized cloud, among nearest neighbours of an unorganized
/// one. Near an edge the window moves to one side; where no window is flat the surface is dropped,
/// not guessed. All normals are turned to the viewpoint.
///
/// Empty result if nothing is left (no points, a line of points). Deterministic, one thread.
/// O(points) if organized or with normals, else O(points log points). Fills its stages in `timings`
/// unless null.
/// \throws std::invalid_argument if rows·cols or the number of normals does not fit the points, or
/// a parameter is out of range.
ScanSurface makeScanSurface(const PointCloud& cloud, const SensorModel& sensor,
                            const SamplingParams& params, StageTimings* timings = nullptr);

/// The samples of `makeScanSurface`.
OrientedCloud makeOrientedCloud(const PointCloud& cloud, const SensorModel& sensor,
                                const SamplingParams& params, StageTimings* timings = nullptr);

/// Replaces the samples marked in `open` (one entry each) by their patches, which then follow the
/// other samples. Returns where they begin. The surface keeps no patches but
/// those of the grid. O(samples + patches).
std::size_t splitSamples(ScanSurface& surface, const std::vector<std::uint8_t>& open);

}  // namespace opp
