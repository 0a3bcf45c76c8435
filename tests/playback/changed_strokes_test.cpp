// SPDX-License-Identifier: GPL-3.0-or-later
// Strokes of a session in which the texture changes: what was wanted in each, before, in and after the
// change.
#include <fmt/format.h>

#include <functional>

#include "data-schema/session_writer.hpp"
#include "playback/daemon/stroke_report.hpp"
#include "tests/playback/player_on_sim.hpp"

namespace tacto::playback {
namespace {

using schema::SessionChange;

/// A session read and written again, what it says of changes as `keep` makes it; false leaves it out.
class Rewriting {
 public:
  Rewriting(const std::string& from, const std::string& to)
      : reader_(std::move(*schema::SessionReader::open(from))),
        writer_(std::move(*schema::SessionWriter::create(to, reader_.header()))) {}
  void all(const std::function<bool(SessionChange&)>& keep) {
    while (auto block = reader_.next()) {
      auto* change = std::get_if<SessionChange>(&*block);
      if (change == nullptr || keep(*change)) std::visit([this](const auto& part) { add(part); }, *block);
    }
  }

 private:
  void add(const std::vector<schema::SessionTick>& ticks) { EXPECT_TRUE(writer_.add(ticks)); }
  void add(const schema::SessionEnd& end) { EXPECT_TRUE(writer_.close(end)); }
  template <class Part>
  void add(const Part& part) {
    EXPECT_TRUE(writer_.add(part));
  }
  schema::SessionReader reader_;
  schema::SessionWriter writer_;
};

/// 30 mm there and back in 1.5 s, so that a stroke takes 0.75 s. In the second the grating gives way to the
/// fine one, in the fourth that to the grating upside down; the gain is turned in the first and the third.
class StrokesOverChanges : public PlayerOnSim {
 protected:
  // A finger that turns gently: at a corner, looking ahead errs by more than all else.
  void SetUp() override {
    PlayerOnSim::SetUp();
    device_->board().set_script([](double t) { return 17e-3 - 15e-3 * std::cos(kTwoPi * t / 1.5); });
  }
  void play_with_changes(double fade_s = kUsualFadeS) {
    begin();
    ASSERT_TRUE(player_->play());
    run(0.4);
    ASSERT_TRUE(player_->gain(0.5));
    run(0.7);
    ASSERT_TRUE(player_->load(program("fine", 8e-4), fade_s));
    run(0.8);
    ASSERT_TRUE(player_->gain(0.9));
    run(0.7);
    ASSERT_TRUE(player_->load(program("grating", -5e-4), fade_s));
    run(1.3);
    ASSERT_TRUE(player_->disarm());
  }
  /// The worst error of a whole stroke of one program, dB; the first is left out, for the onset is in it.
  double worst_error_alone(Program played, double factor) {
    const std::string alone = folder_ / fmt::format("alone-{}.session", ++alone_);
    EXPECT_TRUE(player_->load(std::move(played)));
    EXPECT_TRUE(player_->gain(factor));
    EXPECT_TRUE(player_->arm(alone));
    EXPECT_TRUE(player_->play());
    run(2.4);
    EXPECT_TRUE(player_->disarm());
    const auto strokes = strokes_of(alone);
    EXPECT_EQ(strokes.size(), 3U);
    return std::max(strokes.at(1).error_db, strokes.at(2).error_db);
  }
  std::vector<PlayedStroke> strokes_of(const std::string& session) {
    const auto report = report_strokes(session);
    EXPECT_TRUE(report) << schema::message(report.error());
    notes_ = report->notes;
    return report->strokes;
  }
  std::string rewritten(const std::function<bool(SessionChange&)>& keep) {
    const std::string to = folder_ / fmt::format("rewritten-{}.session", ++alone_);
    Rewriting(session_, to).all(keep);
    return to;
  }
  std::vector<bool> judged_of(const std::string& session) {
    std::vector<bool> judged;
    for (const PlayedStroke& stroke : strokes_of(session)) judged.push_back(stroke.wanted_rms_m > 0);
    return judged;
  }
  std::vector<std::string> notes_;
  int alone_ = 0;
};

using Judged = std::vector<bool>;

// What errs alone (the encoder's counts of 1 um at the turns: -34.9 dB of the fine grating, -39.7 dB of the
// other) errs here; 0.5 dB beside it are for where in the texture the strokes lie. A gain that is a factor of
// another number would be off by 1.6 (8e-4 / 5e-4): 4 dB of level.
TEST_F(StrokesOverChanges, AreJudgedAsWellAsOneTextureAlone) {
  play_with_changes();
  expect_same_to_the_bit();
  const auto strokes = strokes_of(session_);
  ASSERT_EQ(strokes.size(), 5U);
  EXPECT_TRUE(notes_.empty()) << notes_.front();
  const double fine_db = worst_error_alone(program("fine", 8e-4), 0.5);
  const double grating_db = worst_error_alone(program("grating", -5e-4), 0.9);
  EXPECT_LT(fine_db, -34);
  EXPECT_LT(grating_db, -39);
  for (const std::size_t stroke : {1U, 2U, 3U}) EXPECT_LT(strokes[stroke].error_db, fine_db + 0.5) << stroke;
  EXPECT_LT(strokes[4].error_db, grating_db + 0.5);
  for (std::size_t i = 1; i < strokes.size(); ++i) EXPECT_NEAR(strokes[i].level_db, 0, 0.02) << i;
}

// A fade of most of a stroke, by its weight: an even one (u instead of u^2 (3 - 2 u)) is off by up to 0.1 of
// each texture, which would be -23 dB.
TEST_F(StrokesOverChanges, ALongFadeIsJudgedByItsWeight) {
  play_with_changes(0.5);
  const auto strokes = strokes_of(session_);
  ASSERT_EQ(strokes.size(), 5U);
  for (const std::size_t stroke : {1U, 2U, 3U, 4U}) EXPECT_LT(strokes[stroke].error_db, -33) << stroke;
}

TEST_F(StrokesOverChanges, WithTheTexturesSwappedTheNumbersAreBad) {
  play_with_changes();
  std::vector<schema::SessionProgram> programs;
  rewritten([&](SessionChange& change) {
    programs.push_back(change.program);
    return true;
  });
  ASSERT_EQ(programs.size(), 2U);
  const auto swapped = strokes_of(rewritten([&](SessionChange& change) {
    change.program = programs.back();
    programs.pop_back();
    return true;
  }));
  ASSERT_EQ(swapped.size(), 5U);
  EXPECT_LT(swapped[0].error_db, -20);
  for (const std::size_t stroke : {1U, 2U, 3U, 4U}) EXPECT_GT(swapped[stroke].error_db, -3) << stroke;
  EXPECT_TRUE(notes_.empty());
}

// Older sessions do not say what a change brings; they are read as they were.
TEST_F(StrokesOverChanges, AnOlderSessionIsJudgedUpToItsFirstChange) {
  play_with_changes();
  const double first_db = strokes_of(session_).at(0).error_db;
  session_ = rewritten([](SessionChange&) { return false; });
  EXPECT_EQ(judged_of(session_), (Judged{true, false, false, false, false}));
  ASSERT_EQ(notes_.size(), 1U);
  EXPECT_TRUE(notes_[0].starts_with("the texture changes at 1.1")) << notes_[0];
  EXPECT_TRUE(notes_[0].ends_with(" s: strokes that reach beyond are not judged")) << notes_[0];
  EXPECT_NEAR(strokes_of(session_).at(0).error_db, first_db, 0.01);
  expect_same_to_the_bit();
}

TEST_F(StrokesOverChanges, AChangeThatIsNotNamedCostsItsOwnStrokesOnly) {
  play_with_changes();
  int change = 0;
  EXPECT_EQ(judged_of(rewritten([&](SessionChange&) { return ++change == 2; })),
            (Judged{true, false, false, false, true}));
  ASSERT_EQ(notes_.size(), 1U);
  EXPECT_NE(notes_[0].find("not judged, up to the change at 2.6"), std::string::npos) << notes_[0];
}

TEST_F(StrokesOverChanges, ATextureThatIsGoneCostsItsOwnStrokesOnly) {
  play_with_changes();
  const auto whole = strokes_of(session_);
  std::filesystem::remove(folder_ / "fine.texture.json");
  EXPECT_EQ(judged_of(session_), (Judged{true, false, false, false, true}));
  ASSERT_EQ(notes_.size(), 1U);
  EXPECT_NE(notes_[0].find("fine.texture.json"), std::string::npos) << notes_[0];
  EXPECT_NEAR(strokes_of(session_).at(4).error_db, whole.at(4).error_db, 0.5);
}

// The header is of what was armed, each block of what came then.
TEST_F(StrokesOverChanges, TheSessionNamesWhatEachChangeBrings) {
  play_with_changes();
  auto reader = schema::SessionReader::open(session_);
  const auto totals = session_totals(*reader);
  ASSERT_EQ(totals.changes.size(), 2U);
  const schema::SessionProgram& fine = totals.changes[0].program;
  ASSERT_EQ(fine.textures.size(), 1U);
  EXPECT_EQ(fine.textures[0].file, program("fine").name());
  EXPECT_EQ(fine.textures[0].sha256, program("fine").session.textures[0].sha256);
  EXPECT_EQ(fine.textures[0].gain_m_per_n, 8e-4);
  EXPECT_EQ(fine.choices.inverse, reader->header().choices.inverse);
  EXPECT_EQ(fine.high_hz, reader->header().high_hz);
  EXPECT_EQ(totals.changes[1].program.textures.at(0).gain_m_per_n, -5e-4);
  EXPECT_NEAR(static_cast<double>(totals.changes[0].not_before), 1.1 * kRateHz, 50);
}

}  // namespace
}  // namespace tacto::playback
