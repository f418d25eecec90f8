// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/evaluation/region_metrics.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

namespace opp::mapping {
namespace {

/// Regions of one segmentation, numbered from 0 in ascending order of their labels.
using Regions = std::map<int, int>;  ///< label → number
/// Part of a region that lies in another one.
struct Part {
  int region = 0;  ///< number of the other region
  long overlap = 0;
};

/// Sizes and overlaps of the regions of both segmentations.
struct Overlaps {
  std::vector<long> gt_sizes;
  std::vector<long> est_sizes;
  std::vector<std::vector<Part>> est_of_gt;  ///< estimated regions that overlap each true one
  std::vector<std::vector<Part>> gt_of_est;  ///< and the other way round
  long points = 0;
};

enum class Relation { kCorrect, kOverSegmented, kUnderSegmented };

/// A relation that holds between some regions.
struct Instance {
  double quality = 0.0;  ///< mean of the two shares
  Relation relation = Relation::kCorrect;
  std::vector<int> gt;
  std::vector<int> est;
};

void number(Regions& regions) {
  int next = 0;
  for (auto& [label, region] : regions) region = next++;
}

Overlaps countOverlaps(const std::vector<int>& gt_labels, const std::vector<int>& est_labels,
                       int first_region) {
  Overlaps result;
  std::map<std::pair<int, int>, long> points_of;
  Regions gt_regions, est_regions;
  for (std::size_t k = 0; k < gt_labels.size(); ++k) {
    if (gt_labels[k] >= 0 && gt_labels[k] < first_region) continue;
    ++result.points;
    ++points_of[{gt_labels[k], est_labels[k]}];
    if (gt_labels[k] >= 0) gt_regions.emplace(gt_labels[k], 0);
    if (est_labels[k] >= 0) est_regions.emplace(est_labels[k], 0);
  }
  number(gt_regions);
  number(est_regions);
  result.gt_sizes.resize(gt_regions.size());
  result.est_sizes.resize(est_regions.size());
  result.est_of_gt.resize(gt_regions.size());
  result.gt_of_est.resize(est_regions.size());
  for (const auto& [labels, count] : points_of) {
    const auto gt = gt_regions.find(labels.first);
    const auto est = est_regions.find(labels.second);
    const bool in_gt = gt != gt_regions.end();
    const bool in_est = est != est_regions.end();
    if (in_gt) result.gt_sizes[static_cast<std::size_t>(gt->second)] += count;
    if (in_est) result.est_sizes[static_cast<std::size_t>(est->second)] += count;
    if (!in_gt || !in_est) continue;
    result.est_of_gt[static_cast<std::size_t>(gt->second)].push_back({est->second, count});
    result.gt_of_est[static_cast<std::size_t>(est->second)].push_back({gt->second, count});
  }
  return result;
}

/// part ≥ percent/100 of whole, in integers.
bool isShare(long part, long whole, int percent) { return 100 * part >= percent * whole; }

double meanShare(long overlap, long a, long b) {
  const auto o = static_cast<double>(overlap);
  return (o / static_cast<double>(a) + o / static_cast<double>(b)) / 2.0;
}

/// The regions that lie in a region of `size` points by at least the threshold, if there are two or
/// more and together they make up at least the threshold of it. `split` is the region's number.
void addSplit(int split, long size, const std::vector<Part>& parts,
              const std::vector<long>& part_sizes, int percent, Relation relation,
              std::vector<Instance>& instances) {
  std::vector<int> members;
  long overlap = 0;
  long members_size = 0;
  for (const Part& part : parts) {
    const long part_size = part_sizes[static_cast<std::size_t>(part.region)];
    if (!isShare(part.overlap, part_size, percent)) continue;
    members.push_back(part.region);
    overlap += part.overlap;
    members_size += part_size;
  }
  if (members.size() < 2 || !isShare(overlap, size, percent)) return;
  const double quality = meanShare(overlap, size, members_size);
  if (relation == Relation::kOverSegmented) {
    instances.push_back({quality, relation, {split}, std::move(members)});
  } else {
    instances.push_back({quality, relation, std::move(members), {split}});
  }
}

std::vector<Instance> findInstances(const Overlaps& overlaps, int percent) {
  std::vector<Instance> instances;
  for (std::size_t g = 0; g < overlaps.gt_sizes.size(); ++g) {
    const long size = overlaps.gt_sizes[g];
    const int gt = static_cast<int>(g);
    for (const Part& part : overlaps.est_of_gt[g]) {
      const long est_size = overlaps.est_sizes[static_cast<std::size_t>(part.region)];
      if (!isShare(part.overlap, size, percent) || !isShare(part.overlap, est_size, percent))
        continue;
      const double quality = meanShare(part.overlap, size, est_size);
      instances.push_back({quality, Relation::kCorrect, {gt}, {part.region}});
    }
    addSplit(gt, size, overlaps.est_of_gt[g], overlaps.est_sizes, percent, Relation::kOverSegmented,
             instances);
  }
  for (std::size_t e = 0; e < overlaps.est_sizes.size(); ++e) {
    addSplit(static_cast<int>(e), overlaps.est_sizes[e], overlaps.gt_of_est[e], overlaps.gt_sizes,
             percent, Relation::kUnderSegmented, instances);
  }
  return instances;
}

bool areFree(const std::vector<int>& regions, std::vector<bool>& taken) {
  const auto is_taken = [&](int r) { return taken[static_cast<std::size_t>(r)]; };
  return std::none_of(regions.begin(), regions.end(), is_taken);
}

void mark(const std::vector<int>& regions, std::vector<bool>& taken) {
  for (const int region : regions) taken[static_cast<std::size_t>(region)] = true;
}

int countFree(const std::vector<bool>& taken) {
  return static_cast<int>(std::count(taken.begin(), taken.end(), false));
}

RegionCounts countAt(const Overlaps& overlaps, int percent) {
  std::vector<Instance> instances = findInstances(overlaps, percent);
  std::stable_sort(instances.begin(), instances.end(), [](const Instance& a, const Instance& b) {
    return std::tie(b.quality, a.relation) < std::tie(a.quality, b.relation);
  });
  std::vector<bool> gt_taken(overlaps.gt_sizes.size(), false);
  std::vector<bool> est_taken(overlaps.est_sizes.size(), false);
  RegionCounts counts;
  counts.threshold_percent = percent;
  for (const Instance& instance : instances) {
    if (!areFree(instance.gt, gt_taken) || !areFree(instance.est, est_taken)) continue;
    mark(instance.gt, gt_taken);
    mark(instance.est, est_taken);
    counts.correct += instance.relation == Relation::kCorrect;
    counts.over_segmented += instance.relation == Relation::kOverSegmented;
    counts.under_segmented += instance.relation == Relation::kUnderSegmented;
  }
  counts.missed = countFree(gt_taken);
  counts.noise = countFree(est_taken);
  return counts;
}

}  // namespace

RegionMetrics regionMetrics(const std::vector<int>& gt_labels, const std::vector<int>& est_labels,
                            int first_region) {
  if (gt_labels.size() != est_labels.size()) {
    throw std::invalid_argument("regionMetrics: " + std::to_string(gt_labels.size()) +
                                " true and " + std::to_string(est_labels.size()) +
                                " estimated labels");
  }
  if (first_region < 0) throw std::invalid_argument("regionMetrics: first_region is negative");
  const Overlaps overlaps = countOverlaps(gt_labels, est_labels, first_region);
  RegionMetrics metrics;
  metrics.gt_regions = static_cast<int>(overlaps.gt_sizes.size());
  metrics.est_regions = static_cast<int>(overlaps.est_sizes.size());
  metrics.points = overlaps.points;
  for (const int percent : kRegionThresholds) metrics.counts.push_back(countAt(overlaps, percent));
  if (metrics.gt_regions == 0) return metrics;
  int correct = 0;
  for (int percent = kFirstRegionThreshold; percent <= kLastRegionThreshold; ++percent) {
    correct += countAt(overlaps, percent).correct;
  }
  const int thresholds = kLastRegionThreshold - kFirstRegionThreshold + 1;
  metrics.mean_correct = static_cast<double>(correct) / (thresholds * metrics.gt_regions);
  return metrics;
}

}  // namespace opp::mapping
