// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "detection/open_samples.h"

#include "detection/gather_hypotheses.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace opp {

OpenSamples::OpenSamples(const std::vector<VotingSample>& samples,
                         std::vector<std::uint8_t> is_open, double angle)
    : samples_(samples), angle_(angle), is_open_(std::move(is_open)) {
  for (std::uint32_t i = 0; i < is_open_.size(); ++i) {
    if (is_open_[i] != 0) open_.push_back(i);
  }
  closer_.assign(is_open_.size(), -1);
}

std::vector<std::uint32_t> OpenSamples::take(const std::vector<std::uint32_t>& order, int count,
                                             std::vector<std::uint8_t>& taken) const {
  std::vector<std::uint32_t> candidates, chosen;
  for (std::uint32_t position = 0; position < order.size(); ++position) {
    if (is_open_[order[position]] != 0 && taken[position] == 0) candidates.push_back(position);
  }
  const std::size_t wanted = std::min(candidates.size(), static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < wanted; ++k) {
    chosen.push_back(candidates[(2 * k + 1) * candidates.size() / (2 * wanted)]);
    taken[chosen.back()] = 1;
  }
  return chosen;
}

std::size_t OpenSamples::close(const std::vector<PlaneHypothesis>& planes) {
  const std::size_t before = open_.size();
  const auto cosine = static_cast<float>(std::cos(angle_));
  const GatheredHypotheses gathered = gatherHypotheses(planes, angle_);
  for (std::size_t k = 0; k < gathered.leaders.size(); ++k) {
    const std::size_t leader = gathered.leaders[k];
    const Eigen::Vector3f low = gathered.boxes[k].min(), high = gathered.boxes[k].max();
    const Eigen::Vector3f normal = planes[leader].plane.normal().cast<float>();
    const auto d = static_cast<float>(planes[leader].plane.d());
    const auto plane = static_cast<std::int32_t>(closed_.size());
    std::size_t left = 0;
    for (const std::uint32_t i : open_) {
      const VotingSample& sample = samples_[i];
      const float x = sample.point.x(), y = sample.point.y(), z = sample.point.z();
      const float height = normal.x() * x + normal.y() * y + normal.z() * z + d;
      const bool inside = (x >= low.x()) & (x <= high.x()) & (y >= low.y()) & (y <= high.y()) &
                          (z >= low.z()) & (z <= high.z());
      // Without branches, which would be taken at random.
      const bool on_plane = (std::abs(height) < sample.gate) &
                            (std::abs(normal.dot(sample.normal)) > cosine) & inside;
      is_open_[i] = on_plane ? 0 : 1;
      closer_[i] = plane;
      open_[left] = i;
      left += on_plane ? 0 : 1;
    }
    closed_.push_back(static_cast<int>(open_.size() - left));
    open_.resize(left);
  }
  return before - open_.size();
}

void OpenSamples::reopen(int least) {
  for (std::uint32_t i = 0; i < is_open_.size(); ++i) {
    if (is_open_[i] != 0 || closer_[i] < 0) continue;
    if (closed_[static_cast<std::size_t>(closer_[i])] < least) is_open_[i] = 1;
  }
  open_.clear();
  for (std::uint32_t i = 0; i < is_open_.size(); ++i) {
    if (is_open_[i] != 0) open_.push_back(i);
  }
}

}  // namespace opp
