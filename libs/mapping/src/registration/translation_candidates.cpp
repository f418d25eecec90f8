// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "registration/pose_candidates.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>

namespace opp::mapping {
namespace {

/// Offsets of the source along one axis [m] that bring parallel planes together.
struct Offset {
  double value = 0.0;
  double area = 0.0;  ///< of the planes that then coincide [m²]
};

struct Axis {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  std::vector<Offset> offsets;
  double area = 0.0;
};

/// Axes closer to the span of the others than this (sine) fix no further direction.
constexpr double kMinIndependence = 0.4;
/// Offsets kept per axis, those of most area. Where an axis is tried in steps, fewer of the others:
/// each of their combinations is tried at every step.
constexpr std::size_t kMaxOffsets = 12;
constexpr std::size_t kMaxOffsetsBesideSteps = 3;

double independence(const std::vector<Axis>& axes, const Eigen::Vector3d& direction) {
  if (axes.empty()) return 1.0;
  if (axes.size() == 1) return axes[0].direction.cross(direction).norm();
  return std::abs(axes[0].direction.cross(axes[1].direction).normalized().dot(direction));
}

class TranslationSearch {
 public:
  TranslationSearch(const ScanModel& target, const ScanModel& source,
                    const Eigen::Matrix3d& rotation, const GlobalAlignmentParams& params)
      : target_(target),
        source_(source),
        rotation_(rotation),
        params_(params),
        step_(target.voxels.cell()) {}

  std::vector<Eigen::Vector3d> run() {
    std::vector<Eigen::Vector3d> result = cornerTranslations();
    collectAxes();
    chooseThree();
    if (axes_.empty()) return result;
    appendCombinations(result);
    return result;
  }

 private:
  std::vector<Eigen::Vector3d> cornerTranslations() const {
    std::vector<Eigen::Vector3d> result;
    for (const Corner& t : target_.primitives().corners) {
      for (const Corner& s : source_.primitives().corners) {
        if (compatibleCorners(target_, t, source_, s, rotation_, params_)) {
          result.push_back(t.position - rotation_ * s.position);
        }
      }
    }
    return result;
  }

  void collectAxes() {
    const double min_cosine = std::cos(params_.direction_tolerance);
    for (const PlaneDirection& t : target_.directions) {
      for (const PlaneDirection& s : source_.directions) {
        if (target_.alike(t.normal, rotation_ * s.normal, min_cosine)) {
          addOffsets(t, s, axisOf(t.normal));
        }
      }
    }
    for (Axis& axis : axes_) {
      std::stable_sort(axis.offsets.begin(), axis.offsets.end(),
                       [](const Offset& a, const Offset& b) { return a.area > b.area; });
    }
  }

  Axis& axisOf(const Eigen::Vector3d& normal) {
    const double min_cosine = std::cos(params_.direction_tolerance);
    for (Axis& axis : axes_) {
      if (std::abs(axis.direction.dot(normal)) > min_cosine) return axis;
    }
    axes_.push_back({normal, {}, 0.0});
    return axes_.back();
  }

  void addOffsets(const PlaneDirection& t, const PlaneDirection& s, Axis& axis) const {
    for (const int p : t.planes) {
      const PlanePrimitive& fixed = target_.primitives().planes[static_cast<std::size_t>(p)];
      for (const int q : s.planes) {
        const PlanePrimitive& moving = source_.primitives().planes[static_cast<std::size_t>(q)];
        // The middle of the moved plane has to come to lie on the fixed one: n·(R c + t) + d = 0.
        const double along_normal = -fixed.plane.signedDistance(rotation_ * moving.moments.mean());
        const double sign = fixed.plane.normal().dot(axis.direction) > 0.0 ? 1.0 : -1.0;
        const double area = std::min(fixed.area, moving.area);
        addOffset({sign * along_normal, area}, axis);
        axis.area = std::max(axis.area, area);
      }
    }
  }

  void addOffset(const Offset& offset, Axis& axis) const {
    for (Offset& known : axis.offsets) {
      if (std::abs(known.value - offset.value) > 0.5 * step_) continue;
      const double area = known.area + offset.area;
      known.value += (offset.value - known.value) * offset.area / area;
      known.area = area;
      return;
    }
    axis.offsets.push_back(offset);
  }

