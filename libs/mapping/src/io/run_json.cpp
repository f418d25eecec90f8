// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/run_json.h"

#include "opp/mapping/core/version.h"

#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include <ostream>
#include <type_traits>

namespace opp::mapping {
namespace {

using Json = nlohmann::ordered_json;

Json sessionJson(const SessionReport& session) {
  return {{"input", {{"path", session.path}, {"size", session.bytes}, {"sha256", session.sha256}}},
          {"frames_read", session.frames_read},
          {"frames_used", session.frames_used},
          {"frames_apart", session.frames_apart},
          {"frames_lost", session.frames_lost},
          {"keyframes", session.keyframes},
          {"path_length_m", session.path_length},
          {"loop_closures", session.loop_closures}};
}

Json parametersJson(const MapperParams& params) {
  Json json;
  MapperParams::visitSections(params, [&json](const auto& section) {
    using Section = std::decay_t<decltype(section)>;
    Section::visit(section, [&json](const auto& value, const Field& field) {
      json[std::string(Section::kSection)][std::string(field.name)] = value;
    });
  });
  return json;
}

double peakMemoryMegabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;  // Linux gives kilobytes
}

}  // namespace

void writeRunJson(std::ostream& os, const RunReport& report, const MapperParams& params) {
  Json json = {{"program", "opp-map"}, {"version", version()}};
  json["sessions"] = Json::array();
  for (const SessionReport& session : report.sessions)
    json["sessions"].push_back(sessionJson(session));
  json["counts"] = report.counts;
  json["seconds"] = report.seconds;
  json["peak_memory_mb"] = peakMemoryMegabytes();
  json["warnings"] = report.warnings;
  json["parameters"] = parametersJson(params);
  os << json.dump(2) << '\n';
}

}  // namespace opp::mapping
