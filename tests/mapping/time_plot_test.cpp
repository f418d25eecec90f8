// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/report/time_plot.h"

#include "support/random.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <regex>

namespace opp::mapping {
namespace {

using testing::HasSubstr;
using testing::Not;

const double kNone = std::numeric_limits<double>::quiet_NaN();

std::size_t countOf(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    ++count;
  }
  return count;
}

/// The drawing instructions of the element with this class; empty if there is none.
std::string pathOf(const std::string& svg, const std::string& css_class) {
  const std::string before = "class=\"" + css_class + "\" d=\"";
  const std::size_t found = svg.find(before);
  if (found == std::string::npos) return "";
  const std::size_t begin = found + before.size();
  return svg.substr(begin, svg.find('"', begin) - begin);
}

/// x and width of each gap.
std::vector<std::pair<double, double>> gapsOf(const std::string& svg) {
  std::vector<std::pair<double, double>> gaps;
  const std::regex element(R"re(class="gap" x="([^"]*)" y="[^"]*" width="([^"]*)")re");
  for (std::sregex_iterator it(svg.begin(), svg.end(), element), end; it != end; ++it) {
    gaps.emplace_back(std::stod((*it)[1]), std::stod((*it)[2]));
  }
  return gaps;
}

TEST(TimePlot, OneLineWhereEveryTimeHasAValue) {
  const std::string svg = timePlotSvg("x [m]", {0, 1, 2, 3}, {0, 1, 0.5, 1});
  const std::string line = pathOf(svg, "line");
  EXPECT_EQ(countOf(line, "M"), 1U) << line;
  EXPECT_EQ(countOf(line, "L"), 3U) << line;
  EXPECT_TRUE(gapsOf(svg).empty());
  EXPECT_THAT(svg, HasSubstr(">x [m]</text>"));
  EXPECT_THAT(svg, HasSubstr(">1.0 s</text>")) << "a tick of the time";
  EXPECT_THAT(svg, HasSubstr(">0.8</text>")) << "a tick of the value";
}

TEST(TimePlot, GapsInterruptTheLineAndAreShaded) {
  // The picture is 900 units wide between its margins of 48 and 12.
  const std::string svg = timePlotSvg("x", {0, 1, 2, 3, 4, 5, 6, 7, 8, 9},
                                      {kNone, 1, 2, 3, kNone, kNone, 3, 4, 5, kNone});
  const std::string line = pathOf(svg, "line");
  EXPECT_EQ(countOf(line, "M"), 2U) << line;
  EXPECT_EQ(countOf(line, "L"), 4U) << line;
  const auto gaps = gapsOf(svg);
  ASSERT_EQ(gaps.size(), 3U);
  EXPECT_THAT(gaps[0], testing::Pair(48.0, 100.0)) << "from the first time to the first value";
  EXPECT_THAT(gaps[1], testing::Pair(348.0, 300.0)) << "from value to value";
  EXPECT_THAT(gaps[2], testing::Pair(848.0, 100.0)) << "from the last value to the last time";
}

TEST(TimePlot, DrawsLoneValuesAsDots) {
  const std::string svg = timePlotSvg("x", {0, 1, 2}, {kNone, 1, kNone});
  EXPECT_THAT(pathOf(svg, "line"), testing::EndsWith("h0"));
  EXPECT_EQ(gapsOf(svg).size(), 2U);
}

TEST(TimePlot, DegenerateInputIsStillAPicture) {
  for (const auto& [times, values] :
       std::vector<std::pair<std::vector<double>, std::vector<double>>>{
           {{}, {}},
           {{5}, {1}},
           {{5, 5, 5}, {1, 1, 1}},
           {{0, 1}, {kNone, kNone}},
           {{1e9, 2e9}, {-1e6, 1e6}},
           {{0, 1e-9}, {1e-9, 2e-9}}}) {
    const std::string svg = timePlotSvg("x", times, values);
    EXPECT_THAT(svg, testing::StartsWith("<svg "));
    EXPECT_THAT(svg, testing::EndsWith("</svg>\n"));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, Not(HasSubstr("inf")));
    EXPECT_LT(svg.size(), 10000U);
  }
  EXPECT_THROW(timePlotSvg("x", {0, 1}, {0}), std::invalid_argument);
}

TEST(TimePlot, ManyValuesCostNoMoreThanThePictureShowsAndKeepTheirExtremes) {
  test::Random random(3);
  for (int round = 0; round < 50; ++round) {
    std::vector<double> times, values;
    for (int i = 0; i < 20000; ++i) {
      times.push_back(0.01 * i);
      values.push_back(random.uniform(-1.0, 1.0));
    }
    values[static_cast<std::size_t>(random.integer(0, 19999))] = 9.0;
    values[static_cast<std::size_t>(random.integer(0, 19999))] = -9.0;
    const std::string line = pathOf(timePlotSvg("x", times, values), "line");
    // 900 units in columns of half a unit with up to four points.
    EXPECT_LE(countOf(line, "L"), 4U * 1801U);
    // 9 m and −9 m are 5 % of the range from the edges at 8 and 128 units.
    EXPECT_THAT(line, HasSubstr(" 13.5")) << "the highest";
    EXPECT_THAT(line, HasSubstr(" 122.5")) << "the lowest";
  }
}

}  // namespace
}  // namespace opp::mapping
