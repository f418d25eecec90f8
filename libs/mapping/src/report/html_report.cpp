// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/report/html_report.h"

#include "opp/mapping/io/atomic_file.h"
#include "opp/mapping/report/time_plot.h"

#include "export/drawing_numbers.h"
#include "report/base64.h"
#include "report/figure_text.h"
#include "report/viewer_data.h"
#include "report_resources.h"

#include <ctemplate/template.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <memory>
#include <ostream>
#include <stdexcept>

namespace opp::mapping {
namespace {

using ctemplate::TemplateDictionary;
using Json = nlohmann::ordered_json;

template <typename Pieces>
std::string joined(const Pieces& pieces) {
  std::string text;
  for (const std::string_view piece : pieces) text += piece;
  return text;
}

Json parsed(const std::string& run_json) {
  try {
    return Json::parse(run_json);
  } catch (const Json::exception& error) {
    throw std::runtime_error(std::string("report.html: run.json cannot be read: ") + error.what());
  }
}

std::string bytesOf(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) throw std::runtime_error("report.html: " + path.string() + " cannot be read");
  return bytes;
}

std::string nameOf(const Json& session) {
  return std::filesystem::path(session.at("input").at("path").get<std::string>())
      .filename()
      .string();
}

/// A figure: as run.json has it, and for people.
void addTile(TemplateDictionary& page, const std::string& name, const Json& value,
             const std::string& text) {
  TemplateDictionary* tile = page.AddSectionDictionary("TILE");
  tile->SetValue("NAME", name);
  tile->SetValue("VALUE", value.dump());
  tile->SetValue("TEXT", text);
}

void addTiles(const Json& run, TemplateDictionary& page) {
  for (const char* name : {"planes", "lines", "corners", "keyframes"}) {
    const Json count = run.at("counts").value(name, Json(0));
    addTile(page, name, count, count.dump());
  }
  std::size_t read = 0, used = 0;
  double path_length = 0.0;
  for (const Json& session : run.at("sessions")) {
    read += session.at("frames_read").get<std::size_t>();
    used += session.at("frames_used").get<std::size_t>();
    path_length += session.at("path_length_m").get<double>();
  }
  addTile(page, "scans in the map", used, std::to_string(used) + " of " + std::to_string(read));
  addTile(page, "path", path_length, metresText(path_length));
  const Json loops = run.at("counts").value("loop_closures", Json(0));
  addTile(page, "loop closures", loops, loops.dump());
  const Json& memory = run.at("peak_memory_mb");
  addTile(page, "peak memory", memory, megabytesText(memory.get<double>()));
}

void addWarnings(const Json& run, TemplateDictionary& page) {
  const Json& warnings = run.at("warnings");
  if (warnings.empty()) page.ShowSection("NO_WARNING");
  if (warnings.empty()) return;
  TemplateDictionary* section = page.AddSectionDictionary("SOME_WARNINGS");
  for (const Json& warning : warnings) {
    section->AddSectionDictionary("WARNING")->SetValue("TEXT", warning.get<std::string>());
  }
}

void addSessions(const Json& run, TemplateDictionary& page) {
  std::string title;
  int id = 0;
  for (const Json& session : run.at("sessions")) {
    title += (title.empty() ? "" : ", ") + nameOf(session);
    const Json& input = session.at("input");
    TemplateDictionary* row = page.AddSectionDictionary("SESSION");
    row->SetIntValue("ID", id++);
    row->SetValue("PATH", input.at("path").get<std::string>());
    row->SetValue("SHA256", input.at("sha256").get<std::string>());
    row->SetValue("SIZE", megabytesText(input.at("size").get<double>() / 1e6));
    for (const auto& [slot, key] :
         {std::pair("READ", "frames_read"), std::pair("USED", "frames_used"),
          std::pair("APART", "frames_apart"), std::pair("LOST", "frames_lost"),
          std::pair("KEYFRAMES", "keyframes"), std::pair("LOOPS", "loop_closures"),
          std::pair("PATH_VALUE", "path_length_m")}) {
      row->SetValue(slot, session.at(key).dump());
    }
    row->SetValue("PATH_LENGTH", metresText(session.at("path_length_m").get<double>()));
  }
  page.SetValue("TITLE", title);
}

void addParts(const std::vector<PartFigures>& parts, TemplateDictionary& page) {
  if (parts.empty()) return;
  TemplateDictionary* section = page.AddSectionDictionary("APART");
  int id = 0;
  for (const PartFigures& part : parts) {
    TemplateDictionary* row = section->AddSectionDictionary("PART");
    row->SetIntValue("ID", ++id);
    std::string sessions;
    for (const std::size_t session : part.sessions) {
      sessions += (sessions.empty() ? "" : ", ") + std::to_string(session);
    }
    row->SetValue("SESSIONS", sessions);
    row->SetValue("SCANS", std::to_string(part.scans));
    row->SetValue("KEYFRAMES", std::to_string(part.keyframes));
    row->SetValue("PLANES", std::to_string(part.planes));
    row->SetValue("LINES", std::to_string(part.lines));
    row->SetValue("CORNERS", std::to_string(part.corners));
  }
}

std::string plotsOf(const SessionTrack& track) {
  std::vector<double> times = track.times;
  for (double& time : times) time -= track.times.front();
  std::string plots;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& position : track.positions) values.push_back(position[axis]);
    plots += timePlotSvg(std::string(1, "xyz"[axis]) + " [m]", times, values);
  }
  return plots;
}

