// SPDX-License-Identifier: GPL-3.0-or-later
// Strokes of a session in which the texture changes: the target in each, before, during and after the change.
#include <fmt/format.h>

#include <fstream>
#include <functional>
#include <iterator>
#include <span>

#include "data-schema/session/session_writer.hpp"
#include "playback/session/session_export.hpp"
#include "playback/strokes/stroke_report.hpp"
#include "tests/playback/player_on_sim.hpp"

namespace tacto::playback {
namespace {

using schema::SessionChange;

/// Reads a session and writes it again, with its changes modified by `keep`; false omits a change.
class Rewriting {
 public:
  Rewriting(const std::string& from, const std::string& to, std::size_t most_ticks = 4096)
      : reader_(std::move(*schema::SessionReader::open(from))),
        writer_(std::move(*schema::SessionWriter::create(to, reader_.header()))),
        most_ticks_(most_ticks) {}
  void all(const std::function<bool(SessionChange&)>& keep) {
    while (auto block = reader_.next()) {
      auto* change = std::get_if<SessionChange>(&*block);
      if (change == nullptr || keep(*change)) std::visit([this](const auto& part) { add(part); }, *block);
    }
  }

 private:
  void add(const std::vector<schema::SessionTick>& ticks) {
    for (std::span rest(ticks); !rest.empty(); rest = rest.subspan(std::min(rest.size(), most_ticks_)))
      EXPECT_TRUE(writer_.add(rest.first(std::min(rest.size(), most_ticks_))));
  }
  void add(const schema::SessionEnd& end) { EXPECT_TRUE(writer_.close(end)); }
  template <class Part>
  void add(const Part& part) {
    EXPECT_TRUE(writer_.add(part));
  }
  schema::SessionReader reader_;
  schema::SessionWriter writer_;
  std::size_t most_ticks_;
};

/// 30 mm back and forth in 1.5 s, so that a stroke takes 0.75 s. In the second stroke the grating changes to
/// the fine one, in the fourth to the inverted grating; the gain changes in the first and the third.
class StrokesOverChanges : public PlayerOnSim {
 protected:
  // A finger that reverses smoothly: at a sharp reversal the prediction's error would be the largest one.
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
  /// The largest error of a whole stroke of one program, dB, without the first stroke, which contains the
  /// onset.
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
    return std::max(strokes.at(1).predicted.error_db, strokes.at(2).predicted.error_db);
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
    for (const PlayedStroke& stroke : strokes_of(session)) judged.push_back(stroke.target_rms_m > 0);
    return judged;
  }
  std::vector<std::string> notes_;
  int alone_ = 0;
};

using Judged = std::vector<bool>;

// The errors of one texture (by the encoder's counts of 1 um at the reversals: -34.9 dB of the fine grating,
// -39.7 dB of the other) are the same here, with 0.5 dB for other positions of the strokes in the texture.
// With the wrong gain the level would be off by a factor of 1.6 (8e-4 / 5e-4): 4 dB.
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
  for (const std::size_t stroke : {1U, 2U, 3U})
    EXPECT_LT(strokes[stroke].predicted.error_db, fine_db + 0.5) << stroke;
  EXPECT_LT(strokes[4].predicted.error_db, grating_db + 0.5);
  for (std::size_t i = 1; i < strokes.size(); ++i) EXPECT_NEAR(strokes[i].predicted.level_db, 0, 0.02) << i;
}

// A fade over most of a stroke is judged by its weight: a linear one (u instead of u^2 (3 - 2 u)) would be
// off by up to 0.1 of each texture, which is -23 dB.
TEST_F(StrokesOverChanges, ALongFadeIsJudgedByItsWeight) {
  play_with_changes(0.5);
  const auto strokes = strokes_of(session_);
  ASSERT_EQ(strokes.size(), 5U);
  for (const std::size_t stroke : {1U, 2U, 3U, 4U})
    EXPECT_LT(strokes[stroke].predicted.error_db, -33) << stroke;
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
  EXPECT_LT(swapped[0].predicted.error_db, -20);
  for (const std::size_t stroke : {1U, 2U, 3U, 4U})
    EXPECT_GT(swapped[stroke].predicted.error_db, -3) << stroke;
  EXPECT_TRUE(notes_.empty());
}

// As where the disk was full when the changes should have been written.
TEST_F(StrokesOverChanges, ASessionWithoutItsChangesIsJudgedUpToTheFirst) {
  play_with_changes();
  const double first_db = strokes_of(session_).at(0).predicted.error_db;
  session_ = rewritten([](SessionChange&) { return false; });
  EXPECT_EQ(judged_of(session_), (Judged{true, false, false, false, false}));
  ASSERT_EQ(notes_.size(), 1U);
  EXPECT_TRUE(notes_[0].starts_with("the texture changes at 1.1")) << notes_[0];
  EXPECT_TRUE(notes_[0].ends_with(" s: strokes that end later are not judged")) << notes_[0];
  EXPECT_NEAR(strokes_of(session_).at(0).predicted.error_db, first_db, 0.01);
  expect_same_to_the_bit();
}

