// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/pipeline/build_occupancy_map.h"

#include "opp/parallel/parallel_for.h"

#include <utility>

namespace opp::mapping {
namespace {

/// Scans that are ray-cast side by side, per thread: enough to keep all busy, few enough for
/// memory.
constexpr std::size_t kScansPerThread = 4;

OccupancyScan returnsInMap(const PointCloud& cloud_in_body, const Eigen::Isometry3d& map_from_body,
                           const SensorModel& range_limits) {
  const auto min_range = static_cast<float>(range_limits.min_range);
  const auto max_range = static_cast<float>(range_limits.max_range);
  std::vector<Eigen::Vector3f> returns;
  returns.reserve(cloud_in_body.size());
  for (const Eigen::Vector3f& point : cloud_in_body.points) {
    const float range = (point - cloud_in_body.viewpoint).norm();
    if (range >= min_range && range <= max_range) returns.push_back(point);
  }
  return occupancyScan(returns, cloud_in_body.viewpoint, map_from_body);
}

}  // namespace

void insertRawlog(const std::filesystem::path& rawlog, const RawlogOptions& selection,
                  const std::map<std::size_t, Eigen::Isometry3d>& map_from_body,
                  const SensorModel& range_limits, int threads,
                  const std::function<void(double, std::size_t)>& progress, OccupancyMap& map) {
  RawlogReader reader(rawlog, selection);
  const std::size_t batch_size =
      kScansPerThread * static_cast<std::size_t>(resolveThreads(threads));
  std::vector<OccupancyScan> batch;
  std::size_t count = 0;
  while (const std::optional<Scan> scan = reader.nextScan()) {
    const auto pose = map_from_body.find(scan->index);
    if (pose == map_from_body.end()) continue;
    batch.push_back(returnsInMap(scan->cloud_in_body, pose->second, range_limits));
    if (batch.size() >= batch_size) {
      map.insertScans(batch, threads);
      batch.clear();
    }
    if (progress) progress(reader.progress(), ++count);
  }
  map.insertScans(batch, threads);
}

}  // namespace opp::mapping
