// SPDX-License-Identifier: GPL-3.0-or-later
// The player on the emulated device, in emulated time: states, refusals, faults, sessions that replay.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "data-schema/files/files.hpp"
#include "data-schema/session/session_writer.hpp"
#include "firmware-host/sim/device/sim_transport.hpp"
#include "playback/player/player_device.hpp"
#include "playback/strokes/session_stroke.hpp"
#include "playback/strokes/stroke_report.hpp"
#include "tests/firmware-host/faulty_transport.hpp"
#include "tests/playback/full_disk.hpp"
#include "tests/playback/player_on_sim.hpp"

namespace tacto::playback {
namespace {

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

// SESSION.md: the upload is first, and each command is before the ticks that it affects.
TEST_F(PlayerOnSim, ASessionHoldsEachCommandBeforeTheTicksThatTookIt) {
  begin();
  for (int i = 0; i < 40; ++i) {
    ASSERT_TRUE(i % 2 == 0 ? player_->play() : player_->stop());
    run(0.02);
  }
  ASSERT_TRUE(player_->disarm());
  auto reader = schema::SessionReader::open(session_);
  std::uint8_t steered = 0;
  bool armed = false;
  while (auto block = reader->next()) {
    if (const auto* command = std::get_if<schema::SessionCommand>(&*block)) {
      const auto type = static_cast<wire::MessageType>(command->frame[3]);
      steered += armed && wire::steers(type);
      armed = armed || type == wire::MessageType::arm;
    }
    const auto* some = std::get_if<std::vector<schema::SessionTick>>(&*block);
    if (some == nullptr) continue;
    ASSERT_TRUE(armed) << "ticks before the upload";
    const auto taken = static_cast<std::uint8_t>(some->back().flags >> wire::kTickSteeredShift);
    ASSERT_LE(taken, steered);
  }
  EXPECT_EQ(steered, 41);
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
  const auto expect_refused = [](const schema::Result<void>& result) {
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().kind, schema::ErrorKind::usage);
    EXPECT_FALSE(result.error().remedy.empty());
  };
  expect_refused(player_->arm(session_));
  expect_refused(player_->play());
  expect_refused(player_->stop());
  begin();
  expect_refused(player_->load(program(), 10.1));
  expect_refused(player_->arm(session_));
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
  EXPECT_EQ(player_->load(program()).error().remedy, "disarm first");
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

// The host stalls; the device continues to tick, and stops safely.
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
  EXPECT_NE(player_->status().fault.find("received nothing"), std::string::npos);
  ASSERT_TRUE(player_->disarm());
  expect_same_to_the_bit();
}

// That program was killed during playback: the device is still ramping down when the next one connects.
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
  while ((*next)->armed_s() < 0.5) ASSERT_TRUE((*next)->step(0.01));
  EXPECT_EQ((*next)->status().ticks.lost(), 0U);
  EXPECT_GE((*next)->status().ticks.ticks(), 1000U);
  EXPECT_EQ((*next)->state(), PlayerState::playing);
}

TEST_F(PlayerOnSim, ASingleLostTickIsCountedAndRecorded) {
  auto choice = [count = 0](wire::MessageType of) mutable {
    return of == wire::MessageType::ticks && ++count == 20 ? tests::Harm::shorten : tests::Harm::none;
  };
  auto client = firmware_host::Client::connect(
      std::make_unique<tests::FaultyTransport>(
          std::make_unique<firmware_host::SimTransport>(device_->board(), false), choice),
      "sim:");
  ASSERT_TRUE(client) << schema::message(client.error());
  faulty_ = std::move(*client);
  PlayerOptions options;
  options.full_queue = FullQueue::wait;
  auto player = Player::make(*faulty_, "sim:", options);
  ASSERT_TRUE(player) << schema::message(player.error());
  player_ = std::move(*player);
  begin();
  ASSERT_TRUE(player_->play());
  run(0.5);
  EXPECT_EQ(player_->status().ticks.lost(), 1U);
  ASSERT_TRUE(player_->disarm());
  std::vector<schema::SessionLoss> losses;
  auto reader = schema::SessionReader::open(session_);
  while (auto block = reader->next())
    if (const auto* loss = std::get_if<schema::SessionLoss>(&*block)) losses.push_back(*loss);
  ASSERT_EQ(losses.size(), 1U);
  EXPECT_EQ(losses[0].first_tick, 20 * 20 - 1U);  // 20 ticks of 0.5 ms in a message
  EXPECT_EQ(losses[0].count, 1U);
  EXPECT_EQ(losses[0].why, schema::SessionLoss::Why::link);
}

