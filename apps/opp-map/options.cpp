// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp-map/options.h"

#include "common/flags.h"

#include <limits>

namespace opp::apps {

MapOptions parseOptions(CommandLine& line) {
  InputFlag input(line, "Rawlog to map");
  OutputFlag output(line, "Folder for the results; made if needed", "FOLDER", true);
  ParameterFlags parameters(line);
  AtLeast not_negative(0);
  AtLeast positive(1);
  TCLAP::ValueArg<int> from("", "from-index", "First 3D observation to use", false, 0,
                            &not_negative, line);
  TCLAP::ValueArg<int> to("", "to-index", "First 3D observation not to use any more (default: all)",
                          false, 0, &positive, line);
  TCLAP::ValueArg<int> every("", "every", "Use each K-th 3D observation", false, 1, &positive,
                             line);
  TCLAP::ValueArg<std::string> label(
      "", "sensor-label", "Use only sensors whose whole label matches this regular expression",
      false, "", "RE", line);
  TCLAP::ValueArg<std::string> poses("", "initial-poses",
                                     "Predicted poses of the body, map_from_body", false, "",
                                     "FILE.tum", line);
  TCLAP::SwitchArg no_octomap("", "no-octomap", "Write no map.ot and map.bt", line);
  TCLAP::ValueArg<double> resolution("", "resolution",
                                     "Edge of an OctoMap voxel [m]; sets occupancy.resolution",
                                     false, 0.05, "metres", line);
  ForceFlag force(line);
  ThreadsFlag threads(line);
  QuietFlag quiet(line);
  line.parse();

  MapOptions options;
  options.rawlog = input.getValue();
  options.output = output.getValue();
  options.selection.sensor_label = label.getValue();
  options.selection.from_index = static_cast<std::size_t>(from.getValue());
  if (to.isSet()) options.selection.to_index = static_cast<std::size_t>(to.getValue());
  options.selection.every = static_cast<std::size_t>(every.getValue());
  if (poses.isSet()) options.initial_poses = poses.getValue();
  parameters.applyTo(options.params);
  if (resolution.isSet()) {
    mapping::setParameter("occupancy.resolution=" + std::to_string(resolution.getValue()),
                          options.params, "--resolution");
  }
  options.octomap = !no_octomap.getValue();
  options.force = force.getValue();
  options.quiet = quiet.getValue();
  options.threads = threads.count();
  return options;
}

}  // namespace opp::apps
