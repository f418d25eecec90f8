// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/pipeline/report_figures.h"

#include "opp/mapping/planar/level_frame.h"
#include "opp/mapping/planar/plane_kinds.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace opp::mapping {
namespace {

PartFigures figuresOf(const MapState& map, const PlanarMap& planar_map) {
  PartFigures figures;
  for (const LocalizedScan& scan : map.scans) {
    figures.sessions.insert(static_cast<std::size_t>(scan.session));
  }
  figures.scans = map.scans.size();
  figures.keyframes = map.keyframes.size();
  figures.planes = planar_map.planes.size();
  figures.lines = planar_map.lines.size();
  figures.corners = planar_map.corners.size();
  return figures;
}

}  // namespace

SessionTrack trackOf(const MapState& map, const SessionReport& session, int session_id) {
  std::vector<ScanStamp> scans = session.scans;
  const auto is_timeless = [](const ScanStamp& scan) { return !std::isfinite(scan.timestamp); };
  scans.erase(std::remove_if(scans.begin(), scans.end(), is_timeless), scans.end());
  std::stable_sort(scans.begin(), scans.end(), [](const ScanStamp& a, const ScanStamp& b) {
    return a.timestamp < b.timestamp;
  });
  const auto poses = posesOf(map, session_id);
  SessionTrack track;
  for (const ScanStamp& scan : scans) {
    const auto pose = poses.find(scan.scan_index);
    track.times.push_back(scan.timestamp);
    track.positions.push_back(
        pose == poses.end()
            ? Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()).eval()
            : Eigen::Vector3d(pose->second.translation()));
  }
  return track;
}

ReportFigures reportFigures(const Mapper& mapper, const RunReport& report,
                            const std::vector<PlanarMap>& planar_maps, const PlanarParams& params) {
  ReportFigures figures;
  int id = 0;
  for (const SessionReport& session : report.sessions) {
    figures.tracks.push_back(trackOf(mapper.map(), session, id++));
  }
  if (planar_maps.empty()) return figures;
  figures.map = planar_maps.front();
  const Eigen::Vector3d z_axis = Eigen::Vector3d::UnitZ();
  figures.level_from_map =
      levelFromMap(figures.map, estimateUp(figures.map, z_axis, params).value_or(z_axis));
  for (std::size_t part = 1; part < planar_maps.size(); ++part) {
    figures.parts.push_back(figuresOf(mapper.parts().at(part).map, planar_maps[part]));
  }
  return figures;
}

}  // namespace opp::mapping
