// SPDX-License-Identifier: GPL-3.0-or-later
// One play without effective limits, and with the limits of a test.
#pragma once

#include "tests/playback/player_on_sim.hpp"

namespace tacto::playback {

/// Plays the same twice: with limits that are never reached, so that the drive is the unlimited one, and with
/// those of a test. Each has a new device, so that time and finger are the same to the tick.
class LimitedPlay : public PlayerOnSim {
 protected:
  void load(const std::string& texture) {
    ProgramRequest request{folder_ / texture, {}, {}, schema::Gain{5e-4, false}};
    request.choices = choices_;
    ASSERT_TRUE(player_->load(made(request, transducer_)));
  }
  void begin_play(const schema::Transducer& transducer, const schema::PlaybackChoices& choices,
                  const std::string& name) {
    player_.reset();
    SetUp();  // the finger starts again
    session_ = folder_ / (name + ".session");
    transducer_ = folder_ / (name + ".transducer.json");
    choices_ = choices;
    ASSERT_TRUE(schema::write_transducer(transducer_, transducer));
    load("grating");
    const auto armed = player_->arm(session_);
    ASSERT_TRUE(armed) << schema::message(armed.error());
    ASSERT_TRUE(player_->play());
  }
  std::vector<double> drive_of(const schema::Transducer& transducer, const schema::PlaybackChoices& choices,
                               const std::string& name) {
    begin_play(transducer, choices, name);
    if (HasFatalFailure()) return {};
    run(1);
    EXPECT_TRUE(player_->gain(1.2));
    load("fine");
    run(1.2);
    EXPECT_TRUE(player_->disarm());
    std::vector<double> drive;
    for (const auto& tick : ticks()) drive.push_back(tick.drive_v);
    return drive;
  }
  static double removed_db(const std::vector<double>& unlimited_v, const std::vector<double>& drive) {
    double removed = 0, whole = 0;
    for (std::size_t i = 0; i < unlimited_v.size(); ++i)
      removed += (unlimited_v[i] - drive[i]) * (unlimited_v[i] - drive[i]),
          whole += unlimited_v[i] * unlimited_v[i];
    return 10 * std::log10(removed / whole);
  }
  std::string transducer_;
  schema::PlaybackChoices choices_;
  schema::Transducer bender_ = *schema::read_transducer("wiertlewski2011");
};

// The two sums differ only by rounding errors of double precision.
inline constexpr double kRoundingsDb = 1e-6;

}  // namespace tacto::playback
