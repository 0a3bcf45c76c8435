// SPDX-License-Identifier: GPL-3.0-or-later
// Import of tables, read back from disk.
#include <fmt/format.h>

#include "data-schema/files/files.hpp"
#include "tests/capture/import_fixture.hpp"

namespace tacto::capture {
namespace {

TEST_F(ImportTest, NumbersStayAsTheyWereAndScaleGoesToTheSidecar) {
  const auto file = write("t.csv", "f,x\n0.1,0\n-0.3,8\n1e-7,16\n");
  const auto recording = imported(request(file, {"tangential_force=f*0.444444+2mN", "position=x*0.5um"}));
  EXPECT_EQ(stored(recording, 0), (std::vector<double>{0.1, -0.3, 1e-7}));
  EXPECT_EQ(stored(recording, 1), (std::vector<double>{0, 8, 16}));
  const auto& channels = recording.header.channels;
  EXPECT_EQ(channels[0].scale, 0.444444 * 1e-3);
  EXPECT_EQ(channels[0].offset, 2 * 1e-3);
  EXPECT_EQ(channels[0].unit, "N");
  EXPECT_EQ(channels[0].source, "f");
  EXPECT_EQ(channels[1].scale, 0.5 * 1e-6);
  EXPECT_EQ(schema::read_channel(recording, 1)->values[2], 16 * (0.5 * 1e-6));
}

TEST_F(ImportTest, TheSidecarSaysWhereItCameFrom) {
  const auto file = write("t.csv", "f\n1\n2\n");
  auto asked = request(file, {"tangential_force=f*1N"});
  asked.subject = "S07";
  asked.finger = "right index";
  asked.surface = "oak";
  asked.notes = "dry";
  asked.humidity_percent = 45;
  asked.recorded = "2026-03-14";
  asked.calibrated = "2026-03-01";
  const auto header = imported(asked).header;
  EXPECT_EQ(header.source_file, "t.csv");
  EXPECT_EQ(header.source_sha256, *schema::sha256_of_file(file));
  EXPECT_EQ(header.clock, "nominal rate, given at import");
  EXPECT_EQ(header.sample_rate_hz, 1000);
  EXPECT_EQ(header.subject + header.finger + header.surface + header.notes, "S07right indexoakdry");
  EXPECT_EQ(header.humidity_percent, 45);
  EXPECT_EQ(header.recorded, "2026-03-14");
  EXPECT_EQ(header.channels[0].calibrated, "2026-03-01");
}

TEST_F(ImportTest, OneColumnMayGiveTwoChannels) {
  const auto file = write("t.csv", "1,2\n3,4\n");
  const auto recording = imported(request(file, {"b:signal=2", "a:signal=2*3", "signal=1"}));
  EXPECT_EQ(stored(recording, 0), stored(recording, 1));
  EXPECT_EQ(stored(recording, 2), (std::vector<double>{1, 3}));
  EXPECT_EQ(recording.header.channels[0].source, "column 2");
}

TEST_F(ImportTest, LongTablesKeepEveryRowInOrder) {
  std::string text = "f\n";
  for (int i = 0; i < 200000; ++i) text += fmt::format("{}\n", i);
  const auto values = stored(imported(request(write("t.csv", text), {"signal=f"})), 0);
  ASSERT_EQ(values.size(), 200000U);
  for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(values[i], static_cast<double>(i));
}

TEST_F(ImportTest, ATimeColumnGivesRateAndGaps) {
  std::string text = "t_ms;f\n";
  for (int i = 0; i < 100; ++i)
    if (i < 40 || i >= 45) text += fmt::format("{},5;{}\n", i, i);
  auto asked = request(write("t.csv", text), {"tangential_force=f*1mN"});
  asked.rate_hz.reset();
  asked.time_column = "t_ms*1ms";
  const auto header = imported(asked).header;
  EXPECT_EQ(header.sample_rate_hz, 1000);
  EXPECT_EQ(header.frames, 95U);
  ASSERT_EQ(header.gaps.size(), 1U);
  EXPECT_EQ(header.gaps[0].frame, 40U);
  EXPECT_EQ(header.gaps[0].count, 5U);
  EXPECT_EQ(schema::frame_time_s(header, 40), 0.045);
  EXPECT_EQ(header.clock, "times of the source, column 1 ('t_ms')");
  EXPECT_EQ(header.warnings,
            (std::vector<std::string>{"1 gap in the times, 5 frames missing (not filled in)"}));
}

TEST_F(ImportTest, ASpeedChannelIsIntegratedAndSaidSo) {
  const auto file = write("t.csv", "v\n10\n20\n30\n20\n10\n");
  auto asked = request(file, {"speed=v*1mm/s"});
  const auto recording = imported(asked);
  ASSERT_EQ(recording.header.channels.size(), 2U);
  EXPECT_EQ(recording.header.channels[1].derivation, "integrated from speed (trapezoid rule)");
  EXPECT_NEAR(stored(recording, 1)[4], 80e-6, 1e-18);  // (15 + 25 + 25 + 15) mm/s x 1 ms
  EXPECT_NE(recording.header.warnings.at(0).find("no position was measured"), std::string::npos);
  asked.integrate_speed = false;
  asked.replace = true;
  EXPECT_EQ(imported(asked).header.channels.size(), 1U);
}

TEST_F(ImportTest, AMeasuredPositionIsNeverDerived) {
  const auto file = write("t.csv", "v,x\n10,0\n20,1\n");
  EXPECT_EQ(imported(request(file, {"speed=v*1mm/s", "position=x*1mm"})).header.channels.size(), 2U);
}

TEST_F(ImportTest, ASpeedOptionMakesANominalPosition) {
  auto asked = request(write("t.csv", "f\n1\n2\n3\n"), {"tangential_force=f*1N"});
  asked.speed_mps = 0.04;
  const auto recording = imported(asked);
  EXPECT_EQ(recording.header.channels[1].derivation, "nominal: 40 mm/s");
  EXPECT_NEAR(stored(recording, 1)[2], 80e-6, 1e-18);
  EXPECT_EQ(recording.header.warnings.at(0), "no position was measured: it is nominal: 40 mm/s");
}

TEST_F(ImportTest, RangesArePhysicalWhateverTheSignOfTheScale) {
  const auto done = import(request(write("t.csv", "f\n1\n3\n2\n"), {"normal_force=f*-2+1N"}));
  ASSERT_TRUE(done);
  EXPECT_EQ(done->ranges[0].smallest, -5);
  EXPECT_EQ(done->ranges[0].largest, -1);
}

TEST_F(ImportTest, SaysThatItReadDecimalCommas) {
  const auto commas = import(request(write("c.csv", "f;x\n0,5;1,25\n1;2\n"), {"position=x*1mm"}));
  ASSERT_TRUE(commas);
  EXPECT_EQ(commas->format, "table, semicolon, with header, decimal commas");
  EXPECT_EQ(stored(commas->recording, 0), (std::vector<double>{1.25, 2}));
  auto points = request(write("p.csv", "f;x\n0.5;1.25\n"), {"position=x*1mm"});
  points.replace = true;
  EXPECT_EQ(import(points)->format, "table, semicolon, with header");
}

// As Excel saves it with German settings: a title, names, units below them, decimal commas.
TEST_F(ImportTest, UnitsUnderTheNamesAreTheScale) {
  const auto file = write(
      "t.csv", "Messung 7; links\r\n\r\nZeit;Kraft;Weg\r\nms;mN;mm\r\n0,0;1,5;2,5\r\n0,5;2,5;3\r\n1;3;4\r\n");
  auto asked = request(file, {"tangential_force=Kraft", "position=Weg*1um"});
  asked.rate_hz.reset();
  asked.time_column = "Zeit";
  const auto done = import(asked);
  ASSERT_TRUE(done) << schema::message(done.error());
  EXPECT_EQ(done->format,
            "table, semicolon, with header in line 3 (lines before it ignored), units in line 4, decimal "
            "commas");
  const auto& header = done->recording.header;
  EXPECT_EQ(header.sample_rate_hz, 2000);
  EXPECT_EQ(header.channels[0].scale, 1e-3);
  EXPECT_EQ(header.channels[1].scale, 1e-6);  // the option overrides the table
  EXPECT_EQ(stored(done->recording, 0), (std::vector<double>{1.5, 2.5, 3}));
}

TEST_F(ImportTest, LinesMayBeSkipped) {
  auto asked = request(write("t.csv", "7,8\n9,10\nf,x\n1,2\n3,4\n"), {"signal=f"});
  asked.skip_lines = 2;
  EXPECT_EQ(stored(imported(asked), 0), (std::vector<double>{1, 3}));
}

TEST_F(ImportTest, ProgressGrowsToTheEnd) {
  double last = 0;
  const auto done = import_file(request(write("t.csv", "f\n1\n2\n"), {"signal=f"}), [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
  });
  ASSERT_TRUE(done);
  EXPECT_EQ(last, 1);
}

}  // namespace
}  // namespace tacto::capture