TEST_F(StrokesOverChanges, AChangeThatIsNotNamedCostsItsOwnStrokesOnly) {
  play_with_changes();
  int change = 0;
  EXPECT_EQ(judged_of(rewritten([&](SessionChange&) { return ++change == 2; })),
            (Judged{true, false, false, false, true}));
  ASSERT_EQ(notes_.size(), 1U);
  EXPECT_NE(notes_[0].find("2.6"), std::string::npos) << notes_[0];
}

TEST_F(StrokesOverChanges, ATextureThatIsGoneCostsItsOwnStrokesOnly) {
  play_with_changes();
  const auto whole = strokes_of(session_);
  std::filesystem::remove(folder_ / "fine.texture.json");
  EXPECT_EQ(judged_of(session_), (Judged{true, false, false, false, true}));
  ASSERT_EQ(notes_.size(), 1U);
  EXPECT_NE(notes_[0].find("fine.texture.json"), std::string::npos) << notes_[0];
  EXPECT_NEAR(strokes_of(session_).at(4).predicted.error_db, whole.at(4).predicted.error_db, 0.5);
}

// The header describes the armed texture, each block the texture of a change.
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

// Half a minute of strokes with changes of gain and texture.
class ManyStrokes : public StrokesOverChanges {
 protected:
  void play_for_long() {
    begin();
    ASSERT_TRUE(player_->play());
    for (const double gain : {0.5, 0.9, 0.7, 1.0}) {
      run(2.9);
      ASSERT_TRUE(player_->gain(gain));
      run(2.3);
      const bool fine = gain < 0.8;
      ASSERT_TRUE(player_->load(program(fine ? "fine" : "grating", fine ? 8e-4 : -5e-4), 0.3));
      run(2.1);
    }
    ASSERT_TRUE(player_->disarm());
  }
  std::string in_blocks_of(std::size_t most_ticks) {
    const std::string to = folder_ / fmt::format("rewritten-{}.session", ++alone_);
    Rewriting(session_, to, most_ticks).all([](SessionChange&) { return true; });
    return to;
  }
  std::string exported(const std::string& session, const std::string& ending) {
    const std::string file = folder_ / fmt::format("export-{}{}", ++alone_, ending);
    const auto said = export_session(session, file, schema::Existing::keep);
    EXPECT_TRUE(said) << schema::message(said.error());
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

// Effect of values farther than 5 s away on the band's filters: JudgedBlocks states 5e-4 of the largest value
// there, if all of it were at an edge of the band. Relative to the error it is the same part of the error;
// its level is that of the displacement's difference, so it is given in dB of that.
TEST_F(ManyStrokes, AreTheSameInSmallBlocks) {
  constexpr double kFarAway = 5e-4, kFarAwayDb = 0.01;  // 20 log10(1 + 5e-4), twice
  play_for_long();
  const auto whole = report_strokes(session_, {}, {1e6, 5});
  const auto small = report_strokes(session_, {}, {0.37, 5});
  ASSERT_TRUE(whole && small);
  ASSERT_GT(whole->strokes.size(), 30U);
  ASSERT_EQ(small->strokes.size(), whole->strokes.size());
  for (std::size_t i = 0; i < whole->strokes.size(); ++i) {
    const PlayedStroke &a = small->strokes[i], &b = whole->strokes[i];
    EXPECT_EQ(a.from_s, b.from_s);
    EXPECT_EQ(a.to_m, b.to_m);
    EXPECT_NEAR(a.target_rms_m, b.target_rms_m, kFarAway * b.target_rms_m) << i;
    EXPECT_NEAR(a.predicted.rms_m, b.predicted.rms_m, kFarAway * b.predicted.rms_m) << i;
    EXPECT_NEAR(a.predicted.error_db, b.predicted.error_db, kFarAwayDb) << i;
    EXPECT_EQ(a.limits->ticks(), b.limits->ticks());
  }
  EXPECT_EQ(small->notes, whole->notes);
}

TEST_F(ManyStrokes, HowTheFileIsCutIsNotSeen) {
  play_for_long();
  const std::string cut = in_blocks_of(7);
  const auto one = report_strokes(session_), other = report_strokes(cut);
  ASSERT_TRUE(one && other);
  ASSERT_EQ(one->strokes.size(), other->strokes.size());
  for (std::size_t i = 0; i < one->strokes.size(); ++i)
    EXPECT_EQ(one->strokes[i].predicted.error_db, other->strokes[i].predicted.error_db) << i;
  for (const std::string ending : {".csv", ".wav", ".nc"}) {
    const std::string bytes = exported(session_, ending);
    EXPECT_GT(bytes.size(), 500000U);
    EXPECT_TRUE(bytes == exported(cut, ending)) << ending;
  }
}

}  // namespace
}  // namespace tacto::playback
