// SPDX-License-Identifier: GPL-3.0-or-later
// Shares of textures in a session's rows, against the kernel's own texture player.
#include "playback/strokes/judged_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware-host/core/kernel/texture_player.hpp"

namespace tacto::playback {
namespace {

constexpr std::size_t kRows = 400;

struct Rows {
  std::vector<SessionRow> rows;
  std::vector<TextureChange> turns;
};

Rows rows_with(const std::vector<TextureChange>& turns) {
  Rows all{std::vector<SessionRow>(kRows), turns};
  for (std::size_t i = 0; i < kRows; ++i) {
    all.rows[i].tick = i;
    all.rows[i].gain = i < 120 ? 1 : i < 128 ? 0.25 : 3;
    all.rows[i].turns = static_cast<std::uint32_t>(
        std::ranges::count_if(turns, [&](const TextureChange& turn) { return turn.row <= i; }));
  }
  return all;
}

TextureChange turn_at(std::size_t row, double fade_ticks) {
  return {row, fade_ticks, schema::SessionProgram{}, 0};
}

/// The kernel's output for textures that are 1, 10, 100 ... everywhere, with these gains.
std::vector<double> played(const Rows& columns) {
  std::vector<std::array<float, 8>> samples(columns.turns.size() + 1);
  float value = 1;
  for (auto& texture : samples) texture.fill(value), value *= 10;
  const auto setup = [&](std::size_t set) {
    const core::ProfileScale scale{8, 0, 0, UINT64_C(1) << 32, wire::ProfileEnds::loop};
    return core::TextureSetup{core::Profile(samples[set].data(), scale), {}, 0};
  };
  core::TexturePlayer player;
  player.set(setup(0), 20);
  std::vector<double> target;
  for (std::size_t row = 0, next = 0; row < kRows; ++row) {
    for (; next < columns.turns.size() && columns.turns[next].row == row; ++next)
      player.change(setup(next + 1), static_cast<float>(columns.turns[next].fade_ticks));
    target.push_back(player.target(0, static_cast<float>(columns.rows[row].gain)));
  }
  return target;
}

TextureMix mix_of(const Rows& all, const std::vector<bool>& known) {
  MixFollower follower;
  std::vector<MixRow> rows;
  for (const SessionRow& row : all.rows) rows.push_back(follower.next(row, all.turns));
  return texture_mix(rows, known);
}

std::vector<double> mixed(const Rows& all) {
  const TextureMix mix = mix_of(all, std::vector<bool>(all.turns.size() + 1, true));
  GainFollower follower(2000);
  std::vector<double> gain, sum(kRows, 0.0);
  for (const SessionRow& row : all.rows) gain.push_back(follower.next(row));
  double value = 1;
  for (const MixedSet& set : mix.sets) {
    for (std::size_t i = 0; i < set.part.size(); ++i)
      sum[set.first + i] += gain[set.first + i] * value * double{set.part[i]};
    value *= 10;
  }
  return sum;
}

// Single precision: the rounding of four operations, 2^-24 each of the largest texture, times the gain.
void expect_as_played(const std::vector<TextureChange>& turns) {
  const Rows columns = rows_with(turns);
  const auto target = played(columns), here = mixed(columns);
  const double rounding = 4 * 0x1p-24 * 3 * std::pow(10.0, static_cast<double>(turns.size()));
  for (std::size_t row = 0; row < kRows; ++row)
    ASSERT_NEAR(here[row], target[row], rounding) << "row " << row;
}

TEST(TextureMix, IsWhatTheKernelPlays) {
  expect_as_played({});
  expect_as_played({turn_at(100, 60), turn_at(250, 100)});
  expect_as_played({turn_at(0, 30), turn_at(390, 100)});
  expect_as_played({turn_at(50, 0), turn_at(60, 1), turn_at(70, 1.5)});
}

// A second change before the end of the first begins from the texture with the larger weight.
TEST(TextureMix, ASecondChangeInAFadeIsTheKernelsToo) {
  expect_as_played({turn_at(100, 60), turn_at(110, 60)});
  expect_as_played({turn_at(100, 60), turn_at(150, 60)});
  expect_as_played({turn_at(100, 60), turn_at(130, 60), turn_at(140, 200)});
}

TEST(TextureMix, WhatIsNotKnownIsStoodInFor) {
  const Rows columns = rows_with({turn_at(100, 64), turn_at(200, 64)});
  const TextureMix mix = mix_of(columns, {true, false, true});
  EXPECT_TRUE(mix.sets[1].part.empty());
  EXPECT_EQ(mix.sets[0].part.size(), 264U);
  for (std::size_t row = 0; row < 200; ++row) ASSERT_FLOAT_EQ(mix.sets[0].part[row], 1) << row;
  for (std::size_t row = 0; row < kRows; ++row) ASSERT_EQ(mix.unknown[row], row >= 100 && row < 264) << row;
  const TextureMix none = mix_of(columns, {false, false, true});
  EXPECT_TRUE(none.sets[0].part.empty());
  EXPECT_EQ(none.sets[2].first, 200U);
  EXPECT_TRUE(none.unknown[0]);
}

// A fade does not continue in rows that were inserted for missing ticks.
TEST(TextureMix, ARowWithoutATickIsNoTick) {
  Rows columns = rows_with({turn_at(100, 50)});
  for (std::size_t row = 120; row < 140; ++row) columns.rows[row].put_in = true;
  const TextureMix mix = mix_of(columns, {true, true});
  for (std::size_t row = 120; row < 140; ++row)
    ASSERT_EQ(mix.sets[1].part[row - 100], mix.sets[1].part[19]) << row;
  EXPECT_GT(mix.sets[1].part[40], mix.sets[1].part[39]);
}

}  // namespace
}  // namespace tacto::playback
