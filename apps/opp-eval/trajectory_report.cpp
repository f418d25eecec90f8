// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp-eval/trajectory_report.h"

#include "opp/geometry/constants.h"

#include <iomanip>
#include <ostream>
#include <sstream>
#include <string>

namespace opp::mapping {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegrees = radToDeg(1.0);

Json rotationJson(const ErrorStatistics& statistics, const std::string& suffix, Json json) {
  json["rotation_rad" + suffix] = toJson(statistics);
  json["rotation_deg" + suffix] = toJson(statistics, kDegrees);
  return json;
}

/// One line of the table; values times `factor`.
void printRow(std::ostream& out, const std::string& name, const ErrorStatistics& statistics,
              double factor) {
  std::ostringstream row;
  row << std::left << std::setw(34) << name << std::right << std::setw(8) << statistics.count;
  row << std::fixed << std::setprecision(5);
  for (const double value :
       {statistics.rmse, statistics.mean, statistics.median, statistics.p90, statistics.max}) {
    if (statistics.count == 0) {
      row << std::setw(11) << '-';
    } else {
      row << std::setw(11) << value * factor;
    }
  }
  out << row.str() << '\n';
}

}  // namespace

Json toJson(const ErrorStatistics& statistics, double factor) {
  if (statistics.count == 0) return nullptr;
  return {{"count", statistics.count},        {"rmse", statistics.rmse * factor},
          {"mean", statistics.mean * factor}, {"median", statistics.median * factor},
          {"p90", statistics.p90 * factor},   {"max", statistics.max * factor}};
}

Json toJson(const TrajectoryError& error) {
  Json matrix = Json::array();
  for (int row = 0; row < 4; ++row) {
    const Eigen::RowVector4d r = error.gt_from_est.matrix().row(row);
    matrix.push_back({r[0], r[1], r[2], r[3]});
  }
  Json json;
  json["gt_poses"] = error.gt_poses;
  json["est_poses"] = error.est_poses;
  json["matched"] = error.matched;
  json["coverage"] = error.coverage;
  json["path_length_m"] = error.path_length;
  json["gt_from_est"] = matrix;
  json["ate"] =
      rotationJson(error.ate_rotation, "", {{"translation_m", toJson(error.ate_translation)}});
  json["rpe_per_frame"] = rotationJson(error.rpe_frame_rotation, "",
                                       {{"translation_m", toJson(error.rpe_frame_translation)}});
  json["rpe_per_metre"] =
      rotationJson(error.rpe_metre_rotation, "_per_m",
                   {{"translation_m_per_m", toJson(error.rpe_metre_translation)}});
  return json;
}

void print(std::ostream& out, const TrajectoryError& error) {
  std::ostringstream head;
  head << std::fixed << std::setprecision(3) << "Trajectory: " << error.matched << " of "
       << error.est_poses << " estimated poses have a true one; coverage of the " << error.gt_poses
       << " true poses " << std::setprecision(1) << 100.0 * error.coverage << " %; true path "
       << std::setprecision(3) << error.path_length << " m\n";
  out << head.str();
  out << "                                     count       rmse       mean     median        p90   "
         "  "
         "   max\n";
  printRow(out, "ATE translation [m]", error.ate_translation, 1.0);
  printRow(out, "ATE rotation [rad]", error.ate_rotation, 1.0);
  printRow(out, "ATE rotation [deg]", error.ate_rotation, kDegrees);
  printRow(out, "RPE per frame, translation [m]", error.rpe_frame_translation, 1.0);
  printRow(out, "RPE per frame, rotation [rad]", error.rpe_frame_rotation, 1.0);
  printRow(out, "RPE per frame, rotation [deg]", error.rpe_frame_rotation, kDegrees);
  printRow(out, "RPE per metre, translation [m/m]", error.rpe_metre_translation, 1.0);
  printRow(out, "RPE per metre, rotation [rad/m]", error.rpe_metre_rotation, 1.0);
  printRow(out, "RPE per metre, rotation [deg/m]", error.rpe_metre_rotation, kDegrees);
}

}  // namespace opp::mapping
