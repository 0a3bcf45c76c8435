// SPDX-License-Identifier: GPL-3.0-or-later
// Strokes of sessions with missing ticks or missing counts, and the contents of a session's table.
#include <fmt/format.h>

#include <fstream>

#include "data-schema/session/session_writer.hpp"
#include "playback/session/session_export.hpp"
#include "playback/strokes/stroke_report.hpp"
#include "tests/playback/player_on_sim.hpp"

namespace tacto::playback {
namespace {

using schema::SessionTick;
using Ticks = std::vector<SessionTick>;

/// A session played for 3 s, 0.75 s per stroke, whose ticks are then changed.
class SessionStrokes : public PlayerOnSim {
 protected:
  void SetUp() override {
    PlayerOnSim::SetUp();
    begin();
    ASSERT_TRUE(player_->play());
    run(3);
    ASSERT_TRUE(player_->disarm());
  }
  StrokeReport report_of(const std::string& session) {
    auto report = report_strokes(session);
    EXPECT_TRUE(report) << schema::message(report.error());
    return std::move(*report);
  }
  /// The session with the ticks `kept`; from a missing one on it reports a loss.
  std::string with_ticks(const Ticks& kept, std::uint64_t lost) {
    const std::string to = folder_ / fmt::format("changed-{}.session", ++changed_);
    auto reader = schema::SessionReader::open(session_);
    auto writer = schema::SessionWriter::create(to, reader->header());
    while (auto block = reader->next())
      if (const auto* command = std::get_if<schema::SessionCommand>(&*block)) writer->add(*command);
    add_runs(*writer, kept);
    EXPECT_TRUE(writer->close({kept.size(), lost, 0}));
    return to;
  }
  static bool noted(const StrokeReport& report, const std::string& words) {
    return std::ranges::any_of(
        report.notes, [&](const std::string& note) { return note.find(words) != std::string::npos; });
  }

 private:
  static void add_runs(schema::SessionWriter& writer, const Ticks& kept) {
    for (auto from = kept.begin(); from != kept.end();) {
      const auto to = std::adjacent_find(from, kept.end(),
                                         [](const auto& a, const auto& b) { return b.tick != a.tick + 1; });
      const auto end = to == kept.end() ? to : to + 1;
      EXPECT_TRUE(writer.add(std::span(from, end)));
      from = end;
    }
  }
  int changed_ = 0;
};

// Judged as in the whole session. Values beyond the loss are missing in the band's filters: 0.2 s away from
// it, for edges of 3 and 5 Hz, the effect is 0.004 dB here.
constexpr double kBeyondTheLossDb = 0.02;

TEST_F(SessionStrokes, BeforeTheFirstLossAreJudged) {
  const StrokeReport whole = report_of(session_);
  ASSERT_GE(whole.strokes.size(), 4U);
  Ticks kept = ticks();
  const auto lost_from = static_cast<std::uint64_t>((whole.strokes[1].to_s + 0.2) * kRateHz);
  const std::uint64_t lost = 20;
  std::erase_if(
      kept, [&](const SessionTick& tick) { return tick.tick >= lost_from && tick.tick < lost_from + lost; });
  const StrokeReport cut = report_of(with_ticks(kept, lost));
  ASSERT_EQ(cut.strokes.size(), 2U) << "the third is in it";
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(cut.strokes[i].from_m, whole.strokes[i].from_m);
    EXPECT_EQ(cut.strokes[i].to_s, whole.strokes[i].to_s);
    EXPECT_NEAR(cut.strokes[i].predicted.error_db, whole.strokes[i].predicted.error_db, kBeyondTheLossDb);
    EXPECT_NEAR(cut.strokes[i].predicted.level_db, whole.strokes[i].predicted.level_db, kBeyondTheLossDb);
  }
  EXPECT_TRUE(noted(cut, fmt::format("20 ticks are missing, from tick {} on", lost_from)));
}

TEST_F(SessionStrokes, WithTheFirstTickMissingNoneIs) {
  Ticks kept = ticks();
  kept.erase(kept.begin());
  const StrokeReport cut = report_of(with_ticks(kept, 1));
  EXPECT_TRUE(cut.strokes.empty());
  EXPECT_TRUE(noted(cut, "1 ticks are missing, from tick 0 on"));
}

// As after a stall of the computer, when the counts of that time are delivered: a distance of 12 mm in 6 ms.
TEST_F(SessionStrokes, EndWhereTicksAreBlind) {
  const StrokeReport whole = report_of(session_);
  const PlayedStroke& stroke = whole.strokes.at(1);
  const auto middle = static_cast<std::size_t>((stroke.from_s + stroke.to_s) / 2 * kRateHz);
  Ticks all = ticks();
  for (std::size_t i = 0; i < 12; ++i) {
    SessionTick& tick = all.at(middle + i);
    tick.flags |= wire::kTickBlind;
    tick.encoder += static_cast<std::int32_t>(1000 * (i + 1));
  }
  const StrokeReport blind = report_of(with_ticks(all, 0));
  ASSERT_EQ(blind.stroke_count, whole.stroke_count + 1) << "one is two now";
  const PlayedStroke &before = blind.strokes[1], &after = blind.strokes[2];
  EXPECT_NEAR(before.to_s, static_cast<double>(middle - 1) / kRateHz, 1e-6);
  EXPECT_NEAR(after.from_s, static_cast<double>(middle + 12) / kRateHz, 1e-6);
  EXPECT_EQ(before.from_m, stroke.from_m);
  EXPECT_EQ(after.to_m, stroke.to_m);
  EXPECT_TRUE(noted(blind, "in 12 ticks no encoder count had come"));
}

// A count of 1 um at a distance of 100 m.
TEST_F(SessionStrokes, ATableHoldsEachCountsPlace) {
  Ticks all = ticks();
  const double metres_per_count = schema::SessionReader::open(session_)->header().metres_per_count;
  const auto far = static_cast<std::int32_t>(std::lround(100 / metres_per_count));
  for (SessionTick& tick : all) tick.encoder += far;
  const std::string csv = folder_ / "far.csv";
  ASSERT_TRUE(export_session(with_ticks(all, 0), csv, schema::Existing::keep));
  std::ifstream lines(csv);
  std::string line;
  std::getline(lines, line);
  std::getline(lines, line);
  std::vector<std::string> cells;
  for (std::istringstream rest(line); std::getline(rest, line, ',');) cells.push_back(line);
  EXPECT_NEAR(std::stod(cells.at(3)), metres_per_count * (std::stod(cells.at(2)) + 0.5), 1e-9);
}

}  // namespace
}  // namespace tacto::playback
