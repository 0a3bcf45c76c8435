// SPDX-License-Identifier: GPL-3.0-or-later
// The texture changes during playback: the drive, the record, and refused changes.
#include <fmt/format.h>

#include "playback/prepare/texture_change.hpp"
#include "tests/playback/player_on_sim.hpp"

namespace tacto::playback {
namespace {

/// The largest difference of ticks [from, to) from a kernel that has played this program all the time, re
/// their RMS.
double difference_from(const std::vector<schema::SessionTick>& ticks, const Program& program, double factor,
                       std::size_t from, std::size_t to) {
  core::TickKernel kernel;
  kernel.set(program.prepared.setup());
  const auto gain = static_cast<float>(factor * program.prepared.gain_m_per_n);
  double most = 0, square = 0;
  for (std::size_t i = 0; i < to; ++i) {
    const bool raise = (ticks[i].flags & wire::kTickPlaying) != 0;
    const double drive_v = kernel.tick({ticks[i].encoder, gain, raise, core::kNoForce}).drive_v;
    if (i < from) continue;
    most = std::max(most, std::abs(drive_v - ticks[i].drive_v));
    square += drive_v * drive_v / static_cast<double>(to - from);
  }
  return most / std::sqrt(square);
}

double largest_step_v(const std::vector<schema::SessionTick>& ticks, std::size_t from, std::size_t to) {
  double most = 0;
  for (std::size_t i = std::max<std::size_t>(from, 1); i < to; ++i)
    most = std::max(most, std::abs(double{ticks[i].drive_v} - ticks[i - 1].drive_v));
  return most;
}

// The gain was halved before and does not change; each texture is then played as if there had been no other.
TEST_F(PlayerOnSim, ATextureChangesInMidStrokeWithoutAStepAndReplaysToTheBit) {
  begin();
  ASSERT_TRUE(player_->play());
  run(0.5);
  ASSERT_TRUE(player_->gain(0.5));
  run(0.4);
  const std::size_t before = ticks_here();
  const auto changed = player_->load(program("fine", 8e-4), 0.1);
  ASSERT_TRUE(changed) << schema::message(changed.error());
  EXPECT_EQ(player_->state(), PlayerState::playing);
  run(0.4);
  const std::size_t after = ticks_here();
  ASSERT_TRUE(player_->gain(0.9));
  run(0.4);
  const std::size_t louder = ticks_here();
  ASSERT_TRUE(player_->load(program())) << "and back";
  run(0.4);
  ASSERT_TRUE(player_->disarm());
  const auto all = ticks();
  const auto in_ms = [](double ms) { return static_cast<std::size_t>(ms * kRateHz / 1000); };
  EXPECT_LT(difference_from(all, program(), 0.5, before - in_ms(200), before - in_ms(20)), 1e-6);
  EXPECT_LT(difference_from(all, program("fine", 8e-4), 0.5, before + in_ms(200), after - in_ms(20)), 1e-5);
  EXPECT_LT(difference_from(all, program("fine", 8e-4), 0.9, after + in_ms(100), louder - in_ms(20)), 1e-5);
  EXPECT_LT(difference_from(all, program(), 0.9, louder + in_ms(200), all.size() - in_ms(100)), 1e-5);
  EXPECT_GT(difference_from(all, program(), 0.5, before + in_ms(200), after - in_ms(20)), 0.5);
  const double steepest = std::max(largest_step_v(all, before - in_ms(200), before),
                                   largest_step_v(all, after - in_ms(150), after));
  EXPECT_LT(largest_step_v(all, before, before + in_ms(200)), 1.2 * steepest);
  const auto said = events();
  const auto is_change = [](const std::string& text) { return text.starts_with("texture changed to "); };
  EXPECT_EQ(std::ranges::count_if(said, is_change), 2);
  EXPECT_EQ(std::ranges::count(said, "texture changed to " + program("fine").name()), 1);
  expect_same_to_the_bit();
}

TEST_F(PlayerOnSim, WhatWasChangedToIsArmedNext) {
  begin();
  ASSERT_TRUE(player_->load(program("fine", 8e-4))) << "armed";
  ASSERT_TRUE(player_->play());
  run(0.3);
  ASSERT_TRUE(player_->disarm());
  expect_same_to_the_bit();
  session_ = folder_ / "two.session";
  ASSERT_TRUE(player_->arm(session_));
  ASSERT_TRUE(player_->play());
  run(0.5);
  ASSERT_TRUE(player_->disarm());
  auto reader = schema::SessionReader::open(session_);
  EXPECT_EQ(reader->header().textures.at(0).file, program("fine").name());
  EXPECT_EQ(reader->header().textures.at(0).gain_m_per_n, 8e-4);
  const auto all = ticks();
  EXPECT_LT(difference_from(all, program("fine", 8e-4), 1, 200, 900), 1e-6);
  expect_same_to_the_bit();
}

TEST_F(PlayerOnSim, AChangeWaitsForTheOneBefore) {
  begin();
  ASSERT_TRUE(player_->play());
  ASSERT_TRUE(player_->load(program("fine"), 0.2));
  run(0.1);
  const auto early = player_->load(program());
  ASSERT_FALSE(early);
  EXPECT_EQ(early.error().remedy, "load again later");
  run(0.2);
  EXPECT_TRUE(player_->load(program()));
  ASSERT_TRUE(player_->disarm());
  expect_same_to_the_bit();
}

TEST_F(PlayerOnSim, WhatCanNotBeChangedToLeavesTheOtherPlaying) {
  begin();
  ASSERT_TRUE(player_->play());
  run(0.2);
  const auto other_rate = player_->load(program("fine", 5e-4, 4000));
  ASSERT_FALSE(other_rate);
  EXPECT_EQ(other_rate.error().kind, schema::ErrorKind::unsuitable);
  EXPECT_NE(other_rate.error().what.find("4000 "), std::string::npos);
  EXPECT_EQ(other_rate.error().remedy, "disarm first, then load");
  run(0.2);
  EXPECT_EQ(player_->state(), PlayerState::playing);
  ASSERT_TRUE(player_->disarm());
  EXPECT_LT(difference_from(ticks(), program(), 1, 200, ticks().size() - 100), 1e-6);
  expect_same_to_the_bit();
}

// Also if the link fails in the middle of it: a change without effect must not cause a fault in the replay.
TEST_F(PlayerOnSim, AnUploadThatComesToNothingReplays) {
  jump_s_ = 0.6;
  begin();
  ASSERT_TRUE(player_->play());
  run(0.2);
  const wire::ProfileBegin next{64, 0, 0, UINT64_C(1) << 32, wire::ProfileEnds::loop};
  ASSERT_TRUE(device_->client().command(next));
  run(0.1);
  ASSERT_TRUE(player_->load(program("fine")));
  run(0.2);
  ASSERT_TRUE(device_->client().command(next));
  ASSERT_TRUE(device_->client().command(wire::ProfileChunk{0, 8, {}}));
  run(0.3);
  EXPECT_EQ(player_->state(), PlayerState::fault);
  ASSERT_TRUE(player_->disarm());
  expect_same_to_the_bit();
}

TEST(TextureChange, OnlyWhatBelongsToTheTextureMayDiffer) {
  const auto transducer = schema::read_transducer("wiertlewski2011").value();
  const auto prepared_with = [&](auto set) {
    PrepareOptions options;
    set(options);
    return prepare(grating(), transducer, options).value();
  };
  const Prepared playing = prepared_with([](PrepareOptions&) {});
  const auto room = static_cast<std::uint32_t>(playing.samples.size());
  EXPECT_TRUE(check_texture_change(playing, playing, 2 * room));
  const auto too_large = check_texture_change(playing, playing, 2 * room - 1);
  ASSERT_FALSE(too_large);
  EXPECT_NE(too_large.error().what.find(fmt::format("the memory beside the playing one holds {}", room - 1)),
            std::string::npos);
  EXPECT_FALSE(check_texture_change(playing, playing, room / 2));
  const auto may = [&](auto set) {
    return check_texture_change(playing, prepared_with(set), 4 * room).has_value();
  };
  EXPECT_TRUE(may([](PrepareOptions& o) { o.gain_m_per_n = 0.2, o.ends = Ends::loop, o.seam_m = 2e-3; }));
  EXPECT_TRUE(
      may([](PrepareOptions& o) { o.interpolation = wire::Interpolation::sinc, o.origin_count = 9; }));
  EXPECT_FALSE(may([](PrepareOptions& o) { o.rate_hz = 2001; }));
  EXPECT_FALSE(may([](PrepareOptions& o) { o.inverse = Inverse::none; }));
  EXPECT_FALSE(may([](PrepareOptions& o) { o.between_counts = false; }));
  EXPECT_FALSE(may([](PrepareOptions& o) { o.energy_rms_v = 1; }));
  EXPECT_FALSE(may([](PrepareOptions& o) { o.contact_on_n = 1; }));
}

}  // namespace
}  // namespace tacto::playback
