// SPDX-License-Identifier: GPL-3.0-or-later
// Strokes as the tray's sensor measured them, on a bender with a hysteresis that is not in the transducer's
// file.
#include <functional>

#include "data-schema/session/session_writer.hpp"
#include "playback/strokes/stroke_report.hpp"
#include "tests/playback/player_on_sim.hpp"

namespace tacto::playback {
namespace {

using schema::SessionSamples;

class MeasuredStrokes : public PlayerOnSim {
 protected:
  void play_on(const std::string& parameters, const std::string& name) {
    player_.reset();
    parameters_ = parameters;
    PlayerOnSim::SetUp();
    session_ = folder_ / (name + ".session");
    begin();
    ASSERT_TRUE(player_->play());
    run(3);
    ASSERT_TRUE(player_->disarm());
  }
  void SetUp() override { play_on("tray_sensor=on,hysteresis=0.16", "seen"); }
  StrokeReport report_of(const std::string& session) {
    auto report = report_strokes(session);
    EXPECT_TRUE(report) << schema::message(report.error());
    return std::move(*report);
  }
  /// The session with each of its samples modified by `change`, which may omit it.
  std::string changed(const std::function<bool(SessionSamples&)>& change) {
    const std::string to = folder_ / ("changed-" + std::to_string(++changed_) + ".session");
    auto reader = schema::SessionReader::open(session_);
    auto writer = schema::SessionWriter::create(to, reader->header());
    std::uint64_t ticks = 0;
    while (auto block = reader->next()) {
      if (const auto* command = std::get_if<schema::SessionCommand>(&*block)) writer->add(*command);
      if (const auto* some = std::get_if<std::vector<schema::SessionTick>>(&*block))
        writer->add(*some), ticks += some->size();
      if (const auto* samples = std::get_if<SessionSamples>(&*block)) add_each(*writer, *samples, change);
    }
    EXPECT_TRUE(writer->close({ticks, 0, 0}));
    return to;
  }

 private:
  static void add_each(schema::SessionWriter& writer, const SessionSamples& samples,
                       const std::function<bool(SessionSamples&)>& change) {
    for (std::size_t i = 0; i < samples.codes.size(); ++i) {
      const auto later_ns = static_cast<std::int64_t>(1e9 * static_cast<double>(i) / kRateHz);
      SessionSamples one{samples.first_frame + i, samples.time_ns + later_ns, {samples.codes[i]}};
      if (change(one)) writer.add(one);
    }
  }
  int changed_ = 0;
};

// The tray has a hysteresis that the model does not contain: for 16 % the error is about -10 dB
// (tests/MEASURED.md, row e).
TEST_F(MeasuredStrokes, TellAHysteresisThatTheModelDoesNotKnow) {
  const StrokeReport seen = report_of(session_);
  ASSERT_GE(seen.strokes.size(), 3U);
  for (const PlayedStroke& stroke : seen.strokes) {
    ASSERT_TRUE(stroke.measured);
    EXPECT_LT(stroke.predicted.error_db, -20);
    EXPECT_GT(stroke.measured->error_db, -13);
    EXPECT_LT(stroke.measured->error_db, -9);
  }
  expect_same_to_the_bit();
}

// The sensor does not change the playback; without a hysteresis it measures the prediction.
TEST_F(MeasuredStrokes, AreThoseOfTheModelWhereItIsRight) {
  play_on("", "plain");
  const auto plain = ticks();
  const StrokeReport unseen = report_of(session_);
  play_on("tray_sensor=on", "linear");
  EXPECT_EQ(ticks(), plain);
  const StrokeReport seen = report_of(session_);
  ASSERT_EQ(seen.strokes.size(), unseen.strokes.size());
  for (std::size_t i = 0; i < seen.strokes.size(); ++i) {
    EXPECT_FALSE(unseen.strokes[i].measured);
    EXPECT_EQ(unseen.strokes[i].predicted.error_db, seen.strokes[i].predicted.error_db);
    ASSERT_TRUE(seen.strokes[i].measured);
    // The sensor's noise of 20 nm is -51 dB of these 7 um.
    EXPECT_NEAR(seen.strokes[i].measured->rms_m / seen.strokes[i].predicted.rms_m, 1, 5e-3);
    EXPECT_LT(seen.strokes[i].measured->error_db, seen.strokes[i].predicted.error_db + 1);
  }
}

TEST_F(MeasuredStrokes, AnInstrumentThatIsLateIsShiftedBack) {
  const StrokeReport whole = report_of(session_);
  constexpr double kLateS = 0.4e-3;
  const StrokeReport late = report_of(changed([](SessionSamples& sample) {
    sample.time_ns += static_cast<std::int64_t>(1e9 * kLateS);
    return true;
  }));
  for (std::size_t i = 0; i < whole.strokes.size(); ++i) {
    ASSERT_TRUE(late.strokes[i].measured);
    EXPECT_NEAR(*late.strokes[i].measured->shift_s - *whole.strokes[i].measured->shift_s, kLateS, 2e-6);
    EXPECT_NEAR(late.strokes[i].measured->error_db, whole.strokes[i].measured->error_db, 0.05);
  }
}

// The search goes to 1 ms; the smallest error is then at its end, and no shift is given.
TEST_F(MeasuredStrokes, AShiftBeyondTheSearchIsNotFound) {
  const StrokeReport whole = report_of(session_);
  constexpr double kBeyondS = 1.15e-3;
  const double late_s = kBeyondS - *whole.strokes.front().measured->shift_s;
  const StrokeReport late = report_of(changed([&](SessionSamples& sample) {
    sample.time_ns += static_cast<std::int64_t>(1e9 * late_s);
    return true;
  }));
  ASSERT_TRUE(late.strokes.front().measured);
  EXPECT_FALSE(late.strokes.front().measured->shift_s);
  EXPECT_TRUE(late.strokes.front().predicted.shift_s);
}

TEST_F(MeasuredStrokes, AreNotToldNearMissingSamples) {
  const StrokeReport whole = report_of(session_);
  ASSERT_GE(whole.strokes.size(), 4U);
  const auto middle =
      static_cast<std::uint64_t>((whole.strokes[1].from_s + whole.strokes[1].to_s) / 2 * kRateHz);
  const StrokeReport holed = report_of(changed([&](const SessionSamples& sample) {
    return sample.first_frame < middle || sample.first_frame >= middle + 10;
  }));
  EXPECT_FALSE(holed.strokes[1].measured);
  EXPECT_TRUE(holed.strokes[0].measured);
  ASSERT_TRUE(holed.strokes[3].measured);
  EXPECT_NEAR(holed.strokes[3].measured->error_db, whole.strokes[3].measured->error_db, 0.01);
  EXPECT_TRUE(std::ranges::any_of(holed.notes, [](const std::string& note) {
    return note.find("1 of") != std::string::npos && note.find("sensor") != std::string::npos;
  }));
  const StrokeReport none = report_of(changed([](const SessionSamples&) { return false; }));
  for (const PlayedStroke& stroke : none.strokes) EXPECT_FALSE(stroke.measured);
}

}  // namespace
}  // namespace tacto::playback
