// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/scan_selection.h"

#include <stdexcept>
#include <string>

namespace opp::mapping {
namespace {

std::regex labelPattern(const std::string& expression) {
  try {
    return std::regex(expression);
  } catch (const std::regex_error& error) {
    throw std::invalid_argument("sensor label '" + expression +
                                "' is not a regular expression: " + error.what());
  }
}

}  // namespace

ScanSelection::ScanSelection(const RawlogOptions& options)
    : options_(options), label_(labelPattern(options.sensor_label)) {
  if (options.every == 0) throw std::invalid_argument("every = 0; it must be at least 1");
  if (options.from_index >= options.to_index) {
    throw std::invalid_argument("from-index " + std::to_string(options.from_index) +
                                " must be below to-index " + std::to_string(options.to_index));
  }
}

std::optional<std::size_t> ScanSelection::take(const mrpt::obs::CObservation& scan,
                                               RawlogCounts& counts) {
  ++counts.labels[scan.sensorLabel];
  const bool has_label =
      options_.sensor_label.empty() || std::regex_match(scan.sensorLabel, label_);
  const std::size_t index = next_index_;
  if (has_label) ++next_index_;
  const bool wanted = has_label && index >= options_.from_index && index < options_.to_index &&
                      (index - options_.from_index) % options_.every == 0;
  if (wanted) return index;
  ++counts.deselected;
  return std::nullopt;
}

}  // namespace opp::mapping