TEST_F(PlayerOnSim, APlayedTextureThatIsNoNumberNeverGetsToTheDevice) {
  schema::Texture texture = grating();
  texture.signal.values[100] = std::nan("");
  PrepareOptions options;
  options.rate_hz = kRateHz;
  const auto prepared = prepare(texture, schema::read_transducer("wiertlewski2011").value(), options);
  ASSERT_FALSE(prepared);
  EXPECT_EQ(prepared.error().kind, schema::ErrorKind::unsuitable);
}

// 0.02 N at 0.5 mm/N are 10 um. The limit applies at load, to live gains, and while textures fade.
TEST_F(PlayerOnSim, TheTrayIsKeptWithinItsLimitOfDisplacement) {
  const auto limited = [this](double limit_m, double gain_m_per_n = 5e-4) {
    Program made = program("grating", gain_m_per_n);
    EXPECT_GT(made.tray_peak_m, 0.0199 * gain_m_per_n);
    EXPECT_LT(made.tray_peak_m, 0.0250 * gain_m_per_n) << "2 dB more, beyond the band";
    made.session.transducer.displacement_limit_m = limit_m;
    return made;
  };
  const auto refused = player_->load(limited(1e-6));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, schema::ErrorKind::unsuitable);
  EXPECT_NE(refused.error().remedy.find("mm/N"), std::string::npos) << refused.error().remedy;
  ASSERT_TRUE(player_->load(limited(25e-6)));
  EXPECT_FALSE(player_->gain(-2.6));
  ASSERT_TRUE(player_->arm(session_));
  ASSERT_TRUE(player_->play());
  run(0.2);
  EXPECT_FALSE(player_->gain(2.6));
  EXPECT_FALSE(player_->load(limited(25e-6, 25e-4)));
  ASSERT_TRUE(player_->load(limited(25e-6, 1e-4), 0.5));
  EXPECT_FALSE(player_->gain(4)) << "the old texture has not faded yet";
  run(0.7);
  ASSERT_TRUE(player_->gain(-4));
  EXPECT_EQ(player_->status().gain, -4);
  ASSERT_TRUE(player_->disarm());
}

// The samples of another file under the sidecar's default name are not played.
TEST_F(PlayerOnSim, ASessionHasTheSumOfTheFileThatTheSidecarNames) {
  const auto text = schema::read_file(folder_ / "grating.texture.json");
  ASSERT_TRUE(text);
  std::ofstream(folder_ / "other.texture.json") << *text;
  std::filesystem::copy_file(folder_ / "fine.texture.wav", folder_ / "other.texture.wav");
  const Program made = program("other");
  EXPECT_EQ(made.session.textures.front().sha256,
            schema::sha256_of_file(folder_ / "grating.texture.wav").value());
  EXPECT_TRUE(std::filesystem::path(made.session.textures.front().file).is_absolute());
  EXPECT_EQ(made.gain_m_per_n, 5e-4);
}

TEST_F(PlayerOnSim, WhatTheDeviceWouldRefuseByNumberIsToldByName) {
  PrepareOptions options;
  options.metres_per_count = player_->metres_per_count();
  const auto error_of = [&](double at_m) {
    const auto made =
        make_program({folder_ / "grating", at_m, {}, schema::Gain{5e-4, false}}, "wiertlewski2011", options);
    return made ? schema::Error{} : made.error();
  };
  EXPECT_EQ(error_of(10).what, "");
  EXPECT_NE(error_of(1e6).remedy.find("--at"), std::string::npos);
  options.onset_s = 20;
  EXPECT_NE(error_of(0).remedy.find("--onset"), std::string::npos);
  options.onset_s = 0.05;
  options.most_samples = 100;
  EXPECT_NE(error_of(0).where.find("grating.texture.json"), std::string::npos) << error_of(0).where;
}

TEST(DeviceLock, IsHeldByOneProgramAtATime) {
  const std::string name = "test " + std::to_string(getpid());
  auto held = DeviceLock::take(name);
  ASSERT_TRUE(held) << schema::message(held.error());
  const auto second = DeviceLock::take(name);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().kind, schema::ErrorKind::unsuitable);
  *held = DeviceLock();
  EXPECT_TRUE(DeviceLock::take(name));
}

TEST_F(PlayerOnSim, ASessionThatNeverBeganLeavesNoFile) {
  Program refused = program();
  refused.prepared.limits.onset_s = 1e6F;  // causes a refusal by the device
  ASSERT_TRUE(player_->load(std::move(refused)));
  ASSERT_FALSE(player_->arm(session_));
  EXPECT_FALSE(std::filesystem::exists(session_));
  EXPECT_EQ(player_->status().session, "");
  begin();
  ASSERT_TRUE(player_->disarm());
  EXPECT_EQ(player_->status().session, session_);
}

