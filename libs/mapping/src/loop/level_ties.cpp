// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/level_ties.h"

#include "opp/mapping/loop/tied_sets.h"

#include "registration/observability.h"

#include <Eigen/Cholesky>

#include <cmath>
#include <map>
#include <optional>
#include <vector>

namespace opp::mapping {
namespace {

using Index = std::size_t;

/// What points up in a set of keyframes, in the map's axes.
class SetUp {
 public:
  void add(const Keyframe& keyframe) {
    roughly_up_ += keyframe.map_from_body.linear().col(2);
    const std::vector<PlanePrimitive>& planes = keyframe.features.primitives_in_body.planes;
    for (Index p = 0; p < planes.size(); ++p)
      areas_[keyframe.landmark_of_plane[p]] += planes[p].area;
  }

  /// Direction of the largest plane that is within `max_tilt` [rad] of level for a body that is
  /// held upright on average.
  std::optional<Eigen::Vector3d> direction(const LandmarkMap& landmarks, double max_tilt) const {
    std::optional<Eigen::Vector3d> best;
    double largest = 0.0;
    for (const auto& [landmark, area] : areas_) {
      const Eigen::Vector3d& normal = landmarks.planes[Index(landmark)].plane_in_map.normal();
      const double cosine = normal.dot(roughly_up_.normalized());
      if (std::abs(cosine) < std::cos(max_tilt) || area <= largest) continue;
      largest = area;
      best = cosine > 0.0 ? normal : Eigen::Vector3d(-normal);
    }
    return best;
  }

 private:
  Eigen::Vector3d roughly_up_ = Eigen::Vector3d::Zero();
  std::map<int, double> areas_;  ///< by landmark [m²]
};

/// Turns the tie so that both ups agree, as far as it is open. \param up_of_first, up_of_second in
/// the body frames of its keyframes. False if it denies that they do.
bool level(const Eigen::Vector3d& up_of_first, const Eigen::Vector3d& up_of_second, double sigma,
           RelativePoseFactor& tie) {
  const Eigen::Vector3d up = tie.first_from_second.linear() * up_of_second;
  const Eigen::AngleAxisd turn(Eigen::Quaterniond::FromTwoVectors(up, up_of_first));
  const Eigen::Vector3d omega = turn.angle() * turn.axis();
  const double variance = 2.0 * sigma * sigma;  // neither is exactly level
  const Eigen::Matrix3d open =
      covarianceOf(tie.information).topLeftCorner<3, 3>() + variance * Eigen::Matrix3d::Identity();
  if (omega.dot(open.ldlt().solve(omega)) > kClearly) return false;
  const Eigen::Matrix3d information =
      (Eigen::Matrix3d::Identity() - up_of_first * up_of_first.transpose()) / variance;
  tie.information.topLeftCorner<3, 3>() += information;
  Vector6d pull = Vector6d::Zero();
  pull.head<3>() = information * omega;
  tie.first_from_second = retract(tie.first_from_second, tie.information.ldlt().solve(pull));
  return true;
}

}  // namespace

bool levelTies(double max_variance, const MapperParams& params, MapState& map) {
  const std::vector<int> sets = tiedSets(map, max_variance);
  std::map<int, SetUp> ups;
  for (Index k = 0; k < sets.size(); ++k) ups[sets[k]].add(map.keyframes[k]);
  const auto upIn = [&](int keyframe) -> std::optional<Eigen::Vector3d> {
    const auto up =
        ups[sets[Index(keyframe)]].direction(map.landmarks, params.planar.max_camera_tilt);
    if (!up) return std::nullopt;
    return map.keyframes[Index(keyframe)].map_from_body.linear().transpose() * *up;
  };
  bool any = false;
  for (RelativePoseFactor& tie : map.factors.relative_poses) {
    if (sets[Index(tie.first)] == sets[Index(tie.second)]) continue;
    const auto up_of_first = upIn(tie.first), up_of_second = upIn(tie.second);
    if (up_of_first && up_of_second)
      any = level(*up_of_first, *up_of_second, params.loop.level_sigma, tie) || any;
  }
  return any;
}

}  // namespace opp::mapping
