// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/table/csv_number.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

#include "capture/table/plain_decimal.hpp"

namespace tacto::capture {
namespace {

double number(const std::string& field, char mark = 0) {
  double value = 0;
  EXPECT_EQ(read_number(field, mark, value), NumberFault::none) << field;
  return value;
}

NumberFault fault(const std::string& field, char mark = 0) {
  double value = 0;
  return read_number(field, mark, value);
}

TEST(CsvNumber, ReadsWhatOtherProgramsWrite) {
  EXPECT_EQ(number("12"), 12);
  EXPECT_EQ(number(" -1.5e-3\t"), -1.5e-3);
  EXPECT_EQ(number("+7"), 7);
  EXPECT_EQ(number(".5"), 0.5);
  EXPECT_EQ(number("5."), 5);
  EXPECT_EQ(number("1E+06"), 1e6);
  EXPECT_EQ(number("0,25"), 0.25);
  EXPECT_EQ(number("-1,5E-3"), -1.5e-3);
}

TEST(CsvNumber, RoundsAsTheCLibraryDoes) {
  std::mt19937_64 bits(1);
  for (int i = 0; i < 20000; ++i) {
    std::array<char, 40> text{};
    const auto digits = static_cast<int>(bits() % 20 + 1);
    const double value = std::ldexp(static_cast<double>(bits()), static_cast<int>(bits() % 200) - 150);
    std::snprintf(text.data(), text.size(), "%.*e", digits, value);
    EXPECT_EQ(number(text.data()), std::strtod(text.data(), nullptr)) << text.data();
  }
}

TEST(PlainDecimal, IsExactUpToFifteenDigits) {
  std::mt19937_64 bits(2);
  for (int i = 0; i < 100000; ++i) {
    std::string text = std::to_string(bits() % 1000000000000000 >> (bits() % 48));
    text.insert(bits() % (text.size() + 1), ".");
    if (bits() % 2 == 0) text.insert(0, "-");
    const auto number = read_plain_decimal(text.data(), text.data() + text.size());
    ASSERT_EQ(number.stop, text.data() + text.size()) << text;
    ASSERT_EQ(number.value, std::strtod(text.c_str(), nullptr)) << text;
    ASSERT_TRUE(number.point);
  }
}

TEST(PlainDecimal, LeavesOtherNumbersAlone) {
  for (const std::string text :
       {"1234567890123456", "0.123456789012345", "1e5", "1.5E-3", "", "-", ".", "-.", "+1", "nan"})
    EXPECT_EQ(read_plain_decimal(text.data(), text.data() + text.size()).stop, nullptr) << text;
  const std::string stops = "-5.,7";
  EXPECT_EQ(read_plain_decimal(stops.data(), stops.data() + stops.size()).stop, stops.data() + 3);
}

TEST(CsvNumber, CommaAndPointAgreeToTheBit) {
  for (const std::string text : {"0.1", "123456.789", "-2.2250738585072014e-308", "1.7976931348623157e308"}) {
    std::string comma = text;
    comma[comma.find('.')] = ',';
    EXPECT_EQ(number(comma), number(text)) << text;
  }
}

TEST(CsvNumber, TheFirstMarkIsTheFiles) {
  char mark = 0;
  double value = 0;
  EXPECT_EQ(read_number("3", mark, value), NumberFault::none);
  EXPECT_EQ(mark, 0);
  EXPECT_EQ(read_number("3,5", mark, value), NumberFault::none);
  EXPECT_EQ(mark, ',');
  EXPECT_EQ(read_number("3.5", mark, value), NumberFault::mixed_marks);
}

TEST(CsvNumber, NamesWhatIsNoNumber) {
  for (const char* text : {"nan", "NaN", "-nan", "NAN(0x1)", "1.#QNAN", "-1.#IND", "1.#SNAN"})
    EXPECT_EQ(fault(text), NumberFault::nan) << text;
  for (const char* text : {"inf", "-Inf", "+INFINITY", "1.#INF"})
    EXPECT_EQ(fault(text), NumberFault::infinite) << text;
  for (const char* text : {"", "   ", "\t"}) EXPECT_EQ(fault(text), NumberFault::missing) << text;
  EXPECT_EQ(fault("1e999"), NumberFault::too_large);
  EXPECT_EQ(fault("1,5e999"), NumberFault::too_large);
  for (const char* text : {"four", "1.2.3", "1,2,3", "1.234,5", "1 2", "0x10", "--1", "+-1", "+", "-", ".",
                           ",", "1e", "12N", "infinite", "1;2"})
    EXPECT_EQ(fault(text), NumberFault::text) << text;
}

}  // namespace
}  // namespace tacto::capture
