// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/ini_file.h"

#include "support/random.h"
#include "support/temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>

namespace opp::mapping {
namespace {

using testing::HasSubstr;

std::string messageOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no std::invalid_argument";
}

TEST(ParseIni, GivesEntriesInOrderWithTheirLines) {
  const auto entries =
      parseIni("# comment\n[sensor]\nmax_range = 6 m\n\n[ voting ]\nseed=1", "a.ini");
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_EQ(entries[0].section, "sensor");
  EXPECT_EQ(entries[0].key, "max_range");
  EXPECT_EQ(entries[0].value, "6 m");
  EXPECT_EQ(entries[0].origin, "a.ini:3");
  EXPECT_EQ(entries[1].section, "voting");
  EXPECT_EQ(entries[1].value, "1");
  EXPECT_EQ(entries[1].origin, "a.ini:6");
}

TEST(ParseIni, NoTextHasNoEntries) {
  EXPECT_TRUE(parseIni("", "a.ini").empty());
  EXPECT_TRUE(parseIni("\n  \n; only\n# comments\n[empty]\n", "a.ini").empty());
}

TEST(ParseIni, CommentNeedsABlankBeforeIt) {
  const auto entries = parseIni("[s]\na = 1 # one\nb = x#y;z\nc = \"p # q\" ; r\nd = = =", "a.ini");
  ASSERT_EQ(entries.size(), 4U);
  EXPECT_EQ(entries[0].value, "1");
  EXPECT_EQ(entries[1].value, "x#y;z");
  EXPECT_EQ(entries[2].value, "\"p # q\"");
  EXPECT_EQ(entries[3].value, "= =");
}

TEST(ParseIni, AcceptsWindowsTextAndSectionsOpenedAgain) {
  const auto entries =
      parseIni("\xEF\xBB\xBF[s]\r\na = 1\r\n[t]\r\na = 2\r\n[s]\r\nb = 3\r\n", "a.ini");
  ASSERT_EQ(entries.size(), 3U);
  EXPECT_EQ(entries[0].value, "1");
  EXPECT_EQ(entries[2].section, "s");
}

TEST(ParseIni, NamesTheLineOfAMistake) {
  EXPECT_THAT(messageOf([] { parseIni("[s]\n\nmax_range 6", "a.ini"); }),
              HasSubstr("a.ini:3: 'max_range 6'"));
  EXPECT_THAT(messageOf([] { parseIni("[s\n", "a.ini"); }), HasSubstr("a.ini:1: '[s'"));
  EXPECT_THAT(messageOf([] { parseIni("[ ]\n", "a.ini"); }), HasSubstr("a.ini:1"));
  EXPECT_THAT(messageOf([] { parseIni("[s]\n= 1\n", "a.ini"); }), HasSubstr("a.ini:2"));
  EXPECT_THAT(messageOf([] { parseIni("a = 1\n[s]", "a.ini"); }), HasSubstr("before the first"));
}

TEST(ParseIni, RefusesAKeyGivenTwiceAndNamesBothLines) {
  const std::string message = messageOf([] { parseIni("[s]\na = 1\n[t]\n[s]\na = 1", "a.ini"); });
  EXPECT_THAT(message, HasSubstr("a.ini:5"));
  EXPECT_THAT(message, HasSubstr("a.ini:2"));
}

TEST(ParseIni, RandomBytesAreEntriesOrAnErrorNeverACrash) {
  test::Random random(7);
  for (int k = 0; k < 500; ++k) {
    std::string bytes;
    for (int i = random.integer(0, 80); i > 0; --i) {
      // Half the bytes from INI's own characters, so that the parser gets past its first check.
      const bool own = random.integer(0, 1) == 0;
      bytes += own ? "[]=\"#; \n\ra"[random.integer(0, 9)]
                   : static_cast<char>(random.integer(-128, 127));
    }
    try {
      for (const IniEntry& entry : parseIni(bytes, "random")) EXPECT_FALSE(entry.key.empty());
    } catch (const std::invalid_argument&) {
    }
  }
}

TEST(ReadIni, ReadsAFileAndRefusesWhatIsNone) {
  const test::TempFolder folder;
  test::writeFile(folder / "a.ini", "[s]\na = 1\n");
  EXPECT_EQ(readIni(folder / "a.ini").size(), 1U);
  EXPECT_THROW(readIni(folder / "missing.ini"), std::runtime_error);
  EXPECT_THROW(readIni(folder.path()), std::runtime_error);
}

TEST(ParseAssignment, SplitsSectionKeyAndValue) {
  const IniEntry entry = parseAssignment(" sensor.max_range = 6 m ", "--set");
  EXPECT_EQ(entry.section, "sensor");
  EXPECT_EQ(entry.key, "max_range");
  EXPECT_EQ(entry.value, "6 m");
  EXPECT_EQ(entry.origin, "--set");
}

TEST(ParseAssignment, RefusesOtherForms) {
  for (const char* text :
       {"", "=", "max_range=6", "sensor.=6", ".max_range=6", "sensor.max_range"}) {
    EXPECT_THAT(messageOf([&] { parseAssignment(text, "--set"); }), HasSubstr("section.key=value"))
        << text;
  }
}

}  // namespace
}  // namespace opp::mapping
