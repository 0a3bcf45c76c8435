// SPDX-License-Identifier: GPL-3.0-or-later
// A recording's journal: it reads back as written, and a broken line does not affect others.
#include "data-schema/recording/recording_events.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::schema {
namespace {

using tests::TemporaryFolder;

std::string first_line() {
  RecordingHeader header;
  header.wav_file = "oak.wav";
  header.sample_rate_hz = 10000;
  Channel channel;
  channel.name = channel.quantity = "tangential_force";
  channel.unit = "N";
  header.channels = {channel};
  header.clock = "device";
  header.created = "2026-11-21T22:29:33Z";
  header.creator = "a test";
  return begin_line(header).value();
}

EventLog log_of(const std::string& lines) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.events.jsonl", std::ios::binary) << first_line() << lines;
  auto log = read_events(folder / "a.events.jsonl");
  EXPECT_TRUE(log) << message(log.error());
  return log ? *log : EventLog{};
}

const std::string kWhole = event_line(Gap{10, 12, 2}) + event_line(Mark{11, "knock"}) +
                           event_line(ClockPair{13, 0.5, 0.75}) + event_line(FaultNote{14, "hot"});

TEST(RecordingEvents, ComeBackAsTheyWereWritten) {
  const EventLog log = log_of(kWhole);
  EXPECT_EQ(log.cut_line, "");
  ASSERT_EQ(log.header.gaps.size(), 1U);
  EXPECT_EQ(log.header.gaps[0].frame, 10U);
  EXPECT_EQ(log.header.gaps[0].device_sequence, 12U);
  EXPECT_EQ(log.header.gaps[0].count, 2U);
  ASSERT_EQ(log.header.marks.size(), 1U);
  EXPECT_EQ(log.header.marks[0].label, "knock");
  ASSERT_EQ(log.header.clock_pairs.size(), 1U);
  EXPECT_EQ(log.header.clock_pairs[0].host_s, 0.75);
  ASSERT_EQ(log.header.faults.size(), 1U);
  EXPECT_EQ(log.header.faults[0].what, "hot");
}

// A killed process cuts the last line; a bad disk may destroy any line.
TEST(RecordingEvents, AreReadPastALineThatIsNone) {
  for (const std::string line :
       {R"({"event": "gap", "frame": 10, "device_sequence": 12, "co`nt": 2})",
        R"({"event": "mark", "frame": 1})", R"({"event": "clock"})",
        R"({"event": "fault", "frame": 1, "what": 7})", R"({"event": 5})", "[]", "7", "",
        R"({"event": "gap", "frame": "ten", "device_sequence": 12, "count": 2})"}) {
    const EventLog log = log_of(kWhole + line + "\n" + event_line(Mark{15, "after"}));
    EXPECT_EQ(log.cut_line, "");
    EXPECT_EQ(log.bad_lines, 1U);
    EXPECT_EQ(log.first_bad_line, 6U);
    ASSERT_EQ(log.header.marks.size(), 2U) << line;
    EXPECT_EQ(log.header.marks[1].label, "after");
    EXPECT_EQ(log.header.gaps.size(), 1U) << line;
  }
  EXPECT_EQ(log_of(kWhole + R"({"event": "mar)").cut_line, R"({"event": "mar)");
}

TEST(RecordingEvents, OfANewerVersionArePassedOver) {
  EXPECT_EQ(log_of("{\"event\": \"smell\"}\n" + kWhole).header.marks.size(), 1U);
}

}  // namespace
}  // namespace tacto::schema
