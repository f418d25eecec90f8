// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/parameter_value.h"

#include "opp/geometry/constants.h"

#include "support/random.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace opp::mapping {
namespace {

using testing::HasSubstr;

template <typename Value>
Parameter parameterOf(Value& value, std::string_view unit, double min = -kUnbounded,
                      double max = kUnbounded) {
  return {"s", Field{"key", unit, min, max, "meaning"}, &value};
}

std::string messageOf(const Parameter& parameter, std::string_view text) {
  const std::string before = valueText(parameter);
  std::string message = "no std::invalid_argument";
  try {
    setFromText(parameter, text);
  } catch (const std::invalid_argument& error) {
    message = error.what();
    EXPECT_EQ(valueText(parameter), before) << "a refused text must not change the value";
  }
  return message;
}

TEST(ParameterValue, LengthMayCarryItsUnit) {
  double length = 0.0;
  const Parameter parameter = parameterOf(length, "m", 0.0, 10.0);
  for (const char* text : {"0.05", "0.05 m", "0.05m", " 5e-2  m "}) {
    length = 0.0;
    setFromText(parameter, text);
    EXPECT_EQ(length, 0.05) << text;
  }
  EXPECT_EQ(valueText(parameter), "0.05 m");
}

TEST(ParameterValue, AngleMustCarryItsUnit) {
  double angle = 0.0;
  const Parameter parameter = parameterOf(angle, "rad", 0.0, kPi);
  setFromText(parameter, "90 deg");
  EXPECT_EQ(angle, degToRad(90.0));
  EXPECT_EQ(valueText(parameter), "90 deg");
  setFromText(parameter, "0.25 rad");
  EXPECT_EQ(angle, 0.25);
  EXPECT_EQ(valueText(parameter), "0.25 rad");
  EXPECT_THAT(messageOf(parameter, "10"), HasSubstr("an angle needs its unit, deg or rad"));
  EXPECT_THAT(messageOf(parameter, "10 m"), HasSubstr("'m' is not the unit deg or rad"));
  EXPECT_THAT(messageOf(parameter, "181 deg"), HasSubstr("out of range; allowed: 0 to 180 deg"));
}

TEST(ParameterValue, RefusesBadNumbersAndSaysWhatIsAllowed) {
  double length = 1.0;
  const Parameter parameter = parameterOf(length, "m", 0.5, 10.0);
  EXPECT_THAT(messageOf(parameter, "abc"), HasSubstr("not a number; allowed: 0.5 to 10 m"));
  EXPECT_THAT(messageOf(parameter, ""), HasSubstr("not a number"));
  EXPECT_THAT(messageOf(parameter, "1,5"), HasSubstr("',5' is not the unit m"));
  EXPECT_THAT(messageOf(parameter, "1 cm"), HasSubstr("'cm' is not the unit m"));
  EXPECT_THAT(messageOf(parameter, "0.4"), HasSubstr("out of range"));
  EXPECT_THAT(messageOf(parameter, "1e999"), HasSubstr("out of range"));
  EXPECT_THAT(messageOf(parameter, "nan"), HasSubstr("not a finite number"));
  EXPECT_THAT(messageOf(parameter, "inf"), HasSubstr("not a finite number"));
  double ratio = 0.0;
  EXPECT_THAT(messageOf(parameterOf(ratio, ""), "0.5 x"), HasSubstr("'x' follows a number"));
}

TEST(ParameterValue, IntegersAreWhole) {
  int count = 1;
  const Parameter parameter = parameterOf(count, "", 1, 100);
  setFromText(parameter, "42");
  EXPECT_EQ(count, 42);
  EXPECT_EQ(valueText(parameter), "42");
  for (const char* text : {"3.7", "3.", "1e2", "abc", ""}) {
    EXPECT_THAT(messageOf(parameter, text), HasSubstr("not a whole number")) << text;
  }
  for (const char* text : {"0", "101", "99999999999"}) {
    EXPECT_THAT(messageOf(parameter, text), HasSubstr("out of range; allowed: 1 to 100")) << text;
  }
  EXPECT_THAT(messageOf(parameter, "3 points"), HasSubstr("'points' follows a number"));
}

TEST(ParameterValue, SeedsKeepAll64Bits) {
  std::uint64_t seed = 0;
  const Parameter parameter = parameterOf(seed, "", 0.0);
  setFromText(parameter, "18446744073709551615");
  EXPECT_EQ(seed, std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(valueText(parameter), "18446744073709551615");
  EXPECT_THAT(messageOf(parameter, "-1"), HasSubstr("not a whole number"));
}

TEST(ParameterValue, TruthIsTrueOrFalse) {
  bool flag = false;
  const Parameter parameter = parameterOf(flag, "");
  setFromText(parameter, "true");
  EXPECT_TRUE(flag);
  EXPECT_EQ(valueText(parameter), "true");
  EXPECT_THAT(messageOf(parameter, "1"), HasSubstr("allowed: true or false"));
}

TEST(ParameterValue, TextMayBeQuotedAndHoldsNoQuote) {
  std::string label;
  const Parameter parameter = parameterOf(label, "");
  for (const std::string text : {"", "LIDAR.*", " # blanks and marks ; "}) {
    label = text;
    const std::string written = valueText(parameter);
    label = "other";
    setFromText(parameter, written);
    EXPECT_EQ(label, text);
  }
  setFromText(parameter, "bare");
  EXPECT_EQ(label, "bare");
  EXPECT_THAT(messageOf(parameter, "a\"b"), HasSubstr("a quote inside text"));
  label = "line\nend";
  EXPECT_THROW(valueText(parameter), std::invalid_argument);
}

TEST(ParameterValue, EveryDoubleRoundTripsBitForBit) {
  test::Random random(3);
  double value = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const double number = random.normal() * std::pow(10.0, random.integer(-30, 30));
    for (const std::string_view unit : {"m", "rad", ""}) {
      const Parameter parameter = parameterOf(value, unit);
      value = number;
      const std::string text = valueText(parameter);
      value = 0.0;
      setFromText(parameter, text);
      EXPECT_EQ(value, number) << text;
    }
  }
}

TEST(RangeText, NamesTheBoundsThatThereAre) {
  double value = 0.0;
  EXPECT_EQ(rangeText(parameterOf(value, "m", 0.0, 1.0)), "0 to 1 m");
  EXPECT_EQ(rangeText(parameterOf(value, "s", 0.0)), "at least 0 s");
  EXPECT_EQ(rangeText(parameterOf(value, "", -kUnbounded, 2.0)), "at most 2");
  EXPECT_EQ(rangeText(parameterOf(value, "rad", 0.0, kPi / 2)), "0 to 90 deg");
  EXPECT_EQ(rangeText(parameterOf(value, "")), "any number");
}

}  // namespace
}  // namespace opp::mapping
