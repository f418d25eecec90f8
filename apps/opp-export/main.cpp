// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/export/floorplan_svg.h"
#include "opp/mapping/export/mesh_files.h"
#include "opp/mapping/export/scene_file.h"
#include "opp/mapping/io/planar_map_json.h"
#include "opp/mapping/io/tum_trajectory.h"
#include "opp/mapping/planar/plane_kinds.h"

#include "common/flags.h"
#include "common/run_main.h"

#include <filesystem>

namespace {

using namespace opp::mapping;

/// What the flags ask for.
struct Request {
  std::filesystem::path input, output, trajectory;
  RenderOptions render;
};

Request parse(opp::apps::CommandLine& line) {
  opp::apps::InputFlag input(line, "Planar map (planar_map.json)");
  opp::apps::OutputFlag output(line,
                               "Result; its extension chooses the format: png, svg, ply, "
                               "obj, glb or 3Dscene",
                               "FILE", true);
  TCLAP::ValueArg<std::string> trajectory("t", "trajectory", "Trajectory to draw (trajectory.tum)",
                                          false, "", "FILE.tum", line);
  TCLAP::SwitchArg top("", "top", "png: look straight down (default: from the side)", line);
  opp::apps::AtLeast size(16);
  Request request;
  TCLAP::ValueArg<int> width("", "width", "png: width in pixels (default: 1280)", false,
                             request.render.width, &size, line);
  TCLAP::ValueArg<int> height("", "height", "png: height in pixels (default: 960)", false,
                              request.render.height, &size, line);
  line.parse();
  request.input = input.getValue();
  request.output = output.getValue();
  request.trajectory = trajectory.getValue();
  request.render.width = width.getValue();
  request.render.height = height.getValue();
  if (top.getValue()) request.render.view = SceneView::kTop;
  return request;
}

void run(opp::apps::CommandLine& line) {
  const Request request = parse(line);
  const PlanarMap map = readPlanarMap(request.input);
  const Trajectory trajectory =
      request.trajectory.empty() ? Trajectory() : readTumTrajectory(request.trajectory);
  const Eigen::Vector3d up =
      estimateUp(map, Eigen::Vector3d::UnitZ(), PlanarParams()).value_or(Eigen::Vector3d::UnitZ());
  const std::string extension = request.output.extension().string();
  if (extension == ".png") {
    renderScene(request.output, map, trajectory, up, request.render);
  } else if (extension == ".svg") {
    writeFloorplan(request.output, map, trajectory, up);
  } else if (extension == ".ply") {
    writePly(request.output, triangulate(map));
  } else if (extension == ".obj") {
    writeObj(request.output, triangulate(map));
  } else if (extension == ".glb") {
    writeGlb(request.output, triangulate(map));
  } else if (extension == ".3Dscene") {
    writeScene(request.output, map, trajectory);
  } else {
    throw opp::apps::UsageError("-o " + request.output.string() +
                                ": the extension must be png, svg, ply, obj, glb or 3Dscene");
  }
}

}  // namespace

int main(int argc, char** argv) {
  return opp::apps::runMain(argc, argv, "opp-export",
                            "Converts a planar map to a picture, a floor plan, a mesh or a scene.",
                            run);
}
