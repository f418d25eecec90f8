// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/export/planar_exports.h"

#include "opp/mapping/export/floorplan_svg.h"
#include "opp/mapping/export/mesh_files.h"
#include "opp/mapping/export/scene_file.h"
#include "opp/mapping/planar/plane_kinds.h"

namespace opp::mapping {

void writePlanarExports(const std::filesystem::path& folder, const PlanarMap& map,
                        const Trajectory& trajectory, const PlanarParams& params) {
  const std::vector<PlaneMesh> meshes = triangulate(map);
  writePly(folder / "planar_map.ply", meshes);
  writeObj(folder / "planar_map.obj", meshes);
  writeGlb(folder / "planar_map.glb", meshes);
  const Eigen::Vector3d z_axis = Eigen::Vector3d::UnitZ();
  writeFloorplan(folder / "floorplan.svg", map, trajectory,
                 estimateUp(map, z_axis, params).value_or(z_axis));
  writeScene(folder / "scene.3Dscene", map, trajectory);
}

}  // namespace opp::mapping
