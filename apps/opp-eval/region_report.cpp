// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp-eval/region_report.h"

#include "opp/mapping/evaluation/labels_at_points.h"
#include "opp/mapping/io/cloud_file.h"

#include <algorithm>
#include <iomanip>
#include <ostream>
#include <sstream>
#include <stdexcept>

namespace opp::mapping {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFirstRegionOfPcd = 10;

}  // namespace

RegionMetrics compareLabels(const std::filesystem::path& gt, const std::filesystem::path& est,
                            std::optional<int> first_region) {
  LabeledCloud truth = readLabeledCloudFile(gt);
  const LabeledCloud estimate = readLabeledCloudFile(est);
  std::vector<int> est_labels =
      labelsAtPoints(truth.cloud.points, estimate.cloud.points, estimate.labels);
  // Points without a measurement belong to nothing on either side.
  for (std::size_t k = 0; k < truth.labels.size(); ++k) {
    if (!truth.cloud.points[k].allFinite()) truth.labels[k] = est_labels[k] = -1;
  }
  if (std::all_of(est_labels.begin(), est_labels.end(), [](int label) { return label < 0; }) &&
      std::any_of(estimate.labels.begin(), estimate.labels.end(),
                  [](int label) { return label >= 0; })) {
    throw std::runtime_error("nothing to compare: no labelled point of " + est.string() +
                             " is a point of " + gt.string());
  }
  const int first = first_region.value_or(gt.extension() == ".pcd" ? kFirstRegionOfPcd : 0);
  RegionMetrics metrics = regionMetrics(truth.labels, est_labels, first);
  if (metrics.gt_regions == 0) {
    throw std::runtime_error("nothing to compare: " + gt.string() + " has no label from " +
                             std::to_string(first) + " on; see --first-region");
  }
  return metrics;
}

Json toJson(const RegionMetrics& metrics) {
  Json thresholds = Json::array();
  for (const RegionCounts& c : metrics.counts) {
    thresholds.push_back({{"percent", c.threshold_percent},
                          {"correct", c.correct},
                          {"over_segmented", c.over_segmented},
                          {"under_segmented", c.under_segmented},
                          {"missed", c.missed},
                          {"noise", c.noise}});
  }
  return {{"points", metrics.points},
          {"gt_regions", metrics.gt_regions},
          {"est_regions", metrics.est_regions},
          {"mean_correct", metrics.mean_correct},
          {"thresholds", thresholds}};
}

void print(std::ostream& out, const RegionMetrics& metrics) {
  std::ostringstream table;
  table << "Regions: " << metrics.gt_regions << " true, " << metrics.est_regions
        << " estimated, on " << metrics.points
        << " points; correct on average over 51 to 95 %: " << std::fixed << std::setprecision(1)
        << 100.0 * metrics.mean_correct << " %\n"
        << "overlap   correct      over     under    missed     noise\n";
  for (const RegionCounts& c : metrics.counts) {
    table << std::setw(5) << c.threshold_percent << " %";
    for (const int count : {c.correct, c.over_segmented, c.under_segmented, c.missed, c.noise}) {
      table << std::setw(10) << count;
    }
    table << '\n';
  }
  out << table.str();
}

}  // namespace opp::mapping