TEST_F(PlayerOnSim, WithoutRoomForTheSessionsBeginningNothingIsArmed) {
  begin();
  ASSERT_TRUE(player_->disarm());
  const std::uintmax_t whole = std::filesystem::file_size(session_);
  session_ = folder_ / "two.session";
  for (const std::uintmax_t bytes : {whole / 4, whole / 2, whole - 100}) {
    const FullDisk full(bytes);
    const auto armed = player_->arm(session_);
    ASSERT_FALSE(armed) << bytes << " of " << whole;
    EXPECT_EQ(armed.error().kind, schema::ErrorKind::cannot_write);
    EXPECT_NE(armed.error().remedy.find("free space"), std::string::npos);
    EXPECT_EQ(player_->state(), PlayerState::idle);
    EXPECT_FALSE(std::filesystem::exists(session_));
  }
  begin();
  ASSERT_TRUE(player_->disarm());
  expect_same_to_the_bit();
}

// A session without its commands, as after a full disk before arming was refused in that case.
TEST_F(PlayerOnSim, AReplayNamesTheCommandsThatAreMissing) {
  begin();
  run(0.1);
  ASSERT_TRUE(player_->disarm());
  auto reader = schema::SessionReader::open(session_);
  const std::string without = folder_ / "without.session";
  auto writer = schema::SessionWriter::create(without, reader->header());
  std::size_t commands = 0;
  while (auto block = reader->next()) {
    const auto* command = std::get_if<schema::SessionCommand>(&*block);
    const auto* some = std::get_if<std::vector<schema::SessionTick>>(&*block);
    const bool kept = command == nullptr || commands++ < 4;
    if (command != nullptr && kept) writer->add(*command);
    if (some != nullptr) writer->add(*some);
  }
  const auto replayed = replay_session(without);
  ASSERT_FALSE(replayed);
  EXPECT_EQ(replayed.error().kind, schema::ErrorKind::unsuitable);
  EXPECT_NE(replayed.error().what.find("samples of its upload"), std::string::npos) << replayed.error().what;
  const auto told = report_strokes(without);
  ASSERT_TRUE(told);
  EXPECT_TRUE(std::ranges::any_of(told->notes, [](const std::string& note) {
    return note.find("samples of its upload") != std::string::npos;
  }));
}

// The largest gain is negative: the texture is inverted.
TEST_F(PlayerOnSim, ANegativeGainTurnsTheTextureOver) {
  const Program up = program("grating", 5e-4), down = program("grating", -5e-4);
  ASSERT_EQ(up.prepared.samples.size(), down.prepared.samples.size());
  EXPECT_EQ(up.prepared.gain_m_per_n, down.prepared.gain_m_per_n);
  EXPECT_EQ(down.session.textures.front().gain_m_per_n, -5e-4);
  for (std::size_t i = 0; i < up.prepared.samples.size(); ++i)
    ASSERT_EQ(up.prepared.samples[i], -down.prepared.samples[i]);
}

TEST_F(PlayerOnSim, AGainIsAmongTheSessionsEvents) {
  begin();
  ASSERT_TRUE(player_->gain(0.75));
  ASSERT_TRUE(player_->play());
  run(0.1);
  const std::uint64_t ticks = ticks_here();
  ASSERT_TRUE(player_->gain(-0.5));
  run(0.1);
  ASSERT_TRUE(player_->disarm());
  std::vector<schema::SessionEvent> gains;
  auto reader = schema::SessionReader::open(session_);
  for (const auto& event : session_totals(*reader).events)
    if (event.text.starts_with("gain")) gains.push_back(event);
  ASSERT_EQ(gains.size(), 2U);
  EXPECT_EQ(gains[0].text, "gain 0.75");
  EXPECT_EQ(gains[1].text, "gain -0.5");
  EXPECT_GE(gains[1].tick, ticks);
}

TEST_F(PlayerOnSim, ADeviceThatDoesNotAnswerIsLostOnceAndForAll) {
  begin();
  ASSERT_TRUE(player_->play());
  run(0.2);
  std::vector<std::string> told;
  player_->listen(
      [&](PlayerState state, const std::string&, double) { told.emplace_back(to_string(state)); });
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

TEST_F(PlayerOnSim, WhoReadsAStrokeHearsHowFarItIs) {
  begin();
  ASSERT_TRUE(player_->play());
  run(1);
  ASSERT_TRUE(player_->disarm());
  std::vector<double> heard;
  const auto stroke = read_session_stroke(session_, 0, [&](double part) { heard.push_back(part); });
  ASSERT_TRUE(stroke) << schema::message(stroke.error());
  ASSERT_FALSE(heard.empty());
  EXPECT_TRUE(std::ranges::is_sorted(heard));
  EXPECT_GT(heard.front(), 0);
  EXPECT_DOUBLE_EQ(heard.back(), 1);
}

}  // namespace
}  // namespace tacto::playback
