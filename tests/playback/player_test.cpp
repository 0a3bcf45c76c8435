// SPDX-License-Identifier: GPL-3.0-or-later
// The player on the emulated device, in emulated time: states, refusals, faults, sessions that replay.
#include "playback/daemon/player.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "data-schema/session_reader.hpp"
#include "firmware-host/sim/sim_device.hpp"
#include "firmware-host/sim/sim_transport.hpp"
#include "playback/daemon/player_device.hpp"
#include "playback/daemon/session_replay.hpp"
#include "tests/data-schema/temporary_folder.hpp"
#include "tests/playback/made_textures.hpp"

namespace tacto::playback {
namespace {

constexpr double kRateHz = 2000;

schema::Texture grating() {
  schema::Texture texture;
  texture.signal = {10e-6, 0, std::vector<double>(4000)};
  for (std::size_t i = 0; i < texture.signal.values.size(); ++i)
    texture.signal.values[i] = 0.02 * std::sin(2 * 3.141592653589793 * 1000 * 10e-6 * static_cast<double>(i));
  return texture;
}

class PlayerOnSim : public testing::Test {
 protected:
  void SetUp() override {
    auto device = firmware_host::make_sim_device("sim:", "");
    ASSERT_TRUE(device) << schema::message(device.error());
    device_ = std::move(*device);
    device_->board().set_script([this](double t) { return place_m(t); });
    PlayerOptions options;
    options.full_queue = FullQueue::wait;
    auto player = Player::make(device_->client(), "sim:", options);
    ASSERT_TRUE(player) << schema::message(player.error());
    player_ = std::move(*player);
    ASSERT_TRUE(schema::write_texture(folder_ / "grating", grating()));
  }
  // 40 mm/s there and back over 30 mm; at `jump_s_` it is suddenly 10 mm further on.
  double place_m(double t) const {
    const double way = 2e-3 + 0.03 - std::abs(std::fmod(0.04 * t, 0.06) - 0.03);
    return way + (t >= jump_s_ ? 0.01 : 0);
  }
  Program program() {
    PrepareOptions options;
    options.rate_hz = kRateHz;
    options.metres_per_count = player_->metres_per_count();
    options.onset_s = 0.02;
    options.most_samples = device_->client().description().welcome.profile_samples;
    auto made = make_program({folder_ / "grating", {}, 5e-4, {}}, "wiertlewski2011", options);
    EXPECT_TRUE(made) << schema::message(made.error());
    return std::move(*made);
  }
  void begin() {
    ASSERT_TRUE(player_->load(program()));
    const auto armed = player_->arm(session_);
    ASSERT_TRUE(armed) << schema::message(armed.error());
  }
  void run(double seconds) {
    for (const double end = player_->played_s() + seconds; player_->played_s() < end;)
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
      FAIL() << "tick " << replayed->first_difference->tick << ": " << replayed->first_difference->recorded_v
             << " V, replayed " << replayed->first_difference->replayed_v << " V";
  }

  tests::TemporaryFolder folder_;
  std::string session_ = folder_ / "one.session";
  double jump_s_ = 1e9;
  std::unique_ptr<firmware_host::SimDevice> device_;
  std::unique_ptr<Player> player_;
};

TEST_F(PlayerOnSim, PlaysRecordsAndReplaysToTheBit) {
  begin();
  EXPECT_EQ(player_->state(), PlayerState::armed);
  run(0.1);
  ASSERT_TRUE(player_->play());
  run(1);
  EXPECT_EQ(player_->state(), PlayerState::playing);
  ASSERT_TRUE(player_->gain(0.4));
  run(0.7);
  ASSERT_TRUE(player_->gain(-1.3));
  run(0.3);
  ASSERT_TRUE(player_->stop());
  run(0.2);
  EXPECT_EQ(player_->state(), PlayerState::armed);
  ASSERT_TRUE(player_->play());
  run(0.5);
  ASSERT_TRUE(player_->disarm());
  EXPECT_EQ(player_->state(), PlayerState::idle);
  const auto all = ticks();
  ASSERT_GT(all.size(), 2.7 * kRateHz);
  double peak = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    ASSERT_EQ(all[i].tick, i) << "the log has a hole";
    peak = std::max(peak, std::abs(double{all[i].drive_v}));
  }
  EXPECT_GT(peak, 0.1);
  EXPECT_EQ(all[100].drive_v, 0) << "armed is not playing";
  EXPECT_EQ(player_->last_session().queue_lost, 0U);
  expect_same_to_the_bit();
}

TEST_F(PlayerOnSim, AReplayTellsTheFirstTickThatDiffers) {
  begin();
  ASSERT_TRUE(player_->play());
  run(0.5);
  ASSERT_TRUE(player_->disarm());
  auto reader = schema::SessionReader::open(session_);
  auto writer = schema::SessionWriter::create(folder_ / "two.session", reader->header());
  ASSERT_TRUE(writer);
  while (auto block = reader->next()) {
    if (auto* command = std::get_if<schema::SessionCommand>(&*block)) {
      ASSERT_TRUE(writer->add(*command));
    }
    auto* some = std::get_if<std::vector<schema::SessionTick>>(&*block);
    if (some == nullptr) continue;
    for (auto& tick : *some)
      if (tick.tick == 700) tick.drive_v = std::nextafter(tick.drive_v, 10.0F);
    ASSERT_TRUE(writer->add(*some));
  }
  const auto replayed = replay_session(folder_ / "two");
  ASSERT_TRUE(replayed) << schema::message(replayed.error());
  ASSERT_TRUE(replayed->first_difference);
  EXPECT_EQ(replayed->first_difference->tick, 700U);
}

TEST_F(PlayerOnSim, WhatCanNotBeDoneIsRefusedWithWhatToDo) {
  const auto expect_refused = [](const schema::Result<void>& result, const std::string& remedy) {
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().fault, schema::Fault::usage);
    EXPECT_EQ(result.error().remedy, remedy);
  };
  expect_refused(player_->arm(session_), "load a texture or scene first");
  expect_refused(player_->play(), "arm first");
  expect_refused(player_->stop(), "nothing plays");
  begin();
  expect_refused(player_->load(program()), "disarm first");
  expect_refused(player_->arm(session_), "disarm first");
  EXPECT_FALSE(player_->gain(std::nan("")));
  ASSERT_TRUE(player_->disarm());
  const auto again = player_->arm(session_);
  ASSERT_FALSE(again) << "a session is never written over";
  EXPECT_EQ(player_->state(), PlayerState::idle);
}

