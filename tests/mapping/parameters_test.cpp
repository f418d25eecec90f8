// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/parameters.h"

#include "opp/geometry/constants.h"
#include "opp/mapping/core/mapper_params.h"

#include "support/random.h"
#include "support/temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <sstream>
#include <stdexcept>

namespace opp::mapping {
namespace {

using testing::HasSubstr;

struct Searching {
  static constexpr std::string_view kSection = "searching";
  double radius = 1.0;
  double tolerance = degToRad(10.0);
  std::uint64_t seed = 7;
  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.radius, Field{"radius", "m", 0.0, 10.0, "neighbourhood"});
    f(p.tolerance, Field{"tolerance", "rad", 0.0, kPi, "largest angle"});
    f(p.seed, Field{"seed", "", 0.0, kUnbounded, "seed"});
  }
};

struct Naming {
  static constexpr std::string_view kSection = "naming";
  std::string label = "none";
  bool loud = false;
  int count = 3;
  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.label, Field{"label", "", 0, 0, "text on the sign"});
    f(p.loud, Field{"loud", "", 0, 1, "say it"});
    f(p.count, Field{"count", "", 1, 9, "how often"});
  }
};

struct Inner {
  Searching searching;
  template <typename Self, typename F>
  static void visitSections(Self&& p, F&& f) {
    f(p.searching);
  }
};

struct Program {
  Inner inner;
  Naming naming;
  template <typename Self, typename F>
  static void visitSections(Self&& p, F&& f) {
    Inner::visitSections(p.inner, f);
    f(p.naming);
  }
};

std::string messageOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no std::invalid_argument";
}

std::string textOf(const Program& params) {
  std::ostringstream os;
  writeParameters(os, params);
  return os.str();
}

TEST(Parameters, FileSetsWhatItNamesAndKeepsTheRest) {
  const test::TempFolder folder;
  test::writeFile(folder / "a.ini", "[naming]\ncount = 5\n[searching]\ntolerance = 0.5 rad\n");
  Program params;
  loadParameters(folder / "a.ini", params);
  EXPECT_EQ(params.naming.count, 5);
  EXPECT_EQ(params.inner.searching.tolerance, 0.5);
  EXPECT_EQ(params.inner.searching.radius, 1.0);
}

TEST(Parameters, MessageNamesFileLineSectionKeyValueAndRange) {
  const test::TempFolder folder;
  const std::filesystem::path file = folder / "a.ini";
  test::writeFile(file, "[naming]\nloud = true\n\ncount = 10\n");
  Program params;
  EXPECT_EQ(messageOf([&] { loadParameters(file, params); }),
            file.string() + ":4: [naming] count = 10: out of range; allowed: 1 to 9");
  EXPECT_FALSE(params.naming.loud) << "a refused file must change nothing";
}

TEST(Parameters, UnknownSectionsAndKeysAreErrorsThatNameTheKnown) {
  Program params;
  EXPECT_EQ(messageOf([&] { setParameter("serching.radius=1", params); }),
            "--set: [serching] radius = 1: unknown section; there are: searching, naming");
  EXPECT_EQ(messageOf([&] { setParameter("searching.radios=1", params); }),
            "--set: [searching] radios = 1: unknown key; [searching] has: radius, tolerance, seed");
}

TEST(Parameters, MissingFileIsAnError) {
  Program params;
  EXPECT_THROW(loadParameters("/no/such/file.ini", params), std::runtime_error);
}

TEST(Parameters, LaterAssignmentWins) {
  Program params;
  setParameter("searching.radius=2 m", params);
  setParameter("searching.radius = 3", params);
  EXPECT_EQ(params.inner.searching.radius, 3.0);
}

TEST(Parameters, WrittenFileHoldsMeaningRangeDefaultAndValue) {
  Program params;
  params.inner.searching.radius = 2.5;
  EXPECT_EQ(textOf(params),
            "[searching]\n"
            "# neighbourhood; 0 to 10 m, default 1 m\n"
            "radius = 2.5 m\n"
            "# largest angle; 0 to 180 deg, default 10 deg\n"
            "tolerance = 10 deg\n"
            "# seed; at least 0, default 7\n"
            "seed = 7\n"
            "\n"
            "[naming]\n"
            "# text on the sign; text, default \"none\"\n"
            "label = \"none\"\n"
            "# say it; true or false, default false\n"
            "loud = false\n"
            "# how often; 1 to 9, default 3\n"
            "count = 3\n");
}

TEST(Parameters, WrittenFileReadsBackToTheSameValues) {
  const test::TempFolder folder;
  test::Random random(11);
  for (int k = 0; k < 100; ++k) {
    Program written;
    written.inner.searching.radius = random.uniform(0.0, 10.0);
    written.inner.searching.tolerance = random.uniform(0.0, kPi);
    written.inner.searching.seed = static_cast<std::uint64_t>(random.integer(0, 1 << 30)) << 33;
    written.naming.loud = random.integer(0, 1) == 1;
    written.naming.label = " # " + std::to_string(k) + " ; ";
    test::writeFile(folder / "a.ini", textOf(written));
    Program read;
    loadParameters(folder / "a.ini", read);
    EXPECT_EQ(read.inner.searching.radius, written.inner.searching.radius);
    EXPECT_EQ(read.inner.searching.tolerance, written.inner.searching.tolerance);
    EXPECT_EQ(read.inner.searching.seed, written.inner.searching.seed);
    EXPECT_EQ(read.naming.loud, written.naming.loud);
    EXPECT_EQ(read.naming.label, written.naming.label);
  }
}

TEST(Parameters, TableHasALineForEachParameter) {
  std::ostringstream os;
  writeParameterTable(os, Program());
  EXPECT_EQ(os.str(),
            "  key        value   default  allowed        meaning\n"
            "[searching]\n"
            "  radius     1 m     1 m      0 to 10 m      neighbourhood\n"
            "  tolerance  10 deg  10 deg   0 to 180 deg   largest angle\n"
            "  seed       7       7        at least 0     seed\n"
            "[naming]\n"
            "  label      \"none\"  \"none\"   text           text on the sign\n"
            "  loud       false   false    true or false  say it\n"
            "  count      3       3        1 to 9         how often\n");
}

TEST(MapperParams, DefaultsAreValidAndNamesAreUnique) {
  MapperParams params;
  EXPECT_NO_THROW(validateSections(params));
  std::set<std::pair<std::string_view, std::string_view>> names;
  for (const Parameter& parameter : parametersOf(params)) {
    EXPECT_TRUE(names.insert({parameter.section, parameter.field.name}).second)
        << parameter.section << "." << parameter.field.name;
    EXPECT_FALSE(parameter.field.meaning.empty()) << parameter.field.name;
  }
}

}  // namespace
}  // namespace opp::mapping
