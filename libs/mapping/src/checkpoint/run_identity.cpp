// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/checkpoint/run_identity.h"

#include "opp/mapping/core/version.h"
#include "opp/mapping/io/parameters.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <iomanip>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace opp::mapping {
namespace {

/// Changes whenever what archive_primitives.h, archive_map.h or state_access.h store does.
constexpr int kFormat = 8;

std::string timeText(const timespec& time) {
  tm date{};
  gmtime_r(&time.tv_sec, &date);
  std::ostringstream text;
  text << std::put_time(&date, "%F %T") << '.' << std::setw(9) << std::setfill('0') << time.tv_nsec
       << " UTC";
  return text.str();
}

void addFile(const std::string& role, const std::filesystem::path& file, RunIdentity& identity) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) {
    throw std::runtime_error(file.string() + " cannot be read: " + std::strerror(errno) +
                             "; check the path");
  }
  identity[role] = file.string();
  // Names that begin with the role come after it: first it is told that the path differs.
  const std::string name = role + " " + file.string();
  identity[name + ": size"] = std::to_string(status.st_size) + " bytes";
  identity[name + ": last change"] = timeText(status.st_mtim);
}

void addSelection(const RawlogOptions& selection, RunIdentity& identity) {
  identity["--sensor-label"] = '"' + selection.sensor_label + '"';
  identity["--from-index"] = std::to_string(selection.from_index);
  identity["--to-index"] = selection.to_index == std::numeric_limits<std::size_t>::max()
                               ? "the end"
                               : std::to_string(selection.to_index);
  identity["--every"] = std::to_string(selection.every);
  if (!selection.images_directory.empty())
    identity["folder of images"] = selection.images_directory.string();
}

}  // namespace

RunIdentity identityOf(const std::vector<std::filesystem::path>& rawlogs,
                       const std::optional<std::filesystem::path>& initial_poses,
                       const RawlogOptions& selection, const MapperParams& params) {
  RunIdentity identity;
  identity["version of opp-mapping"] = std::string(version());
  identity["format of checkpoints"] = std::to_string(kFormat);
  for (std::size_t k = 0; k < rawlogs.size(); ++k)
    addFile("rawlog " + std::to_string(k + 1), rawlogs[k], identity);
  if (initial_poses) addFile("--initial-poses", *initial_poses, identity);
  addSelection(selection, identity);
  MapperParams shown = params;
  for (const Parameter& p : parametersOf(shown)) {
    // How often to store what was done changes nothing of it.
    if (p.section == CheckpointParams::kSection) continue;
    identity["[" + std::string(p.section) + "] " + std::string(p.field.name)] = valueText(p);
  }
  return identity;
}

std::optional<std::string> differenceOf(const RunIdentity& now, const RunIdentity& before) {
  for (const auto& [name, value] : now) {
    const auto old = before.find(name);
    if (old == before.end()) return name + " is " + value + ", was not there";
    if (old->second != value) return name + " is " + value + ", was " + old->second;
  }
  for (const auto& [name, value] : before) {
    if (now.count(name) == 0) return name + " was " + value + ", is not there";
  }
  return std::nullopt;
}

}  // namespace opp::mapping
