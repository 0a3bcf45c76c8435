// SPDX-License-Identifier: GPL-3.0-or-later
// The user's choices of interpolation, inverse and limits: which setting has priority, and the effect of each
// in numbers, from the program to the session that replays.
#include "playback/choose/choices.hpp"

#include <unistd.h>

#include <functional>

#include "data-schema/session/session_writer.hpp"
#include "playback/prepare/kernel_drive.hpp"
#include "playback/prepare/undone_chain.hpp"
#include "playback/prepare/upload.hpp"
#include "tests/playback/player_on_sim.hpp"

namespace tacto::playback {
namespace {

using schema::PlaybackChoices;

PlaybackChoices choices_with(const std::function<void(PlaybackChoices&)>& say) {
  PlaybackChoices choices;
  say(choices);
  return choices;
}

TEST(PlaybackChoices, WhoStandsAboveIsHeardFirst) {
  const auto config = choices_with([](auto& c) {
    c.interpolation = "linear", c.contact_on_n = 1.0, c.contact_off_n = 0.9,
    c.reconstruction = "butterworth3";
  });
  const auto scene = choices_with([](auto& c) { c.interpolation = "sinc", c.cutoff_hz = 500.0; });
  const auto request = choices_with([](auto& c) { c.inverse = "none", c.contact_on_n = 0.5; });
  const auto options = with_choices({}, request.over(scene.over(config)));
  ASSERT_TRUE(options) << schema::message(options.error());
  EXPECT_EQ(options->interpolation, wire::Interpolation::sinc);
  EXPECT_EQ(options->inverse, Inverse::none);
  EXPECT_EQ(options->reconstruction, Reconstruction::butterworth3);
  EXPECT_EQ(options->reconstruction_cutoff_hz, 500);
  EXPECT_EQ(options->contact_on_n, 0.5);
  EXPECT_DOUBLE_EQ(options->contact_off_n, 0.4)
      << "the configuration's lower threshold was for its own upper one";
  EXPECT_EQ(options->hold, Hold::zero_order) << "the usual";
}

TEST(PlaybackChoices, WhatWasPlayedSaysItselfAgain) {
  auto options = with_choices({}, choices_with([](auto& c) {
                                c.interpolation = "nearest", c.hold = "none", c.energy_rms_v = 2.0,
                                c.contact_on_n = 0.3;
                              }));
  const auto again = with_choices({}, choices_in(*options));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->interpolation, wire::Interpolation::nearest);
  EXPECT_EQ(again->hold, Hold::none);
  EXPECT_EQ(again->energy_rms_v, 2);
  EXPECT_DOUBLE_EQ(again->contact_off_n, options->contact_off_n);
  EXPECT_FALSE(choices_in(PrepareOptions{}).energy_rms_v) << "no limit is none";
}

// Settings of something that does not exist are refused. A lower level may define it; a request may switch it
// off, but not set its details at the same time.
TEST(PlaybackChoices, MoreOfWhatIsNotThereIsRefused) {
  const PlaybackChoices below = choices_with(
      [](auto& c) { c.reconstruction = "butterworth3", c.energy_rms_v = 2.0, c.contact_on_n = 0.3; });
  struct Said {
    PlaybackChoices more, off;
    const char* words[2];
  };
  const Said all[] = {{choices_with([](auto& c) { c.cutoff_hz = 500.0; }),
                       choices_with([](auto& c) { c.cutoff_hz = 500.0, c.reconstruction = "none"; }),
                       {"--cutoff", "--reconstruction butterworth3"}},
                      {choices_with([](auto& c) { c.energy_window_s = 2.0; }),
                       choices_with([](auto& c) { c.energy_window_s = 2.0, c.energy_rms_v = 0.0; }),
                       {"--energy-window", "--energy-limit"}},
                      {choices_with([](auto& c) { c.contact_off_n = 0.1; }),
                       choices_with([](auto& c) { c.contact_off_n = 0.1, c.contact_on_n = 0.0; }),
                       {"--contact-off", "contact_on_n"}}};
  for (const Said& said : all) {
    EXPECT_TRUE(check_consistent(said.more, said.more.over(below))) << said.words[0];
    EXPECT_FALSE(check_consistent(said.off, said.off.over(below))) << said.words[0];
    const auto alone = check_consistent(said.more, said.more);
    ASSERT_FALSE(alone) << said.words[0];
    EXPECT_EQ(alone.error().kind, schema::ErrorKind::usage);
    for (const char* words : said.words)
      EXPECT_NE(schema::message(alone.error()).find(words), std::string::npos) << words;
  }
  EXPECT_TRUE(check_consistent({}, below)) << "what stands below may say more: for those who name it";
}

TEST(PlaybackChoices, AWordThatThereIsNotIsRefused) {
  const auto wrong = with_choices({}, choices_with([](auto& c) { c.inverse = "half"; }));
  ASSERT_FALSE(wrong);
  EXPECT_NE(schema::message(wrong.error()).find("'half'"), std::string::npos);
}

// RMS of the drive by the device's own arithmetic (sampled texture, all filters), along a path of constant
// speed.
double drive_rms_v(const PrepareOptions& options, const schema::Texture& texture, double speed_mps = 0.05) {
  const auto prepared = prepare(texture, *schema::read_transducer("wiertlewski2011"), options);
  EXPECT_TRUE(prepared) << schema::message(prepared.error());
  const FingerPath path{{0, 0.6}, {2e-3, 2e-3 + 0.6 * speed_mps}, {}};
  const auto drive = kernel_drive(*prepared, path, options, 1100).drive_v;
  double sum = 0;
  for (std::size_t i = 400; i < 1000; ++i) sum += drive[i] * drive[i];
  return std::sqrt(sum / 600);
}

// A grating of f Hz: full and magnitude give 1 / |chain(f)|, gain 1 / |chain(0)|, none the ratio of the
// limits. The inverse has an error of inverse_error_db (below -40 dB), the tracker's position one of 0.2 %:
// the test resolves 2 %.
TEST(PlaybackChoices, EachInverseGivesTheDriveOfItsResponse) {
  PrepareOptions options;
  const schema::Texture texture = grating(8000, 0.004);  // 400 Hz at 50 mm/s: near the resonance
  const UndoneChain undone = undone_chain(*schema::read_transducer("wiertlewski2011"), options);
  const double target_rms_m = 0.004 * options.gain_m_per_n / std::sqrt(2);
  for (const char* word : {"full", "magnitude", "gain", "none"}) {
    const auto chosen = with_choices(options, choices_with([&](auto& c) { c.inverse = word; }));
    const double per_metre = std::abs(inverse_response(undone.chain, chosen->inverse, 400));
    EXPECT_NEAR(drive_rms_v(*chosen, texture) / (per_metre * target_rms_m), 1, 0.02) << word;
  }
}

// All with levels of 20 points per period, against the most exact interpolation: each within its error stated
// in playback/DECISIONS.md (w = 2 pi / points per period), each clearly better than the one before.
TEST(PlaybackChoices, EachInterpolationReadsWithItsOwnError) {
  const schema::Texture texture = grating(3000, 0.01);
  const auto read_by = [&](const char* word) {
    auto options =
        with_choices({}, choices_with([&](auto& c) { c.interpolation = word, c.inverse = "gain"; }));
    options->samples_per_period = 20;
    const auto prepared = prepare(texture, *schema::read_transducer("wiertlewski2011"), *options);
    EXPECT_TRUE(prepared);
    return kernel_drive(*prepared, {{0, 0.6}, {2e-3, 0.0321}, {}}, *options, 1100).drive_v;
  };
  const auto best = read_by("sinc");
  const auto error_of = [&](const char* word) {
    const auto drive = read_by(word);
    double error = 0, whole = 0;
    for (std::size_t i = 400; i < 1000; ++i)
      error += (drive[i] - best[i]) * (drive[i] - best[i]), whole += best[i] * best[i];
    return std::sqrt(error / whole);
  };
  const double w = kTwoPi / 20, nearest = error_of("nearest"), linear = error_of("linear"),
               hermite = error_of("hermite");
  EXPECT_LT(nearest, 0.5 * w);
  EXPECT_GT(nearest, 3 * linear);
  EXPECT_LT(linear, 0.125 * w * w);
  EXPECT_GT(linear, 3 * hermite);
  EXPECT_LT(hermite, 0.0026 * std::pow(w, 4) + 0.0032 * std::pow(w, 5) + 1e-4) << "sinc's own at 20 points";
}

// In a chain with the filter, with a delay of 2 ms: an inverse that includes the filter has an error of at
// most 2 % at any frequency of the band (-55 dB RMS, inverse_filter.hpp); without it the phase is off by over
// 90 degrees at 500 Hz.
TEST(PlaybackChoices, AReconstructionFilterIsUndoneWhereItIsNamed) {
  const schema::Transducer bender = *schema::read_transducer("wiertlewski2011");
  const auto with =
      with_choices({}, choices_with([](auto& c) { c.reconstruction = "butterworth3", c.cutoff_hz = 600.0; }));
  const UndoneChain there = undone_chain(bender, *with);
  const double accounted = largest_inverse_error(there, inverse_of(there, *with));
  const double ignored = largest_inverse_error(there, inverse_of(undone_chain(bender, {}), {}));
  EXPECT_LT(accounted, 0.02);
  EXPECT_GT(ignored, 0.8);
}

// A request's choices, through program, player and device, into a session.
class ChosenPlay : public PlayerOnSim {
 protected:
  Program chosen(const PlaybackChoices& choices, const std::string& name = "grating") {
    ProgramRequest request{folder_ / name, {}, {}, schema::Gain{5e-4, false}};
    request.choices = choices;
    return made(request);
  }
  void press(std::function<double(double)> normal_n) {
    device_->board().set_script([this](double t) { return place_m(t); }, std::move(normal_n));
  }
  void play_chosen(const PlaybackChoices& choices, double seconds) {
    const auto loaded = player_->load(chosen(choices));
    ASSERT_TRUE(loaded) << schema::message(loaded.error());
    const auto armed = player_->arm(session_);
    ASSERT_TRUE(armed) << schema::message(armed.error());
    ASSERT_TRUE(player_->play());
    run(seconds);
    status_ = player_->status();
    ASSERT_TRUE(player_->disarm());
  }
  std::string refusal(const PlaybackChoices& choices) {
    const auto loaded = player_->load(chosen(choices));
    EXPECT_FALSE(loaded);
    return loaded ? "" : schema::message(loaded.error());
  }
  PlayerStatus status_;
};

double rms_v(const std::vector<schema::SessionTick>& ticks, double from_s, double to_s) {
  double sum = 0;
  const auto first = static_cast<std::size_t>(from_s * kRateHz),
             last = static_cast<std::size_t>(to_s * kRateHz);
  for (std::size_t i = first; i < last; ++i) sum += double{ticks[i].drive_v} * ticks[i].drive_v;
  return std::sqrt(sum / static_cast<double>(last - first));
}

// energy_limiter.hpp: the RMS is within 2 % of the limit after the window has passed.
TEST_F(ChosenPlay, AnEnergyLimitHoldsItsBoundAndReplays) {
  play_chosen({}, 1);
  const double free_v = rms_v(ticks(), 0.4, 0.7);
  EXPECT_EQ(status_.ticks.energy_limited(), 0U);
  ::unlink(session_.c_str());
  const double limit_v = 0.5 * free_v;
  play_chosen(choices_with([&](auto& c) { c.energy_rms_v = limit_v, c.energy_window_s = 0.1; }), 1);
  EXPECT_LT(rms_v(ticks(), 0.4, 0.7), 1.02 * limit_v);
  EXPECT_GT(rms_v(ticks(), 0.4, 0.7), 0.9 * limit_v) << "no more than asked is taken away";
  EXPECT_GT(status_.ticks.energy_limited(), 1000U);
  expect_same_to_the_bit();
  EXPECT_EQ(schema::SessionReader::open(session_)->header().choices.energy_rms_v, limit_v);
}

// The finger lifts off twice, and trembles at the threshold within the hysteresis. 20 ms to close.
TEST_F(ChosenPlay, AGateSilencesAndComesBackWithoutAStepAndReplays) {
  press([](double t) { return 0.5 + 0.4 * std::cos(kTwoPi * t) + 0.02 * std::sin(kTwoPi * 30 * t); });
  play_chosen(choices_with([](auto& c) { c.contact_on_n = 0.5, c.contact_off_n = 0.4; }), 2.5);
  const auto all = ticks();
  std::size_t changes = 0;
  double step_v = 0, open_step_v = 0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    const bool touching = (all[i].flags & wire::kTickTouching) != 0;
    const double step = std::abs(double{all[i].drive_v} - all[i - 1].drive_v);
    changes += touching != ((all[i - 1].flags & wire::kTickTouching) != 0);
    step_v = std::max(step_v, step);
    if ((all[i].flags & wire::kTickGated) == 0) open_step_v = std::max(open_step_v, step);
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double t = std::fmod(static_cast<double>(i) / kRateHz, 1);
    if (t > 0.35 && t < 0.7) {
      ASSERT_EQ(all[i].drive_v, 0) << i;
    }
  }
  EXPECT_EQ(changes, 5U)
      << "touching from the first tick, then off, on, off, on, off: no chatter (the trembling is 0.04 N, the "
         "hysteresis 0.1 N)";
  EXPECT_GT(open_step_v, 0.01);
  EXPECT_LE(step_v, 1.001 * open_step_v) << "no step of its own";
  EXPECT_GT(rms_v(all, 0.85, 1.15), 0.05) << "it comes back";
  EXPECT_GT(status_.ticks.gated(), 1500U);
  EXPECT_LT(status_.ticks.gated(), all.size());
  expect_same_to_the_bit();
}

