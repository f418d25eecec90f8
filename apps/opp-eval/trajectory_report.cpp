// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp-eval/trajectory_report.h"

#include "opp-eval/statistics_report.h"

#include <iomanip>
#include <ostream>
#include <sstream>

namespace opp::mapping {
namespace {

using Json = nlohmann::ordered_json;

Json rotationAndTranslation(const ErrorStatistics& translation, const ErrorStatistics& rotation) {
  return {{"translation_m", toJson(translation)},
          {"rotation_rad", toJson(rotation)},
          {"rotation_deg", toJson(rotation, kDegreesPerRadian)}};
}

Json rowsOf(const Eigen::Matrix4d& matrix) {
  Json rows = Json::array();
  for (int r = 0; r < 4; ++r) {
    rows.push_back({matrix(r, 0), matrix(r, 1), matrix(r, 2), matrix(r, 3)});
  }
  return rows;
}

}  // namespace

Json toJson(const TrajectoryError& error) {
  return {{"gt_poses", error.gt_poses},
          {"est_poses", error.est_poses},
          {"matched", error.matched},
          {"coverage", error.coverage},
          {"path_length_m", error.path_length},
          {"gt_from_est", rowsOf(error.gt_from_est.matrix())},
          {"gt_map_from_est_map", rowsOf(error.gt_map_from_est_map.matrix())},
          {"ate", rotationAndTranslation(error.ate_translation, error.ate_rotation)},
          {"rpe_per_frame",
           rotationAndTranslation(error.rpe_frame_translation, error.rpe_frame_rotation)},
          {"rpe_per_metre",
           {{"translation_m_per_m", toJson(error.rpe_metre_translation)},
            {"rotation_rad_per_m", toJson(error.rpe_metre_rotation)},
            {"rotation_deg_per_m", toJson(error.rpe_metre_rotation, kDegreesPerRadian)}}}};
}

void print(std::ostream& out, const TrajectoryError& error) {
  std::ostringstream head;
  head << std::fixed << std::setprecision(1) << "Trajectory: " << error.matched << " of "
       << error.est_poses << " estimated poses have a true one; coverage of the " << error.gt_poses
       << " true poses " << 100.0 * error.coverage << " %; true path " << std::setprecision(3)
       << error.path_length << " m\n";
  out << head.str();
  printStatisticsHeading(out);
  printStatistics(out, "ATE translation [m]", error.ate_translation);
  printStatistics(out, "ATE rotation [rad]", error.ate_rotation);
  printStatistics(out, "ATE rotation [deg]", error.ate_rotation, kDegreesPerRadian);
  printStatistics(out, "RPE per frame, translation [m]", error.rpe_frame_translation);
  printStatistics(out, "RPE per frame, rotation [rad]", error.rpe_frame_rotation);
  printStatistics(out, "RPE per frame, rotation [deg]", error.rpe_frame_rotation,
                  kDegreesPerRadian);
  printStatistics(out, "RPE per metre, translation [m/m]", error.rpe_metre_translation);
  printStatistics(out, "RPE per metre, rotation [rad/m]", error.rpe_metre_rotation);
  printStatistics(out, "RPE per metre, rotation [deg/m]", error.rpe_metre_rotation,
                  kDegreesPerRadian);
}

}  // namespace opp::mapping
