// SPDX-License-Identifier: GPL-3.0-or-later
// Quantities as people write them.
#include "data-schema/base/quantity.hpp"

#include <gtest/gtest.h>

namespace tacto::schema {
namespace {

void expect_si(std::string_view text, Dimension dimension, double si) {
  const auto value = parse_quantity(text, dimension);
  ASSERT_TRUE(value) << message(value.error());
  EXPECT_DOUBLE_EQ(*value, si) << text;
}

void expect_refused(std::string_view text, Dimension dimension) {
  const auto value = parse_quantity(text, dimension);
  ASSERT_FALSE(value) << text << " was read as " << *value;
  EXPECT_EQ(value.error().kind, ErrorKind::usage);
  EXPECT_NE(value.error().what.find("'" + std::string(text) + "'"), std::string::npos)
      << message(value.error());
  EXPECT_NE(value.error().remedy.find(units_of(dimension)), std::string::npos) << message(value.error());
}

TEST(Quantity, ReadsPrefixesAndExponents) {
  expect_si("10mm", Dimension::length, 0.01);
  expect_si("1e-3m", Dimension::length, 1e-3);
  expect_si(" -2.5 cm ", Dimension::length, -0.025);
  expect_si("+15Hz", Dimension::frequency, 15);
  expect_si("10kHz", Dimension::frequency, 1e4);
  expect_si("4.5s", Dimension::time, 4.5);
  expect_si("50mm/s", Dimension::speed, 0.05);
  expect_si("1mm/N", Dimension::compliance, 1e-3);
  expect_si("9.81 m/s^2", Dimension::acceleration, 9.81);
}

TEST(Quantity, ReadsBothMicroSigns) {
  expect_si("0.5\u00B5m", Dimension::length, 0.5e-6);
  expect_si("0.5\u03BCm", Dimension::length, 0.5e-6);
  expect_si("0.5um", Dimension::length, 0.5e-6);
  expect_si("3 \u00B5m/N", Dimension::compliance, 3e-6);
}

TEST(Quantity, ReadsSpatialFrequencyInEverySpelling) {
  expect_si("15/mm", Dimension::spatial_frequency, 15e3);
  expect_si("1/mm", Dimension::spatial_frequency, 1e3);
  expect_si("15 1/mm", Dimension::spatial_frequency, 15e3);
  expect_si("15 mm^-1", Dimension::spatial_frequency, 15e3);
}

TEST(Quantity, TakesBareNumbersOnlyWhereThereIsNoUnit) {
  expect_si("5", Dimension::none, 5);
  expect_refused("5", Dimension::length);
  expect_refused("15", Dimension::spatial_frequency);
}

TEST(Quantity, RefusesUnitsOfOtherQuantities) {
  expect_refused("5mm", Dimension::time);
  expect_refused("5mm/s", Dimension::length);
  expect_refused("5furlong", Dimension::length);
  expect_refused("5MM", Dimension::length);
}

TEST(Quantity, RefusesWhatIsNoFiniteNumber) {
  for (const char* text :
       {"infmm", "-infmm", "nanmm", "1e400mm", "", "mm", "--5mm", "+-5mm", "++5mm", "five mm"})
    expect_refused(text, Dimension::length);
  expect_refused("1,5mm", Dimension::length);
  expect_refused("0x10m", Dimension::length);
}

TEST(Quantity, FindsUnitsInAnyDimension) {
  const auto unit = parse_unit("\u00B5m");
  ASSERT_TRUE(unit);
  EXPECT_EQ(unit->dimension, Dimension::length);
  EXPECT_DOUBLE_EQ(unit->si, 1e-6);
  EXPECT_EQ(parse_unit("1")->dimension, Dimension::none);
  ASSERT_FALSE(parse_unit("furlong"));
  EXPECT_NE(parse_unit("furlong").error().remedy.find("mm/s"), std::string::npos);
}

// The standard acceleration of gravity: 9.80665 m/s^2 exactly (3rd CGPM, 1901).
TEST(Quantity, OneSymbolMayBeAMassAndAnAcceleration) {
  EXPECT_EQ(*parse_quantity("2g", Dimension::acceleration), 2 * 9.80665);
  EXPECT_DOUBLE_EQ(*parse_quantity("500mg", Dimension::acceleration), 4.903325);
  EXPECT_DOUBLE_EQ(*parse_quantity("2g", Dimension::mass), 2e-3);
  EXPECT_DOUBLE_EQ(*parse_quantity("500mg", Dimension::mass), 5e-4);
  expect_refused("2g", Dimension::length);
  EXPECT_EQ(parse_unit("g")->dimension, Dimension::mass);
  EXPECT_EQ(for_people(0.002, Dimension::mass), "2 g");
  EXPECT_EQ(for_people(9.80665, Dimension::acceleration), "9.807 m/s^2");
  EXPECT_EQ(units_of(Dimension::acceleration), "mm/s^2, m/s^2, mg, g");
}

TEST(Quantity, WritesForPeopleWhatItReadsBack) {
  EXPECT_EQ(for_people(0.0123, Dimension::length), "12.3 mm");
  EXPECT_EQ(for_people(0.99999e-6, Dimension::length), "1 um");
  EXPECT_EQ(for_people(0.9998e-6, Dimension::length), "999.8 nm");
  EXPECT_EQ(for_people(15e3, Dimension::spatial_frequency), "15/mm");
  EXPECT_EQ(for_people(-0.25, Dimension::force), "-250 mN");
  for (const double si : {1e-9, 3.3e-5, 0.5, 12.0, 999.0}) {
    const auto back = parse_quantity(for_people(si, Dimension::length), Dimension::length);
    ASSERT_TRUE(back);
    EXPECT_NEAR(*back, si, 5e-4 * si);  // four digits
  }
}

// The key of a report ends in the unit of its value, and the ending gives that unit again.
TEST(Quantity, AnEndingOfAKeyIsItsUnit) {
  for (const auto& [symbol, key] : {std::pair{"N", "rms_n"},
                                    {"m", "rms_m"},
                                    {"V", "rms_v"},
                                    {"m/s", "rms_mps"},
                                    {"m/s^2", "rms_mps2"},
                                    {"Hz", "rms_hz"},
                                    {"s", "rms_s"}}) {
    EXPECT_EQ(key_in("rms", symbol), key);
    const auto unit = unit_with_ending(std::string_view(key).substr(3));
    ASSERT_TRUE(unit) << key;
    EXPECT_EQ(unit->symbol, symbol);
    EXPECT_EQ(unit->si, 1);
  }
  EXPECT_EQ(unit_with_ending("_khz")->si, 1e3);
  EXPECT_EQ(unit_with_ending("_mn")->si, 1e-3);
  EXPECT_EQ(unit_with_ending("_m_per_n")->dimension, Dimension::compliance);
  for (const char* none : {"1", "counts", ""}) EXPECT_EQ(key_in("rms", none), "rms");
  EXPECT_FALSE(unit_with_ending("_1"));
}

}  // namespace
}  // namespace tacto::schema
