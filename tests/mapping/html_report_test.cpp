// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/report/html_report.h"

#include "opp/mapping/io/run_json.h"
#include "opp/mapping/pipeline/report_figures.h"

#include "report/base64.h"
#include "report/figure_text.h"
#include "report/viewer_data.h"
#include "support/random.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <regex>
#include <sstream>

namespace opp::mapping {
namespace {

const std::string kNasty = "a<b>&\"c'.rawlog";
const std::string kNastyEscaped = "a&lt;b&gt;&amp;&quot;c&#39;.rawlog";

RunReport twoSessions() {
  RunReport report;
  SessionReport session;
  session.path = "/data/first.rawlog";
  session.sha256 = "00ff";
  session.frames_read = 12;
  session.frames_used = 7;
  session.frames_apart = 3;
  session.frames_lost = 2;
  session.path_length = 1.23456789;
  report.sessions = {session, session};
  report.sessions[1].path = "/data/" + kNasty;
  report.counts = {{"planes", 6}, {"lines", 12}, {"corners", 8}, {"keyframes", 4}, {"maps", 2}};
  report.seconds = {{"frames", 2.5}, {"export", 0.125}};
  report.warnings = {"</ul><script>alert(1)</script>", "5 < 6 && \"quoted\""};
  return report;
}

ReportFiles filesOf(const RunReport& report) {
  std::ostringstream run_json;
  writeRunJson(run_json, report, MapperParams{});
  return {run_json.str(), "# a <comment>\n[sensor]\nmax_range = 3 m\n", "glb bytes", "<svg/>"};
}

ReportFigures figures() {
  const Eigen::Vector3d lost = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  ReportFigures figures;
  figures.tracks = {{{0, 1, 2, 3}, {{0, 0, 0}, {1, 0, 0}, lost, {2, 0, 0}}},
                    {{86400, 86401}, {{0, 0, 0}, {1, 0, 0}}}};
  figures.parts = {{{0, 1}, 6, 2, 3, 1, 0}};
  return figures;
}

/// Not a matcher, which would print the whole page.
bool has(const std::string& page, const std::string& text) {
  return page.find(text) != std::string::npos;
}

std::size_t countOf(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    ++count;
  }
  return count;
}

TEST(HtmlReport, EscapesAllThatComesFromOutside) {
  const std::string page = htmlReport(filesOf(twoSessions()), figures());
  EXPECT_TRUE(has(page, "<title>Map of first.rawlog, " + kNastyEscaped + "</title>"));
  EXPECT_TRUE(has(page, "/data/" + kNastyEscaped));
  EXPECT_TRUE(has(page, "&lt;/ul&gt;&lt;script&gt;alert(1)&lt;/script&gt;"));
  EXPECT_TRUE(has(page, "5 &lt; 6 &amp;&amp; &quot;quoted&quot;"));
  EXPECT_TRUE(has(page, "# a &lt;comment&gt;\n[sensor]\nmax_range = 3 m\n"));
  EXPECT_FALSE(has(page, "a<b>"));
  EXPECT_FALSE(has(page, "alert(1)</script>"));
}

TEST(HtmlReport, ShowsWhatBecameOfTheInput) {
  const std::string page = htmlReport(filesOf(twoSessions()), figures());
  EXPECT_EQ(countOf(page, "sha256 00ff"), 2U);
  EXPECT_EQ(countOf(page, "<td>12</td><td>7</td><td>3</td><td>2</td>"), 2U);
  EXPECT_EQ(countOf(page, "<data value=\"1.23456789\">1.23 m</data>"), 2U);
  EXPECT_TRUE(has(page, "<th>frames</th><td><data value=\"2.5\">2.500</data>"));
  EXPECT_TRUE(has(page, "<th>export</th><td><data value=\"0.125\">0.125</data>"));
  EXPECT_TRUE(has(page, "<th>maps</th><td>2</td>"));
  EXPECT_TRUE(has(page, "14 of 24"));
  EXPECT_TRUE(has(page, "Session 1, " + kNastyEscaped + ", from 1970-01-02 00:00:00 UTC"));
}

TEST(HtmlReport, ShowsGapsAndMapsApartOnlyWhereThereAreSome) {
  const std::string page = htmlReport(filesOf(twoSessions()), figures());
  EXPECT_EQ(countOf(page, "<rect class=\"gap\""), 3U) << "one for each coordinate";
  EXPECT_TRUE(has(page, "Shaded: scans that are not in this map."));
  EXPECT_TRUE(has(page, "<td>1</td><td>6</td><td>0, 1</td><td>2</td><td>3</td><td>1</td>"));
  EXPECT_TRUE(has(page, "href=\"parts/1/floorplan.svg\""));
  EXPECT_FALSE(has(page, "No scan of it is in this map."));
  RunReport calm = twoSessions();
  calm.warnings.clear();
  const std::string calm_page = htmlReport(filesOf(calm), {});
  EXPECT_FALSE(has(calm_page, "class=\"gap\""));
  EXPECT_FALSE(has(calm_page, "Shaded"));
  EXPECT_FALSE(has(calm_page, "Maps apart"));
  EXPECT_TRUE(has(calm_page, "<p>None.</p>"));
  EXPECT_FALSE(has(page, "<p>None.</p>"));
}

TEST(HtmlReport, SaysWhereASessionIsInNoPlaceOfTheMap) {
  ReportFigures shown = figures();
  for (auto& position : shown.tracks[1].positions)
    position *= std::numeric_limits<double>::quiet_NaN();
  shown.tracks[0].positions[2] = {1.5, 0, 0};
  const std::string page = htmlReport(filesOf(twoSessions()), shown);
  EXPECT_EQ(countOf(page, "No scan of it is in this map."), 1U);
  EXPECT_EQ(countOf(page, "<svg class=\"plot\""), 3U) << "of the other session";
  EXPECT_FALSE(has(page, "Shaded"));
}

TEST(HtmlReport, FetchesNothingAndLeavesNoSlotOpen) {
  const std::string page = htmlReport(filesOf(twoSessions()), figures());
  const std::regex outside(
      R"re((src|href|action|data)=["']?(https?:|//)|url\(|@import|<link[^>]*http)re");
  std::smatch match;
  EXPECT_FALSE(std::regex_search(page, match, outside)) << match.str();
  EXPECT_FALSE(has(page, "{{"));
  EXPECT_EQ(countOf(page, "<script"), countOf(page, "</script>"));
  EXPECT_EQ(page.substr(page.size() - 8), "</html>\n");
}

TEST(HtmlReport, HoldsTheViewerWithItsLicence) {
  const std::string page = htmlReport(filesOf(twoSessions()), figures());
  EXPECT_TRUE(has(page, "three.js authors"));
  EXPECT_TRUE(has(page, "The above copyright notice and this permission notice"));
  EXPECT_TRUE(has(page, "exports.WebGLRenderer="));
  EXPECT_TRUE(has(page, "exports.GLTFLoader"));
  EXPECT_TRUE(has(page, "exports.OrbitControls"));
  EXPECT_LT(page.size(), 1200000U) << "the page without a map";
}

TEST(HtmlReport, RefusesWhatIsNoRun) {
  ReportFiles files = filesOf(twoSessions());
  for (const char* text : {"", "{", "[]", "{\"program\": \"opp-map\"}",
                           R"({"program": 1, "version": "1", "sessions": {}})"}) {
    files.run_json = text;
    EXPECT_THROW(htmlReport(files, {}), std::runtime_error) << text;
  }
}

TEST(HtmlReport, WriteNeedsTheOtherFilesOfTheRun) {
  const test::TempFolder folder;
  const ReportFiles files = filesOf(twoSessions());
  EXPECT_THROW(writeHtmlReport(folder.path(), figures()), std::runtime_error);
  EXPECT_TRUE(folder.contents().empty());
  test::writeFile(folder / "run.json", files.run_json);
  test::writeFile(folder / "effective.ini", files.effective_ini);
  test::writeFile(folder / "planar_map.glb", files.planar_map_glb);
  test::writeFile(folder / "floorplan.svg", files.floorplan_svg);
  writeHtmlReport(folder.path(), figures());
  EXPECT_TRUE(test::readFile(folder / "report.html") == htmlReport(files, figures()));
}

TEST(Base64, IsThatOfTheStandard) {
  // RFC 4648, section 10.
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64(std::string("\0\xff\xfe", 3)), "AP/+");
}

TEST(Base64, LongInputHasNoSeams) {
  const std::string bytes(3 * (1U << 21U) + 1, 'A');  // more than one of its chunks
  std::string expected;
  for (std::size_t i = 0; i < bytes.size() / 3; ++i) expected += "QUFB";
  EXPECT_TRUE(base64(bytes) == expected + "QQ==");
}

TEST(FigureText, IsShortAndAMomentIsADateWhereItCanBe) {
  EXPECT_EQ(metresText(1.005001), "1.01 m");
  EXPECT_EQ(megabytesText(0.04), "0.0 MB");
  EXPECT_EQ(momentText(0.0), "1970-01-01 00:00:00 UTC");
  EXPECT_EQ(momentText(1709208000.9), "2024-02-29 12:00:00 UTC");
  EXPECT_EQ(momentText(-1.5), "-1.500 s");
  EXPECT_EQ(momentText(1e18), "1000000000000000000.000 s");
}

TEST(ViewerData, IsLevelFrameLinesCornersAndTheWayWithoutItsGaps) {
  ReportFigures shown = figures();
  shown.map.lines = {{0, {0, 1}, {0, 0, 0}, {0, 0, 2.00049}, LineKind::kConcave}};
  shown.map.corners.resize(1);
  shown.map.corners[0].position = {1, -2, -1e-9};
  const auto json = nlohmann::json::parse(viewerData(shown));
  using Points = std::vector<std::vector<double>>;
  EXPECT_EQ(json["level_from_map"], (std::vector<double>{0, 0, 0, 1}));
  EXPECT_EQ(json["lines"], (Points{{0, 0, 0}, {0, 0, 2}}));
  EXPECT_EQ(json["corners"], (Points{{1, -2, 0}}));
  EXPECT_EQ(json["way"],
            (std::vector<Points>{{{0, 0, 0}, {1, 0, 0}}, {{2, 0, 0}}, {{0, 0, 0}, {1, 0, 0}}}));
}

TEST(ViewerData, LeavesOutStepsTooShortToSeeButKeepsTheEnds) {
  ReportFigures shown;
  shown.tracks.resize(1);
  for (int i = 0; i <= 1000; ++i) {
    shown.tracks[0].times.push_back(i);
    shown.tracks[0].positions.emplace_back(0.001 * i, 0, 0);
  }
  const auto way = nlohmann::json::parse(viewerData(shown))["way"][0];
  EXPECT_LE(way.size(), 102U);
  EXPECT_GE(way.size(), 90U);
  EXPECT_EQ(way.front()[0], 0.0);
  EXPECT_EQ(way.back()[0], 1.0);
}

TEST(TrackOf, HasEveryScanThatWasReadInTheOrderOfTime) {
  test::Random random(7);
  for (int round = 0; round < 50; ++round) {
    MapState map;
    map.keyframes.resize(1);
    SessionReport session;
    std::set<double> localized;
    for (std::size_t i = 0; i < 20; ++i) {
      const double time = 100.0 - static_cast<double>(i);  // the rawlog is in disorder
      session.scans.push_back({5 * i, time});
      if (random.integer(0, 1) == 0) continue;
      LocalizedScan scan;
      scan.scan_index = 5 * i;
      scan.keyframe_from_body.translation().x() = time;
      map.scans.push_back(scan);
      scan.session = 1;  // that of another session says nothing
      scan.scan_index = 5 * i + 5;
      map.scans.push_back(scan);
      localized.insert(time);
    }
    session.scans.push_back({500, std::numeric_limits<double>::quiet_NaN()});
    const SessionTrack track = trackOf(map, session, 0);
    ASSERT_EQ(track.times.size(), 20U);
    ASSERT_EQ(track.positions.size(), 20U);
    EXPECT_TRUE(std::is_sorted(track.times.begin(), track.times.end()));
    for (std::size_t i = 0; i < 20; ++i) {
      EXPECT_EQ(track.positions[i].allFinite(), localized.count(track.times[i]) == 1);
      if (localized.count(track.times[i]) == 1) {
        EXPECT_EQ(track.positions[i].x(), track.times[i]);
      }
    }
  }
}

}  // namespace
}  // namespace opp::mapping
