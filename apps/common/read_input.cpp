// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "common/read_input.h"

#include "opp/mapping/io/cloud_file.h"
#include "opp/mapping/io/rawlog_reader.h"

#include <optional>
#include <stdexcept>
#include <string>

namespace opp::apps {

bool isRawlog(const std::filesystem::path& path) { return path.extension() == ".rawlog"; }

void openRange(SensorModel& sensor) {
  constexpr double kFarthest = 1000.0;  // the largest value that the parameter allows
  sensor.min_range = 0.0;
  sensor.max_range = kFarthest;
}

mapping::Scan readInput(const std::filesystem::path& path, int index) {
  mapping::Scan scan;
  if (!isRawlog(path)) {
    scan.cloud_in_body = mapping::readCloudFile(path);
    return scan;
  }
  mapping::RawlogOptions options;
  options.from_index = static_cast<std::size_t>(index);
  options.to_index = options.from_index + 1;
  mapping::RawlogReader reader(path, options);
  std::optional<mapping::Scan> found = reader.nextScan();
  if (!found) {
    throw std::runtime_error(path.string() + ": has no 3D observation " + std::to_string(index) +
                             "; they are counted from 0");
  }
  return *std::move(found);
}

}  // namespace opp::apps
