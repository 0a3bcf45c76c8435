// SPDX-License-Identifier: GPL-3.0-or-later
// Clay in the kernel: what presses remove to the unit, along a random path beside whole numbers, and in
// double precision; a surface that sinks is never above the ghost point.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "data-schema/height/height_map.hpp"
#include "firmware-host/core/scene/clay.hpp"
#include "firmware-host/core/scene/scene_kernel.hpp"
#include "playback/prepare/scene/clay_block.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/render/reference/exact_relief.hpp"
#include "playback/render/reference/exact_scene.hpp"
#include "tests/playback/arm_on_pieces.hpp"

namespace tacto::playback {
namespace {

using PressedPlace = ArmOnPieces::Place;

constexpr int kClayColumns = 21, kClayRows = 17;
constexpr double kClayPitch_m = 1e-3, kClayStiffness = 2000;

schema::Piece clay_of(const std::string& name, double sink_m_per_s, double thickness_m, bool kept,
                      const std::function<double(int, int)>& height_m = {}) {
  schema::HeightMap map;
  map.columns = kClayColumns, map.rows = kClayRows, map.pitch_m = kClayPitch_m;
  for (int row = 0; row < kClayRows; ++row)
    for (int column = 0; column < kClayColumns; ++column)
      map.height_m.push_back(height_m ? static_cast<float>(height_m(column, row)) : 0.0F);
  schema::Piece clay;
  clay.name = "clay";
  clay.stiffness_n_per_m = kClayStiffness;
  clay.relief.emplace();
  clay.relief->file = schema::height_map_path(testing::TempDir() + name);
  EXPECT_TRUE(schema::write_height_map(clay.relief->file, map, schema::Existing::replace));
  clay.clay = schema::Clay{1, sink_m_per_s, thickness_m, kept};
  return clay;
}

struct OnClay : ArmOnPieces {
  double unit_m = 0;
  std::vector<std::int64_t> before;

