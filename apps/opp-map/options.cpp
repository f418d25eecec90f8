// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp-map/options.h"

#include "common/flags.h"

#include <regex>

namespace opp::apps {
namespace {

/// The text, if it is a regular expression. \throws UsageError otherwise.
std::string checkedExpression(const std::string& flag, const std::string& text) {
  try {
    const std::regex compiled(text);
    return text;
  } catch (const std::regex_error& error) {
    throw UsageError(flag + " " + text + ": no regular expression: " + error.what());
  }
}

}  // namespace

MapOptions parseOptions(CommandLine& line) {
  InputsFlag input(line,
                   "Rawlog to map; several are sessions of one place, with no known pose between "
                   "them");
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
  TCLAP::ValueArg<std::string> resolution("", "resolution",
                                          "Edge of an OctoMap voxel; sets occupancy.resolution",
                                          false, "", "metres", line);
  TCLAP::SwitchArg resume("", "resume",
                          "Go on where the same call was interrupted; if it was not, begin", line);
  ForceFlag force(line);
  ThreadsFlag threads(line);
  QuietFlag quiet(line);
  line.parse();

  MapOptions options;
  options.rawlogs.assign(input.getValue().begin(), input.getValue().end());
  options.output = output.getValue();
  options.selection.sensor_label = checkedExpression("--sensor-label", label.getValue());
  options.selection.from_index = static_cast<std::size_t>(from.getValue());
  if (to.isSet()) options.selection.to_index = static_cast<std::size_t>(to.getValue());
  options.selection.every = static_cast<std::size_t>(every.getValue());
  if (poses.isSet()) options.initial_poses = poses.getValue();
  parameters.applyTo(options.params);
  if (resolution.isSet()) {
    setFromFlag("occupancy.resolution=" + resolution.getValue(), "--resolution", options.params);
  }
  options.octomap = !no_octomap.getValue();
  options.resume = resume.getValue();
  options.force = force.getValue();
  options.quiet = quiet.getValue();
  options.threads = threads.count();
  return options;
}

}  // namespace opp::apps