TEST_F(ChosenPlay, WithoutAGateTheForceIsNothingToTheDrive) {
  press([](double) { return 0; });
  play_chosen({}, 0.5);
  EXPECT_GT(rms_v(ticks(), 0.2, 0.4), 0.05);
  EXPECT_EQ(status_.ticks.gated(), 0U);
}

TEST_F(ChosenPlay, AReadingIsUploadedAndReplays) {
  for (const char* word : {"nearest", "linear", "sinc"}) {
    play_chosen(choices_with([&](auto& c) { c.interpolation = word, c.inverse = "none"; }), 0.4);
    EXPECT_GT(rms_v(ticks(), 0.2, 0.4), 0.01) << word;
    expect_same_to_the_bit();
    EXPECT_EQ(schema::SessionReader::open(session_)->header().choices.interpolation, word);
    ::unlink(session_.c_str());
  }
}

TEST_F(ChosenPlay, ADeviceIsRefusedByWhatItLacksAndWhatToDo) {
  Program program = chosen({});
  program.prepared.samples.resize(device_->client().description().welcome.profile_samples + 1);
  const auto large = player_->load(std::move(program));
  ASSERT_FALSE(large);
  const std::string said = schema::message(large.error());
  for (const char* words : {"grating", "--interpolation sinc", "--loop host", "\"loop\": \"host\""})
    EXPECT_NE(said.find(words), std::string::npos) << words << " in: " << said;
  const auto backwards =
      with_choices({}, choices_with([](auto& c) { c.contact_on_n = 0.3, c.contact_off_n = 0.4; }));
  const schema::Texture texture = grating();
  const auto refused = prepare(texture, *schema::read_transducer("wiertlewski2011"), *backwards);
  ASSERT_FALSE(refused);
  EXPECT_NE(schema::message(refused.error()).find("--contact-off"), std::string::npos);
}

TEST(CheckUpload, ADeviceWithoutANormalForceHasNoGate) {
  auto device = firmware_host::make_sim_device("sim:", "source=counter,channels=2");
  ASSERT_TRUE(device) << schema::message(device.error());
  const auto options = with_choices({}, choices_with([](auto& c) { c.contact_on_n = 0.3; }));
  const auto prepared = prepare(grating(), *schema::read_transducer("wiertlewski2011"), *options);
  ASSERT_TRUE(prepared);
  const auto fits = check_upload((*device)->client(), *prepared);
  ASSERT_FALSE(fits);
  EXPECT_EQ(fits.error().kind, schema::ErrorKind::unsuitable);
  for (const char* words : {"reports no normal force", "--contact 0N"})
    EXPECT_NE(schema::message(fits.error()).find(words), std::string::npos) << words;
}

}  // namespace
}  // namespace tacto::playback
