// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/table/channel_spec.hpp"

#include <gtest/gtest.h>

namespace tacto::capture {
namespace {

const std::vector<std::string> kColumns = {"lateral_V", "normal_V", "speed mm/s", "F*2", "F",
                                           "x+y",       "F",        "",           "3"};

struct SpecCase {
  const char* text;
  const char* name;
  const char* quantity;
  std::size_t column;
  double scale;
  double offset;
};

class ChannelSpecs : public testing::TestWithParam<SpecCase> {};

TEST_P(ChannelSpecs, AreRead) {
  const SpecCase& target = GetParam();
  const auto spec = parse_channel(target.text, kColumns);
  ASSERT_TRUE(spec) << schema::message(spec.error());
  EXPECT_EQ(spec->name, target.name);
  EXPECT_EQ(spec->quantity, target.quantity);
  EXPECT_EQ(spec->source.column, target.column);
  EXPECT_EQ(spec->source.scale, target.scale);
  EXPECT_EQ(spec->source.offset, target.offset);
}

INSTANTIATE_TEST_SUITE_P(
    All, ChannelSpecs,
    testing::Values(
        SpecCase{"tangential_force=lateral_V*0.444444N", "tangential_force", "tangential_force", 0, 0.444444,
                 0},
        SpecCase{"normal_force=normal_V*-0.31+1.6647N", "normal_force", "normal_force", 1, -0.31, 1.6647},
        SpecCase{"normal_force=2*-0.31-1.6647N", "normal_force", "normal_force", 1, -0.31, -1.6647},
        SpecCase{"normal_force=2*310-5mN", "normal_force", "normal_force", 1, 310 * 1e-3, -5 * 1e-3},
        SpecCase{"position=1*0.5um", "position", "position", 0, 0.5 * 1e-6, 0},
        SpecCase{"position=1*0.5\xC2\xB5m", "position", "position", 0, 0.5 * 1e-6, 0},
        SpecCase{"position=1*5e-1 um", "position", "position", 0, 0.5 * 1e-6, 0},
        SpecCase{"position=1*mm", "position", "position", 0, 1e-3, 0},
        SpecCase{"position=1*1+2mm", "position", "position", 0, 1e-3, 2 * 1e-3},
        SpecCase{"speed=speed mm/s*1mm/s", "speed", "speed", 2, 1e-3, 0},
        SpecCase{"speed= speed mm/s * 1 mm/s ", "speed", "speed", 2, 1e-3, 0},
        SpecCase{"net_force=F*2*3N", "net_force", "net_force", 3, 3, 0},
        SpecCase{"net_force=x+y*3N", "net_force", "net_force", 5, 3, 0},
        SpecCase{"net_force=3*2N", "net_force", "net_force", 8, 2, 0},
        SpecCase{"net_force=8*2N", "net_force", "net_force", 7, 2, 0},
        SpecCase{"signal=1", "signal", "signal", 0, 1, 0},
        SpecCase{"signal=1*2", "signal", "signal", 0, 2, 0},
        SpecCase{"signal=1*2-3", "signal", "signal", 0, 2, -3},
        SpecCase{"signal=F*2", "signal", "signal", 3, 1, 0},
        SpecCase{"left:tangential_force=5*1N", "left", "tangential_force", 4, 1, 0},
        SpecCase{"acceleration=1*9.81m/s^2", "acceleration", "acceleration", 0, 9.81, 0},
        SpecCase{"acceleration=1*1g", "acceleration", "acceleration", 0, 9.80665, 0},
        SpecCase{"acceleration=1*2m/s\xC2\xB2", "acceleration", "acceleration", 0, 2, 0},
        SpecCase{"drive=1*1e1mV", "drive", "drive", 0, 10 * 1e-3, 0}));

struct RefusedSpec {
  const char* text;
  const char* quotes;  // what is wrong, as it was written
  const char* names;   // what would fit
};

class RefusedSpecs : public testing::TestWithParam<RefusedSpec> {};

TEST_P(RefusedSpecs, SayWhatWouldFit) {
  const auto spec = parse_channel(GetParam().text, kColumns);
  ASSERT_FALSE(spec);
  EXPECT_EQ(spec.error().kind, schema::ErrorKind::usage);
  const std::string message = schema::message(spec.error());
  EXPECT_NE(message.find(GetParam().quotes), std::string::npos) << message;
  EXPECT_NE(message.find(GetParam().names), std::string::npos) << message;
  EXPECT_NE(message.find(GetParam().text), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    All, RefusedSpecs,
    testing::Values(RefusedSpec{"position=y*1mm", "'y'", "1 'lateral_V', 2 'normal_V'"},
                    RefusedSpec{"position=0*1mm", "'0'", "'lateral_V'"},
                    RefusedSpec{"position=10*1mm", "'10'", "8, 9 '3'"},
                    RefusedSpec{"position=1x*1mm", "'1x'", "'lateral_V'"},
                    RefusedSpec{"position=*1mm", "''", "'lateral_V'"},
                    RefusedSpec{"net_force=F*1N", "'F'", "1 'lateral_V'"},
                    RefusedSpec{"position=1", "", "nm, um, mm, cm, m"},
                    RefusedSpec{"position=1*0.5", "", "nm, um, mm, cm, m"},
                    RefusedSpec{"position=1*0.5+3", "", "nm, um, mm, cm, m"},
                    RefusedSpec{"position=1*1furlong", "'furlong'", "nm, um, mm, cm, m"},
                    RefusedSpec{"position=1*1N", "'N'", "nm, um, mm, cm, m"},
                    RefusedSpec{"signal=1*2N", "'N'", "1"}, RefusedSpec{"position=1*0mm", "0", ""},
                    RefusedSpec{"position=1**2mm", "", "COLUMN*SCALE"},
                    RefusedSpec{"position=1*nan", "nan", ""}, RefusedSpec{"position=1*1e999mm", "", ""},
                    RefusedSpec{"position=1*1+mm", "", ""}, RefusedSpec{"position", "", "QUANTITY=COLUMN"},
                    RefusedSpec{"place=1*1mm", "'place'", "tangential_force"},
                    RefusedSpec{"a:place=1*1mm", "'place'", "tangential_force"},
                    RefusedSpec{":position=1*1mm", "", ""}));

TEST(ChannelSpec, TwoChannelsOfOneNameAreRefused) {
  const auto specs = parse_channels({"normal_force=1*1N", "normal_force=2*1N"}, kColumns);
  ASSERT_FALSE(specs);
  EXPECT_NE(schema::message(specs.error()).find("'normal_force'"), std::string::npos);
  EXPECT_TRUE(parse_channels({"normal_force=1*1N", "left:normal_force=2*1N"}, kColumns));
}

TEST(ChannelSpec, ATimeColumnIsReadTheSameWay) {
  const auto time = parse_scaled_column("normal_V*1ms", schema::Dimension::time, kColumns);
  ASSERT_TRUE(time);
  EXPECT_EQ(time->column, 1U);
  EXPECT_EQ(time->scale, 1e-3);
  EXPECT_FALSE(parse_scaled_column("normal_V*1mm", schema::Dimension::time, kColumns));
}

const ColumnNames kWithUnits({"Force (mN)", "Weg", "acc", "n", "x / mm"}, {"mN", "mm", "g", "counts", "mm"});

TEST(ColumnUnits, AreTakenWhereNoneIsGiven) {
  const auto force = parse_channel("tangential_force=Force", kWithUnits);
  ASSERT_TRUE(force) << schema::message(force.error());
  EXPECT_EQ(force->source.scale, 1e-3);
  EXPECT_EQ(parse_channel("tangential_force=Force (mN)", kWithUnits)->source.scale, 1e-3);
  EXPECT_EQ(parse_channel("position=x*2", kWithUnits)->source.scale, 2 * 1e-3);
  EXPECT_EQ(parse_channel("position=Weg*1um", kWithUnits)->source.scale, 1e-6);
  EXPECT_EQ(parse_channel("acceleration=acc", kWithUnits)->source.scale, 9.80665);
  EXPECT_EQ(parse_channel("signal=n", kWithUnits)->source.scale, 1);
}

TEST(ColumnUnits, ThatAreNotKnownOrOfAnotherQuantityAreSaid) {
  const auto counts = parse_channel("position=n", kWithUnits);
  ASSERT_FALSE(counts);
  EXPECT_NE(counts.error().what.find("'counts'"), std::string::npos) << counts.error().what;
  const auto force = parse_channel("position=Force", kWithUnits);
  ASSERT_FALSE(force);
  EXPECT_NE(force.error().what.find("'mN'"), std::string::npos) << force.error().what;
}

}  // namespace
}  // namespace tacto::capture
