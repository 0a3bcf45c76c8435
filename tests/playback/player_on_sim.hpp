// SPDX-License-Identifier: GPL-3.0-or-later
// A player on the emulated device, in emulated time, under a finger that moves back and forth.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "data-schema/session/session_reader.hpp"
#include "firmware-host/sim/device/sim_device.hpp"
#include "playback/player/player.hpp"
#include "playback/session/session_replay.hpp"
#include "tests/data-schema/temporary_folder.hpp"
#include "tests/playback/made_textures.hpp"

namespace tacto::playback {

inline constexpr double kRateHz = 2000;

inline schema::Texture grating(double per_m = 1000, double force_n = 0.02) {
  schema::Texture texture;
  texture.signal = {10e-6, 0, std::vector<double>(4000)};
  for (std::size_t i = 0; i < texture.signal.values.size(); ++i)
    texture.signal.values[i] = force_n * std::sin(kTwoPi * per_m * 10e-6 * static_cast<double>(i));
  return texture;
}

class PlayerOnSim : public testing::Test {
 protected:
  void SetUp() override {
    auto device = firmware_host::make_sim_device("sim:", parameters_);
    ASSERT_TRUE(device) << schema::message(device.error());
    device_ = std::move(*device);
    device_->board().set_script([this](double t) { return place_m(t); });
    PlayerOptions options;
    options.full_queue = FullQueue::wait;
    options.tell_limits = tell_limits_;
    auto player = Player::make(device_->client(), "sim:", options);
    ASSERT_TRUE(player) << schema::message(player.error());
    player_ = std::move(*player);
    ASSERT_TRUE(schema::write_texture(folder_ / "grating", grating()));
    ASSERT_TRUE(schema::write_texture(folder_ / "fine", grating(1700, 0.012)));
  }
  // 40 mm/s back and forth over 30 mm; at `jump_s_` the position jumps by 10 mm.
  double place_m(double t) const {
    const double way = 2e-3 + 0.03 - std::abs(std::fmod(0.04 * t, 0.06) - 0.03);
    return way + (t >= jump_s_ ? 0.01 : 0);
  }
  Program made(const ProgramRequest& request, const std::string& transducer = "wiertlewski2011",
               double rate_hz = kRateHz) {
    PrepareOptions options;
    options.rate_hz = rate_hz;
    options.metres_per_count = player_->metres_per_count();
    options.onset_s = 0.02;
    options.most_samples = device_->client().description().welcome.profile_samples;
    auto program = make_program(request, transducer, options);
    EXPECT_TRUE(program) << schema::message(program.error());
    return std::move(*program);
  }
  Program program(const std::string& name = "grating", double gain_m_per_n = 5e-4, double rate_hz = kRateHz) {
    return made({folder_ / name, {}, {}, schema::Gain{gain_m_per_n, false}}, "wiertlewski2011", rate_hz);
  }
  void begin() {
    ASSERT_TRUE(player_->load(program()));
    const auto armed = player_->arm(session_);
    ASSERT_TRUE(armed) << schema::message(armed.error());
  }
  std::size_t ticks_here() const { return player_->status().ticks.expected(); }
  void run(double seconds) {
    for (const double end = player_->armed_s() + seconds; player_->armed_s() < end;)
      ASSERT_TRUE(player_->step(0.01));
  }
  std::vector<schema::SessionTick> ticks() {
    auto reader = schema::SessionReader::open(session_);
    std::vector<schema::SessionTick> all;
    while (auto block = reader->next())
      if (auto* some = std::get_if<std::vector<schema::SessionTick>>(&*block))
        all.insert(all.end(), some->begin(), some->end());
    return all;
  }
  std::vector<std::string> events() {
    auto reader = schema::SessionReader::open(session_);
    std::vector<std::string> all;
    while (auto block = reader->next())
      if (auto* event = std::get_if<schema::SessionEvent>(&*block)) all.push_back(event->text);
    return all;
  }
  void expect_zero_within_20_ms_of_fault() {
    const auto all = ticks();
    const auto fault =
        std::ranges::find_if(all, [](const auto& t) { return (t.flags & wire::kTickFault) != 0; });
    ASSERT_NE(fault, all.end());
    ASSERT_GT(all.end() - fault, static_cast<long>(0.02 * kRateHz))
        << "the session ends before the ramp does";
    for (auto tick = fault + static_cast<long>(0.02 * kRateHz); tick != all.end(); ++tick)
      ASSERT_EQ(tick->drive_v, 0) << tick->tick - fault->tick << " ticks after the fault";
  }
  void expect_same_to_the_bit() {
    const auto replayed = replay_session(session_);
    ASSERT_TRUE(replayed) << schema::message(replayed.error());
    EXPECT_FALSE(replayed->lost_at);
    EXPECT_EQ(replayed->ticks, ticks().size());
    if (replayed->first_difference)
      FAIL() << "tick " << replayed->first_difference->tick << ": " << replayed->first_difference->recorded
             << " V, replayed " << replayed->first_difference->replayed << " V";
  }

  tests::TemporaryFolder folder_;
  std::string parameters_;  // of the device
  std::string session_ = folder_ / "one.session";
  double jump_s_ = 1e9;
  bool tell_limits_ = false;
  std::unique_ptr<firmware_host::SimDevice> device_;
  std::unique_ptr<firmware_host::Client> faulty_;  // over a faulty cable, if a test needs one
  std::unique_ptr<Player> player_;
};

}  // namespace tacto::playback
