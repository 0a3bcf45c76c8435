// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/gain.hpp"

#include <gtest/gtest.h>

#include <array>

#include <string>
#include "data-schema/base/column_unit.hpp"

namespace tacto::schema {
namespace {

TEST(Gain, IsAFactorOfTheDefaultOrDisplacementForForce) {
  constexpr double kDefault = -4e-4;
  const std::pair<const char*, double> kForms[] = {{"2x", -8e-4},    {"200%", -8e-4},  {"-0.5x", 2e-4},
                                                   {"1e1 %", -4e-5}, {"2mm/N", 2e-3},  {"-300 um/N", -3e-4},
                                                   {"0x", 0},        {"+1.5x", -6e-4}, {"1e-3m/N", 1e-3}};
  for (const auto& [text, gain_m_per_n] : kForms) {
    const auto gain = parse_gain(text);
    ASSERT_TRUE(gain) << text;
    EXPECT_NEAR(gain->m_per_n(kDefault), gain_m_per_n, 1e-18) << text;  // a rounding or two of 1e-3
  }
}

TEST(Gain, NothingElseIsAGain) {
  for (const char* text : {"", "2", "x", "%", "2xx", "nanx", "inf%", "2mm", "2N", "2x/N", "two x", "0x10"}) {
    const auto gain = parse_gain(text);
    ASSERT_FALSE(gain) << text;
    EXPECT_EQ(gain.error().kind, ErrorKind::usage) << text;
  }
}

// What a message names as the largest gain, is not larger than it in either form.
TEST(Gain, InWordsIsReadBackAndNotLarger) {
  for (const double gain_m_per_n : {1.73999e-3, 9.9999e-4, 3.00001e-5, 0.25})
    for (const double usual_m_per_n : {1e-3, 7e-4}) {
      const std::string words = gain_in_words(gain_m_per_n, usual_m_per_n);
      const auto open = words.find(" (");
      for (const std::string& form :
           {words.substr(0, open), words.substr(open + 2, words.size() - open - 3)}) {
        const auto read = parse_gain(form);
        ASSERT_TRUE(read) << words;
        EXPECT_LE(read->m_per_n(usual_m_per_n), gain_m_per_n * (1 + 1e-15)) << words;
        EXPECT_GT(read->m_per_n(usual_m_per_n), gain_m_per_n * (1 - 1.001e-3)) << words;  // four digits
      }
    }
  EXPECT_EQ(gain_in_words(1e-3, 0).find('x'), std::string::npos);
}

TEST(ColumnUnit, IsInBracketsAfterASlashOrAfterAnUnderline) {
  const std::array<std::string, 3> kNames[] = {{"Force (N)", "Force", "N"},
                                               {"Weg [mm]", "Weg", "mm"},
                                               {"F / N", "F", "N"},
                                               {"position_mm", "position", "mm"},
                                               {"time_s", "time", "s"},
                                               {"normal_force_n", "normal_force", "N"},
                                               {"speed_mps", "speed", "m/s"},
                                               {"drive_v", "drive", "V"},
                                               {"encoder_count", "encoder_count", ""},
                                               {"position", "position", ""},
                                               {"_mm", "_mm", ""},
                                               {"ch_1", "ch_1", ""},
                                               {"force_mN", "force", "mN"},
                                               {"x_um", "x", "um"},
                                               {"rate_hz", "rate", "Hz"},
                                               {"speed_cm_per_s", "speed", "cm/s"},
                                               {"speed_mm_s", "speed", "mm/s"}};
  for (const auto& [text, name, unit] : kNames) {
    const auto split = split_unit(text);
    EXPECT_EQ(split.name, name) << text;
    EXPECT_EQ(split.unit, unit) << text;
  }
}

}  // namespace
}  // namespace tacto::schema
