// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp-eval/primitive_report.h"

#include "opp/mapping/io/planar_map_json.h"

#include "opp-eval/statistics_report.h"

#include <iomanip>
#include <map>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace opp::mapping {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Planar maps of a folder by their name up to the first dot.
std::map<std::string, fs::path> mapsIn(const fs::path& folder) {
  std::map<std::string, fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".json") continue;
    const std::string name = entry.path().filename().string();
    const auto [other, is_new] = files.emplace(name.substr(0, name.find('.')), entry.path());
    if (!is_new) {
      throw std::runtime_error(folder.string() + ": " + name + " and " +
                               other->second.filename().string() +
                               " have the same name up to the first dot; remove one");
    }
  }
  return files;
}

PrimitiveComparison compareFolders(const fs::path& gt_folder, const fs::path& est_folder,
                                   const PrimitiveErrorParams& params,
                                   const Eigen::Isometry3d& gt_from_est) {
  const auto gt_files = mapsIn(gt_folder);
  const auto est_files = mapsIn(est_folder);
  PrimitiveComparison result;
  std::size_t pairs = 0;
  for (const auto& [name, gt_file] : gt_files) {
    const auto est_file = est_files.find(name);
    const bool have_estimate = est_file != est_files.end();
    const PlanarMap est = have_estimate ? readPlanarMap(est_file->second) : PlanarMap{};
    result.tallies.add(comparePrimitives(readPlanarMap(gt_file), est, params, gt_from_est));
    pairs += have_estimate;
  }
  if (pairs == 0) {
    throw std::runtime_error("nothing to compare: no file of " + gt_folder.string() +
                             " has a counterpart of the same name in " + est_folder.string());
  }
  result.without_estimate = gt_files.size() - pairs;
  result.without_truth = est_files.size() - pairs;
  return result;
}

/// Null where there is none.
Json toJson(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json toJson(const PrimitiveTally& tally, const std::string& distance_name) {
  const ErrorStatistics angles = statisticsOf(tally.angles);
  return {{"gt", tally.gt},
          {"est", tally.est},
          {"gt_found", tally.gt_found},
          {"est_correct", tally.est_correct},
          {"est_neutral", tally.est_neutral},
          {"precision", toJson(tally.precision())},
          {"recall", toJson(tally.recall())},
          {"recall_by_size", toJson(tally.recallBySize())},
          {"angle_rad", mapping::toJson(angles)},
          {"angle_deg", mapping::toJson(angles, kDegreesPerRadian)},
          {distance_name, mapping::toJson(statisticsOf(tally.distances))},
          {"near_" + distance_name, mapping::toJson(statisticsOf(tally.near_distances))}};
}

std::string asText(const std::optional<double>& value) {
  if (!value) return "-";
  std::ostringstream text;
  text << std::fixed << std::setprecision(4) << *value;
  return text.str();
}

void printTally(std::ostream& out, const std::string& name, const PrimitiveTally& tally) {
  std::ostringstream row;
  row << std::left << std::setw(10) << name << std::right << std::setw(9) << tally.gt
      << std::setw(11) << tally.est << std::setw(9) << tally.gt_found << std::setw(9)
      << tally.est_correct << std::setw(9) << tally.est_neutral << std::setw(11)
      << asText(tally.precision()) << std::setw(9) << asText(tally.recall()) << std::setw(9)
      << asText(tally.recallBySize());
  out << row.str() << '\n';
}

}  // namespace

PrimitiveComparison compareFiles(const fs::path& gt, const fs::path& est,
                                 const PrimitiveErrorParams& params,
                                 const Eigen::Isometry3d& gt_from_est) {
  if (fs::is_directory(gt) != fs::is_directory(est)) {
    throw std::runtime_error(gt.string() + " and " + est.string() +
                             ": give two files or two folders");
  }
  if (fs::is_directory(gt)) return compareFolders(gt, est, params, gt_from_est);
  PrimitiveComparison result;
  result.tallies = comparePrimitives(readPlanarMap(gt), readPlanarMap(est), params, gt_from_est);
  return result;
}

Json toJson(const PrimitiveComparison& comparison) {
  const PrimitiveTallies& tallies = comparison.tallies;
  const OrthogonalityTally& orthogonality = tallies.orthogonality;
  return {{"maps", tallies.maps},
          {"maps_without_estimate", comparison.without_estimate},
          {"maps_without_truth", comparison.without_truth},
          {"planes", toJson(tallies.planes, "offset_m")},
          {"lines", toJson(tallies.lines, "distance_m")},
          {"corners", toJson(tallies.corners, "distance_m")},
          {"orthogonality",
           {{"claimed", orthogonality.claimed},
            {"checked", orthogonality.checked},
            {"wrong", orthogonality.wrong},
            {"false_rate", toJson(orthogonality.falseRate())}}}};
}

void print(std::ostream& out, const PrimitiveComparison& comparison) {
  const PrimitiveTallies& t = comparison.tallies;
  out << "Primitives of " << t.maps << " true maps (" << comparison.without_estimate
      << " of them without an estimate; " << comparison.without_truth
      << " estimates without truth left out)\n"
      << "               true  estimated    found  correct  neutral  precision   recall  by size\n";
  printTally(out, "planes", t.planes);
  printTally(out, "lines", t.lines);
  printTally(out, "corners", t.corners);
  printStatisticsHeading(out);
  printStatistics(out, "planes, angle [deg]", statisticsOf(t.planes.angles), kDegreesPerRadian);
  printStatistics(out, "planes, offset [m]", statisticsOf(t.planes.distances));
  printStatistics(out, "lines, angle [deg]", statisticsOf(t.lines.angles), kDegreesPerRadian);
  printStatistics(out, "lines, distance [m]", statisticsOf(t.lines.distances));
  printStatistics(out, "corners, angle [deg]", statisticsOf(t.corners.angles), kDegreesPerRadian);
  printStatistics(out, "corners, distance [m]", statisticsOf(t.corners.distances));
  printStatistics(out, "near corners, distance [m]", statisticsOf(t.corners.near_distances));
  out << "orthogonality: " << t.orthogonality.claimed << " claimed, " << t.orthogonality.checked
      << " of them between true planes, " << t.orthogonality.wrong << " of these false (rate "
      << asText(t.orthogonality.falseRate()) << ")\n";
}

}  // namespace opp::mapping
