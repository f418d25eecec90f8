// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/evaluation/assignment.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace opp::mapping {
namespace {

constexpr double kUnreached = std::numeric_limits<double>::infinity();
/// An improvement below this is rounding of sums of costs; following it could cycle.
constexpr double kRounding = 1e-12;

/// Grows an assignment by one pair at a time along the cheapest alternating path (Bellman–Ford:
/// giving up a pair has a negative cost).
class Assigner {
 public:
  Assigner(std::size_t left_count, std::size_t right_count,
           const std::vector<AssignmentCandidate>& candidates)
      : candidates_(candidates), of_left_(left_count, -1), of_right_(right_count, -1) {}

  std::vector<int> run() {
    while (augment()) {
    }
    return of_left_;
  }

 private:
  /// Costs of the cheapest alternating paths from free left elements to each element.
  void findPaths() {
    left_cost_.assign(of_left_.size(), kUnreached);
    right_cost_.assign(of_right_.size(), kUnreached);
    right_via_.assign(of_right_.size(), -1);
    for (std::size_t l = 0; l < of_left_.size(); ++l) {
      if (of_left_[l] < 0) left_cost_[l] = 0.0;
    }
    while (relax()) {
    }
  }

  bool relax() {
    bool improved = false;
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
      const auto& [left, right, cost] = candidates_[k];
      const double reached = left_cost_[left] + cost;
      if (of_left_[left] == static_cast<int>(k) || !(reached < right_cost_[right] - kRounding))
        continue;
      improved = true;
      right_cost_[right] = reached;
      right_via_[right] = static_cast<int>(k);
      if (of_right_[right] < 0) continue;
      const AssignmentCandidate& given_up = candidate(of_right_[right]);
      left_cost_[given_up.left] = reached - given_up.cost;
    }
    return improved;
  }

  bool augment() {
    findPaths();
    std::size_t end = of_right_.size();
    for (std::size_t r = 0; r < of_right_.size(); ++r) {
      const double best = end == of_right_.size() ? kUnreached : right_cost_[end];
      if (of_right_[r] < 0 && right_cost_[r] < best) end = r;
    }
    if (end == of_right_.size()) return false;
    while (true) {
      const int via = right_via_[end];
      const std::size_t left = candidate(via).left;
      const int given_up = of_left_[left];
      of_left_[left] = of_right_[end] = via;
      if (given_up < 0) return true;
      end = candidate(given_up).right;
    }
  }

  const AssignmentCandidate& candidate(int k) const {
    return candidates_[static_cast<std::size_t>(k)];
  }

  const std::vector<AssignmentCandidate>& candidates_;
  std::vector<int> of_left_;  ///< candidate of each left element; −1: free
  std::vector<int> of_right_;
  std::vector<double> left_cost_;
  std::vector<double> right_cost_;
  std::vector<int> right_via_;  ///< last candidate of the path
};

}  // namespace

std::vector<int> assignOneToOne(std::size_t left_count, std::size_t right_count,
                                const std::vector<AssignmentCandidate>& candidates) {
  for (const AssignmentCandidate& c : candidates) {
    if (c.left >= left_count || c.right >= right_count || !std::isfinite(c.cost)) {
      throw std::invalid_argument("assignOneToOne: a candidate's index or cost is out of range");
    }
  }
  return Assigner(left_count, right_count, candidates).run();
}

}  // namespace opp::mapping
