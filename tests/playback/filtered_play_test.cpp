// SPDX-License-Identifier: GPL-3.0-or-later
// The emulated device with a filter behind its converter: displacement of the bender for a drive that inverts
// the filter, and for one that does not include it.
#include <fmt/format.h>

#include <cmath>

#include "data-schema/transducer/transducer.hpp"
#include "playback/render/reference/padded_spectrum.hpp"
#include "playback/strokes/session_target.hpp"
#include "tests/playback/player_on_sim.hpp"

namespace tacto::playback {
namespace {

constexpr double kFastHz = 10e3;  // the images of a held drive above 5 kHz do not move the tray
constexpr double kPlayS = 1.6;

class FilteredPlay : public testing::Test {
 protected:
  // Up to 380 Hz: 63 mm/s over 6 lines a mm.
  void SetUp() override { ASSERT_TRUE(schema::write_texture(folder_ / "lines", grating(6000, 0.004))); }

  // The finger reverses smoothly, as in changed_strokes_test. Its position is read once per tick, before the
  // tray moves: at that time the tray is in the state at which the last drive began.
  void open(const std::string& parameters) {
    player_.reset();
    auto device = firmware_host::make_sim_device("sim:", parameters);
    ASSERT_TRUE(device) << schema::message(device.error());
    device_ = std::move(*device);
    device_->board().set_script([this](double t) {
      if (device_->board().drive_state() != wire::DriveState::idle)
        moved_m_.push_back(device_->board().displacement_m());
      return 17e-3 - 15e-3 * std::cos(kTwoPi * t / 1.5);
    });
    PlayerOptions options;
    options.full_queue = FullQueue::wait;
    player_ = std::move(*Player::make(device_->client(), "sim:", options));
  }
  Program program(const schema::PlaybackChoices& choices) {
    PrepareOptions options;
    options.rate_hz = kFastHz;
    options.metres_per_count = player_->metres_per_count();
    options.onset_s = 0.02;
    options.most_samples = device_->client().description().welcome.profile_samples;
    ProgramRequest request{folder_ / "lines", {}, {}, schema::Gain{5e-4, false}};
    request.choices = choices;
    auto made = make_program(request, "wiertlewski2011", options);
    EXPECT_TRUE(made) << schema::message(made.error());
    return std::move(*made);
  }
  /// Error of the bender's displacement re the target, in the band, in the second stroke: dB.
  double error_db(const std::string& parameters, const schema::PlaybackChoices& choices) {
    open(parameters);
    const std::string session = folder_ / fmt::format("{}.session", ++sessions_);
    EXPECT_TRUE(player_->load(program(choices)));
    moved_m_.clear();
    EXPECT_TRUE(player_->arm(session));
    EXPECT_TRUE(player_->play());
    while (player_->armed_s() < kPlayS) EXPECT_TRUE(player_->step(0.01));
    EXPECT_TRUE(player_->disarm());
    return judged(session);
  }
  double judged(const std::string& session) {
    const auto overview = session_overview(session);
    RowMaker maker(*overview);
    RowFollower follower(*overview);
    std::vector<JudgedRow> judged;
    const auto read = read_rows(
        maker, session, [&](const SessionRow& row) { judged.push_back(follower.next(row, maker.turns())); });
    EXPECT_TRUE(read);
    const spatial::Band band{overview->header.low_hz, overview->header.high_hz};
    const std::size_t rows = judged.size();
    EXPECT_EQ(moved_m_.size(), rows);
    auto spectrum = spectrum_of(std::span(moved_m_).subspan(1), kFastHz, 4 * rows);
    keep_band(spectrum, band);
    const auto moved = signal_of(spectrum);  // without the last row
    const auto target = TargetReader(*overview).target_in(judged).displacement_m;
    double error = 0, whole = 0;
    for (std::size_t row = 8000; row < 14500; ++row)  // 0.8 to 1.45 s
      error += std::pow(moved[row] - target[row], 2), whole += std::pow(target[row], 2);
    return 10 * std::log10(error / whole);
  }
  static schema::PlaybackChoices filter(double cutoff_hz) {
    schema::PlaybackChoices choices;
    choices.reconstruction = "butterworth3";
    choices.cutoff_hz = cutoff_hz;
    return choices;
  }

  tests::TemporaryFolder folder_;
  std::vector<double> moved_m_;
  std::unique_ptr<firmware_host::SimDevice> device_;
  std::unique_ptr<Player> player_;
  int sessions_ = 0;
};

// Without a filter -29.4 dB remain, from the finger's reversals (2 ms of prediction, at six lines per mm) and
// the encoder; an inverted filter adds the error of its inverse, which is 20 dB below that. A filter that is
// not inverted rotates a sine of 380 Hz by at least 75 degrees (twice its delay of 2 / (2 pi 600 Hz)).
TEST_F(FilteredPlay, WhatIsUndoneIsNotFeltAndWhatIsNotIs) {
  const double none_db = error_db("", {});
  const double undone_db = error_db("reconstruction=butterworth3", filter(600));
  const double lower_db = error_db("reconstruction=butterworth3,cutoff=400Hz", filter(400));
  const double ignored_db = error_db("reconstruction=butterworth3", {});
  const double another_db = error_db("reconstruction=butterworth3,cutoff=400Hz", filter(600));
  fmt::print(
      "no filter {:.1f} dB; 600 Hz, undone {:.1f} dB, not undone {:.1f} dB; 400 Hz, undone {:.1f} dB, as 600 "
      "Hz {:.1f} dB\n",
      none_db, undone_db, ignored_db, lower_db, another_db);
  EXPECT_LT(none_db, -28);
  EXPECT_NEAR(undone_db, none_db, 1);
  EXPECT_NEAR(lower_db, none_db, 1);
  EXPECT_GT(ignored_db, -3);
  EXPECT_GT(another_db, -8) << "undone with a cut-off that it has not";
}

TEST_F(FilteredPlay, TheDeviceSaysWhatItIs) {
  open("reconstruction=butterworth3,cutoff=500Hz");
  const std::string said = firmware_host::simulated_device(device_->client().description());
  EXPECT_NE(said.find("500 Hz"), std::string::npos) << said;
}

}  // namespace
}  // namespace tacto::playback