  /// Keeps up to three independent axes, those of most area, and completes them by axes whose
  /// offsets are tried in even steps.
  void chooseThree() {
    std::stable_sort(axes_.begin(), axes_.end(),
                     [](const Axis& a, const Axis& b) { return a.area > b.area; });
    std::vector<Axis> chosen;
    for (const Axis& axis : axes_) {
      if (chosen.size() < 3 && independence(chosen, axis.direction) > kMinIndependence) {
        chosen.push_back(axis);
      }
    }
    const std::size_t kept = chosen.size() == 2 ? kMaxOffsetsBesideSteps : kMaxOffsets;
    for (Axis& axis : chosen) axis.offsets.resize(std::min(axis.offsets.size(), kept));
    if (chosen.size() == 2) chosen.push_back(freeAxis(chosen));
    axes_ = chosen.size() == 3 ? std::move(chosen) : std::vector<Axis>{};
  }

  Axis freeAxis(const std::vector<Axis>& others) const {
    Axis axis;
    axis.direction = others[0].direction.cross(others[1].direction).normalized();
    double low_t, high_t, low_s, high_s;
    extent(target_.cloud(), axis.direction, low_t, high_t);
    extent(source_.cloud(), rotation_.transpose() * axis.direction, low_s, high_s);
    // From the source just touching the target's low end to just touching its high end.
    const int steps = static_cast<int>((high_t - low_s - (low_t - high_s)) / step_);
    const double middle = 0.5 * (low_t - high_s + high_t - low_s);
    for (int k = 0; k <= steps; ++k) {
      // From the middle outward: the likelier ones come first if there are too many.
      const int offset = k % 2 == 0 ? k / 2 : -(k + 1) / 2;
      axis.offsets.push_back({middle + offset * step_, 0.0});
    }
    return axis;
  }

  static void extent(const OrientedCloud& cloud, const Eigen::Vector3d& direction, double& low,
                     double& high) {
    low = high = direction.dot(cloud.points.front().cast<double>());
    for (const Eigen::Vector3f& point : cloud.points) {
      const double x = direction.dot(point.cast<double>());
      low = std::min(low, x);
      high = std::max(high, x);
    }
  }

  void appendCombinations(std::vector<Eigen::Vector3d>& result) const {
    struct Combination {
      Eigen::Vector3d offsets;
      double area;
    };
    std::vector<Combination> combinations;
    for (const Offset& x : axes_[0].offsets) {
      for (const Offset& y : axes_[1].offsets) {
        for (const Offset& z : axes_[2].offsets) {
          combinations.push_back({{x.value, y.value, z.value}, x.area + y.area + z.area});
        }
      }
    }
    std::stable_sort(combinations.begin(), combinations.end(),
                     [](const Combination& a, const Combination& b) { return a.area > b.area; });
    Eigen::Matrix3d rows;
    for (int k = 0; k < 3; ++k) rows.row(k) = axes_[static_cast<std::size_t>(k)].direction;
    const Eigen::Matrix3d inverse = rows.inverse();
    const bool stepped = axes_[2].area <= 0.0;
    const auto count =
        std::min(combinations.size(), static_cast<std::size_t>(params_.max_translations));
    if (!stepped) combinations.resize(count);
    for (const Combination& c : combinations) result.push_back(inverse * c.offsets);
  }

  const ScanModel& target_;
  const ScanModel& source_;
  const Eigen::Matrix3d& rotation_;
  const GlobalAlignmentParams& params_;
  double step_;
  std::vector<Axis> axes_;
};

}  // namespace

bool compatibleCorners(const ScanModel& target, const Corner& target_corner,
                       const ScanModel& source, const Corner& source_corner,
                       const Eigen::Matrix3d& target_from_source,
                       const GlobalAlignmentParams& params) {
  // Whether a corner is convex is known only from the side it was seen from.
  if (target.sided && target_corner.kind != source_corner.kind &&
      target_corner.kind != CornerKind::kUnknown && source_corner.kind != CornerKind::kUnknown) {
    return false;
  }
  const double min_cosine = std::cos(params.direction_tolerance);
  return std::all_of(target_corner.planes.begin(), target_corner.planes.end(), [&](int p) {
    const Eigen::Vector3d& normal =
        target.primitives().planes[static_cast<std::size_t>(p)].plane.normal();
    return std::any_of(source_corner.planes.begin(), source_corner.planes.end(), [&](int q) {
      const Plane& other = source.primitives().planes[static_cast<std::size_t>(q)].plane;
      return target.alike(normal, target_from_source * other.normal(), min_cosine);
    });
  });
}

std::vector<Eigen::Vector3d> translationCandidates(const ScanModel& target, const ScanModel& source,
                                                   const Eigen::Matrix3d& target_from_source,
                                                   const GlobalAlignmentParams& params) {
  return TranslationSearch(target, source, target_from_source, params).run();
}

}  // namespace opp::mapping