TEST_F(PlayerOnSim, AnEncodersJumpOf10MmRampsToZeroAndReplays) {
  jump_s_ = 0.5;
  begin();
  ASSERT_TRUE(player_->play());
  run(0.8);
  EXPECT_EQ(player_->state(), PlayerState::fault);
  EXPECT_NE(player_->status().fault.find("the encoder jumped by"), std::string::npos);
  EXPECT_EQ(player_->play().error().remedy, "disarm first, then arm");
  ASSERT_TRUE(player_->disarm());
  EXPECT_EQ(player_->state(), PlayerState::idle);
  expect_zero_within_20_ms_of_fault();
  expect_same_to_the_bit();
}

TEST_F(PlayerOnSim, AnOpenEnableInputRampsToZeroAndReplays) {
  begin();
  ASSERT_TRUE(player_->play());
  run(0.5);
  device_->board().set_enabled(false);
  run(0.3);
  EXPECT_EQ(player_->state(), PlayerState::fault);
  ASSERT_TRUE(player_->disarm());
  expect_zero_within_20_ms_of_fault();
  expect_same_to_the_bit();
}

// The host stands still; the device goes on ticking, and saves itself.
TEST_F(PlayerOnSim, AHostThatStandsStillIsAFaultOnTheDeviceAndReplays) {
  begin();
  ASSERT_TRUE(player_->play());
  run(0.5);
  double since_fault_s = 0;
  for (double t = 0; t < 0.15; t += 1 / kRateHz) {
    device_->board().step();
    if (device_->board().drive_state() == wire::DriveState::fault) since_fault_s += 1 / kRateHz;
    device_->board().poll();
    if (since_fault_s > 0.02) {
      EXPECT_EQ(device_->board().drive_v(), 0);
    }
  }
  EXPECT_GT(since_fault_s, 0.02);
  run(0.1);
  EXPECT_EQ(player_->state(), PlayerState::fault);
  EXPECT_NE(player_->status().fault.find("heard nothing"), std::string::npos);
  ASSERT_TRUE(player_->disarm());
  expect_same_to_the_bit();
}

// That program was killed in mid-play: the device is still ramping down when the next one greets it.
TEST_F(PlayerOnSim, WhatAnEarlierProgramsRunHasStillToSayBelongsToNobody) {
  begin();
  ASSERT_TRUE(player_->play());
  run(0.5);
  const auto client = firmware_host::Client::connect(
      std::make_unique<firmware_host::SimTransport>(device_->board(), false), "sim:");
  ASSERT_TRUE(client) << schema::message(client.error());
  PlayerOptions options;
  options.full_queue = FullQueue::wait;
  const auto next = Player::make(**client, "sim:", options);
  ASSERT_TRUE(next) << schema::message(next.error());
  ASSERT_TRUE((*next)->load(program()));
  const auto armed = (*next)->arm(folder_ / "two.session");
  ASSERT_TRUE(armed) << schema::message(armed.error());
  ASSERT_TRUE((*next)->play());
  while ((*next)->played_s() < 0.5) ASSERT_TRUE((*next)->step(0.01));
  EXPECT_EQ((*next)->status().ticks.lost(), 0U);
  EXPECT_GE((*next)->status().ticks.ticks(), 1000U);
  EXPECT_EQ((*next)->state(), PlayerState::playing);
}

TEST_F(PlayerOnSim, APlayedTextureThatIsNoNumberNeverGetsToTheDevice) {
  schema::Texture texture = grating();
  texture.signal.values[100] = std::nan("");
  PrepareOptions options;
  options.rate_hz = kRateHz;
  const auto prepared = prepare(texture, schema::read_transducer("wiertlewski2011").value(), options);
  ASSERT_FALSE(prepared);
  EXPECT_EQ(prepared.error().fault, schema::Fault::unsuitable);
}

TEST_F(PlayerOnSim, ADeviceThatDoesNotAnswerIsLostOnceAndForAll) {
  begin();
  ASSERT_TRUE(player_->play());
  run(0.2);
  std::vector<std::string> told;
  player_->listen([&](PlayerState state, const std::string&, double) { told.emplace_back(word_of(state)); });
  device_->board().set_link_bytes(0);
  bool failed = false;
  for (int i = 0; i < 500 && !failed; ++i) failed = !player_->step(0.05).has_value();
  EXPECT_TRUE(failed);
  EXPECT_EQ(player_->state(), PlayerState::lost);
  EXPECT_EQ(told, std::vector<std::string>{"lost"});
  EXPECT_TRUE(player_->step(0.01)) << "told once";
  EXPECT_FALSE(player_->disarm());
  auto reader = schema::SessionReader::open(session_);
  EXPECT_EQ(session_totals(*reader).ending, schema::SessionEnding::closed);
}

}  // namespace
}  // namespace tacto::playback