void addTracks(const Json& run, const std::vector<SessionTrack>& tracks, TemplateDictionary& page) {
  const auto is_known = [](const Eigen::Vector3d& position) { return position.allFinite(); };
  bool has_gaps = false;
  const std::size_t count = std::min(tracks.size(), run.at("sessions").size());
  for (std::size_t id = 0; id < count; ++id) {
    const SessionTrack& track = tracks[id];
    if (track.times.empty()) continue;
    TemplateDictionary* figure = page.AddSectionDictionary("TRACK");
    figure->SetValue("ID", std::to_string(id));
    figure->SetValue("PATH", nameOf(run.at("sessions")[id]));
    figure->SetValue("START", momentText(track.times.front()));
    const auto known = std::count_if(track.positions.begin(), track.positions.end(), is_known);
    if (known > 0) figure->SetValue("PLOTS", plotsOf(track));
    if (known == 0) figure->ShowSection("NOT_HERE");
    has_gaps |= known > 0 && known < static_cast<std::ptrdiff_t>(track.positions.size());
  }
  if (has_gaps) page.ShowSection("SOME_GAPS");
}

void addFigures(const Json& run, TemplateDictionary& page) {
  double longest = 0.0;
  for (const Json& seconds : run.at("seconds")) longest = std::max(longest, seconds.get<double>());
  for (const auto& [stage, seconds] : run.at("seconds").items()) {
    TemplateDictionary* row = page.AddSectionDictionary("STAGE");
    row->SetValue("NAME", stage);
    row->SetValue("VALUE", seconds.dump());
    row->SetValue("SECONDS", fixedNumber(seconds.get<double>(), 3));
    const double share = longest > 0.0 ? seconds.get<double>() / longest : 0.0;
    row->SetValue("SHARE", fixedNumber(share, 3));
  }
  for (const auto& [name, count] : run.at("counts").items()) {
    TemplateDictionary* row = page.AddSectionDictionary("COUNT");
    row->SetValue("NAME", name);
    row->SetValue("VALUE", count.dump());
  }
}

/// What the page holds for its viewer and its looks. None of it is text from outside.
void addResources(const ReportFiles& files, const ReportFigures& figures,
                  TemplateDictionary& page) {
  page.SetValue("STYLE", joined(kStyle));
  page.SetValue("VIEWER", joined(kViewer));
  page.SetValue("THREE_JS", joined(kThreeJs));
  page.SetValue("THREE_JS_LICENCE", joined(kThreeJsLicence));
  page.SetValue("SCENE", viewerData(figures));
  page.SetValue("GLB", base64(files.planar_map_glb));
  page.SetValue("FLOORPLAN", base64(files.floorplan_svg));
}

}  // namespace

std::string htmlReport(const ReportFiles& files, const ReportFigures& figures) {
  const Json run = parsed(files.run_json);
  TemplateDictionary page("report");
  try {
    page.SetValue("PROGRAM", run.at("program").get<std::string>());
    page.SetValue("VERSION", run.at("version").get<std::string>());
    addSessions(run, page);
    addTiles(run, page);
    addWarnings(run, page);
    addParts(figures.parts, page);
    addTracks(run, figures.tracks, page);
    addFigures(run, page);
  } catch (const Json::exception& error) {
    throw std::runtime_error(std::string("report.html: run.json is incomplete: ") + error.what());
  }
  page.SetValue("PARAMETERS", files.effective_ini);
  addResources(files, figures, page);
  const std::unique_ptr<ctemplate::Template> layout(
      ctemplate::Template::StringToTemplate(joined(kPage), ctemplate::DO_NOT_STRIP));
  std::string html;
  if (!layout || !layout->Expand(&html, &page)) {
    throw std::logic_error("page.html is no template");
  }
  return html;
}

void writeHtmlReport(const std::filesystem::path& folder, const ReportFigures& figures) {
  const ReportFiles files{bytesOf(folder / "run.json"), bytesOf(folder / "effective.ini"),
                          bytesOf(folder / "planar_map.glb"), bytesOf(folder / "floorplan.svg")};
  const std::string html = htmlReport(files, figures);
  writeFileAtomically(folder / "report.html", [&](std::ostream& stream) { stream << html; });
}

}  // namespace opp::mapping