  explicit OnClay(const schema::Piece& clay) : ArmOnPieces({clay}) {
    const schema::Clay& rule = *scene.pieces.front().clay;
    unit_m = std::exp2(std::ceil(std::log2(std::max(std::abs(rule.least_m), std::abs(rule.most_m)))) - 24);
    before = heights();
  }
  const core::ReliefPieceTable& table() const {
    const core::SceneView now = kernel.scene_now();
    return core::table_of<core::ReliefPieceTable>(now, now.layers[0]);
  }
  std::vector<float> heights_m() const {
    const core::ReliefTable& relief = core::relief_of(table());
    const float* const first = core::coefficients_of(relief, core::levels_of(relief)[0]);
    return {first, first + core::coefficient_count(relief)};
  }
  // In units: whole numbers.
  std::vector<std::int64_t> heights() const {
    std::vector<std::int64_t> whole;
    for (const float height_m : heights_m()) {
      whole.push_back(std::llround(double{height_m} / unit_m));
      EXPECT_EQ(static_cast<double>(whole.back()) * unit_m, double{height_m});
    }
    return whole;
  }
  std::int64_t half() const { return std::llround(scene.pieces.front().clay->half_m / unit_m); }
  // As it is now.
  Relief surface() const {
    Relief relief = scene.reliefs.of(*scene.pieces.front().relief);
    relief.levels.front().coefficients = heights_m();
    return relief;
  }
};

// The middle of a cell, from the centre of the map.
PressedPlace in_cell(int column, int row, double z_m) {
  return {kClayPitch_m * (column + 0.5 - (kClayColumns - 1) / 2.0),
          kClayPitch_m * (row + 0.5 - (kClayRows - 1) / 2.0), z_m};
}

TEST(SceneClay, TicksOnACellsMiddleRemoveExactlyEightTimesTheirStep) {
  constexpr int kTicks = 50, kColumn = 8, kRow = 6;
  for (const bool kept : {false, true}) {
    OnClay on(clay_of("flat", 2e-3, 5e-3, kept));
    EXPECT_NEAR(on.scene.pieces.front().clay->half_m, 1e-6, 0.001e-6);
    on.at(in_cell(kColumn, kRow, 1e-3));
    on.at(in_cell(kColumn, kRow, -4e-4));  // 0.8 N: below the threshold
    EXPECT_EQ(on.heights(), on.before);
    for (int i = 0; i < kTicks; ++i) EXPECT_GT(on.at(in_cell(kColumn, kRow, -3e-3))[2], 1);
    const std::vector<std::int64_t> after = on.heights();
    std::int64_t removed = 0;
    for (int row = 0; row < kClayRows; ++row)
      for (int column = 0; column < kClayColumns; ++column) {
        const auto i = static_cast<std::size_t>(row * kClayColumns + column);
        removed += on.before[i] - after[i];
        const double x = column - kColumn - 0.5, y = row - kRow - 0.5, r2 = x * x + y * y;
        double share = 0;  // of d n
        if (std::max(std::abs(x), std::abs(y)) < 2)
          share = 9.0 / 8 * (1 - r2 / 4.5);
        else if (kept && r2 < 9)
          share = -0.5;
        EXPECT_EQ(static_cast<double>(on.before[i] - after[i]),
                  share * static_cast<double>(2 * on.half() * kTicks))
            << kept << column << ' ' << row;
      }
    EXPECT_EQ(removed, kept ? 0 : 8 * 2 * on.half() * kTicks);
    // Until the force is that of the threshold.
    double last_n = 0;
    for (int i = 0; i < 3000; ++i) last_n = on.at(in_cell(kColumn, kRow, -3e-3))[2];
    EXPECT_LE(last_n, 1);
    EXPECT_GT(last_n, 0.98);
    // Armed again: as in the block, and the same bits.
    on.kernel.set(on.view, on.setup, on.live.data());
    EXPECT_EQ(on.heights(), on.before);
    on.at(in_cell(kColumn, kRow, 1e-3));
    on.at(in_cell(kColumn, kRow, -4e-4));
    for (int i = 0; i < kTicks; ++i) on.at(in_cell(kColumn, kRow, -3e-3));
    EXPECT_EQ(on.heights(), after);
  }
}

// In whole numbers.
struct WholeClay {
  std::vector<std::int64_t> height;
  std::int64_t half, least, most;
  bool kept;

  std::int64_t* at(int column, int row) {
    const bool there = column >= 0 && row >= 0 && column < kClayColumns && row < kClayRows;
    return there ? &height[static_cast<std::size_t>(row * kClayColumns + column)] : nullptr;
  }
  // Distances in halves of a grid step, from the middle of the cell.
  void press(int column, int row) {
    if (column < 0 || row < 0 || column + 1 >= kClayColumns || row + 1 >= kClayRows) return;
    for (int y = -3; y <= 3; y += 2)
      for (int x = -3; x <= 3; x += 2) {
        const int r2 = x * x + y * y, parts = r2 == 2 ? 2 : 1;
        if (r2 == 18) continue;
        std::int64_t* const from = at(column + (x + 1) / 2, row + (y + 1) / 2);
        bool moves = from != nullptr && *from - parts * half >= least;
        // Of the corner those at (5, 3) and (3, 5), of an edge that beside it.
        std::vector<std::int64_t*> rise;
        for (int k = 0; k < parts && kept; ++k) {
          const int to_x = r2 == 2            ? x * (k == 0 ? 5 : 3)
                           : std::abs(x) == 3 ? x / 3 * 5
                                              : x,
                    to_y = r2 == 2            ? y * (k == 0 ? 3 : 5)
                           : std::abs(y) == 3 ? y / 3 * 5
                                              : y;
          rise.push_back(at(column + (to_x + 1) / 2, row + (to_y + 1) / 2));
          moves = moves && rise.back() != nullptr && *rise.back() + half <= most;
        }
        if (!moves) continue;
        *from -= parts * half;
        for (std::int64_t* const each : rise) *each += half;
      }
  }
};

TEST(SceneClay, ARandomPathPressesWhatWholeNumbersSay) {
  for (const bool kept : {false, true}) {
    OnClay on(clay_of("hills", 0.02, 6e-4, kept, [](int column, int row) {
      return 4e-4 * std::sin(0.7 * column + 1) * std::cos(0.5 * row);
    }));
    const schema::Clay& rule = *on.scene.pieces.front().clay;
    WholeClay whole{on.before, on.half(), std::llround(rule.least_m / on.unit_m),
                    std::llround(rule.most_m / on.unit_m), kept};
    std::mt19937_64 random(33);
    const auto anywhere = [&](double half_m) {
      return 2 * half_m * (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5);
    };
    PressedPlace hand = {0, 0, 2e-3}, goal = {};
    double deepest_m = 0;
    long presses = 0;
    for (int tick = 0; tick < 30'000; ++tick) {
      if (tick % 100 == 99) goal = {anywhere(0.012), anywhere(0.01), -8e-4 + anywhere(1.6e-3)};
      for (std::size_t i = 0; i < 3; ++i) hand[i] += 0.02 * (goal[i] - hand[i]);
      const Relief surface = on.surface();
      const PressedPlace force_n = on.at(hand);
      const PressedPlace ghost = {double{on.kernel.ghost_m(0)}, double{on.kernel.ghost_m(1)},
                                  double{on.kernel.ghost_m(2)}};
      const ReliefLevel& level = surface.levels.front();
      const double u = place_on_level(surface, level, 0, ghost[0]),
                   v = place_on_level(surface, level, 1, ghost[1]);
      deepest_m = std::max(deepest_m, spline_of(level, u, v).value - ghost[2]);
      const double size_n = std::hypot(force_n[0], force_n[1], force_n[2]);
      const std::vector<std::int64_t> now = on.heights();
      // Where rounding decides, the kernel does.
      if (std::abs(size_n - 1) < 1e-5 ? now != whole.height : size_n > 1)
        ++presses, whole.press(static_cast<int>(std::floor(u)), static_cast<int>(std::floor(v)));
      ASSERT_EQ(now, whole.height) << tick << ' ' << size_n << ' ' << u << ' ' << v;
    }
    EXPECT_GT(presses, 3000);
    EXPECT_LT(deepest_m, 1.5e-6);  // GhostPoint states 1e-6 along the normal
    const std::vector<std::int64_t> after = on.heights();
    EXPECT_LT(*std::ranges::min_element(after), whole.least + whole.half) << "it met the bottom";
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < after.size(); ++i) sum += on.before[i] - after[i];
    EXPECT_EQ(sum > 0, !kept);
    if (kept) EXPECT_EQ(sum, 0);
    const double bend_per_m = on.surface().curvature_per_m(INFINITY, INFINITY);
    EXPECT_LE(bend_per_m, 1.00001 * double{on.table().bend_per_m});
    std::printf("[ measured ] %ld presses, deepest %.2g um inside, bend %.3g of %.3g /m\n", presses,
                1e6 * deepest_m, bend_per_m, double{on.table().bend_per_m});
  }
}

// The hand is so deep that the force is above the threshold in both, and the ridges so low that the ghost
// slides over them within a tick: where it needs more (GhostPoint), it presses other cells.
TEST(SceneClay, TheKernelIsTheReference) {
  for (const bool kept : {false, true}) {
    OnClay on(clay_of("plain", kept ? 5e-4 : 4e-3, 4e-3, kept, [](int column, int row) {
      return 2e-4 * std::sin(0.6 * column) * std::cos(0.4 * row);
    }));
    for (int i = 0; i < 3000; ++i) {
      const double t = 1e-3 * i;
      on.compare_at({4e-3 * std::sin(2 * t), 3e-3 * std::cos(3.1 * t), 1e-3 - 3e-3 * std::min(t, 1.0)});
    }
    std::printf("[ measured ] clay: %.2g of %.3g N\n", on.largest_error_n, on.largest_n);
    EXPECT_GT(on.largest_n, 2);
    EXPECT_LT(on.largest_error_n, 2e-5 * on.largest_n);
  }
}

// The spring falls with the surface; what rises around does not touch the point.
TEST(SceneClay, PressingGivesNoEnergy) {
  for (const bool kept : {false, true})
    for (const double sink_m_per_s : {1e-3, 0.1}) {
      OnClay on(clay_of("work", sink_m_per_s, 3e-3, kept));
      double work_j = 0;
      PressedPlace last_m = {0, 0, 1e-3}, last_n = on.at(last_m);
      for (int i = 1; i <= 20'000; ++i) {
        const double t = 1e-3 * i;
        const PressedPlace hand = {4e-3 * std::sin(1.1 * t), 3e-3 * std::sin(1.7 * t),
                                   1e-3 * std::cos(6.283185307179586 * 0.5 * t)};
        const PressedPlace force_n = on.at(hand);
        for (std::size_t k = 0; k < 3; ++k) work_j += 0.5 * (force_n[k] + last_n[k]) * (hand[k] - last_m[k]);
        last_m = hand, last_n = force_n;
      }
      EXPECT_LE(work_j, 1e-7) << kept << sink_m_per_s;
    }
}

TEST(SceneClay, ABlockWithAWrongRuleIsRefused) {
  const OnClay on(clay_of("block", 2e-3, 5e-3, true));
  const auto fault_with = [&](auto change) {
    std::vector<std::uint32_t> words = on.scene.words;
    const auto bytes = static_cast<std::uint32_t>(words.size() * sizeof(std::uint32_t));
    const core::SceneView& view = on.view;
    const std::size_t at = static_cast<std::size_t>(view.tables - on.scene.words.data());
    change(reinterpret_cast<core::ReliefPieceTable*>(words.data() + at)->clay);
    reinterpret_cast<core::SceneHeader*>(words.data())->check = core::scene_check(words.data(), bytes);
    core::SceneView read;
    return core::read_scene_block(words.data(), bytes, read);
  };
  EXPECT_EQ(fault_with([](core::ClayTable&) {}), core::SceneFault::none);
  EXPECT_EQ(fault_with([](core::ClayTable& t) { t.force_n = NAN; }), core::SceneFault::value);
  EXPECT_EQ(fault_with([](core::ClayTable& t) { t.force_n = -1; }), core::SceneFault::value);
  EXPECT_EQ(fault_with([](core::ClayTable& t) { t.half_m = 2; }), core::SceneFault::value);
  EXPECT_EQ(fault_with([](core::ClayTable& t) { t.least_m = -INFINITY; }), core::SceneFault::value);
  EXPECT_EQ(fault_with([](core::ClayTable& t) { t.most_m = t.least_m - 1; }), core::SceneFault::value);
  EXPECT_EQ(fault_with([](core::ClayTable& t) { t.kept = 2; }), core::SceneFault::value);
}

// The block, the numbers and the tables once more.
TEST(SceneClay, ItsRoomIsTwiceItsTables) {
  const OnClay on(clay_of("room", 2e-3, 5e-3, false));
  EXPECT_EQ(on.view.live_words(), on.view.words_before_tables() + on.view.table_words);
  EXPECT_EQ(on.scene.room_bytes(), on.scene.bytes() + 4 * on.view.table_words);
  const std::string remedy = on.scene.remedy_for(on.scene.room_bytes() - 8 * 100);
  EXPECT_NE(remedy.find(std::to_string(kClayColumns * kClayRows - 100)), std::string::npos) << remedy;
}

}  // namespace
}  // namespace tacto::playback
