// SPDX-License-Identifier: GPL-3.0-or-later
// Planes that a height map raises: the ghost point on the exact surface, its work, hills that it does not
// pass, the reference in double precision, and normals of a map over a flat surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "data-schema/height/height_map.hpp"
#include "firmware-host/core/scene/piece_relief.hpp"
#include "firmware-host/core/scene/scene_kernel.hpp"
#include "playback/prepare/scene/judged_piece.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/render/reference/exact_relief.hpp"
#include "playback/render/reference/exact_scene.hpp"
#include "tests/playback/arm_on_pieces.hpp"

namespace tacto::playback {
namespace {

using schema::Piece;
using InSpace = ArmOnPieces::Place;

constexpr double kReliefPitch_m = 2e-4;

// Heights up to 0.5 mm, with hills of a radius of 1.5 mm and more.
double hills_m(double u, double v) {
  return 3e-4 * std::sin(1200 * u + 1) * std::cos(900 * v) + 2e-4 * std::sin(700 * u - 800 * v);
}

// 36 mm x 32 mm, `height_m` by the place from its centre.
schema::PieceRelief relief_of(const std::string& name,
                              const std::function<double(double, double)>& height_m) {
  schema::HeightMap map;
  map.columns = 181, map.rows = 161, map.pitch_m = kReliefPitch_m;
  for (int j = -80; j <= 80; ++j)
    for (int i = -90; i <= 90; ++i)
      map.height_m.push_back(static_cast<float>(height_m(kReliefPitch_m * i, kReliefPitch_m * j)));
  const std::string path = schema::height_map_path(testing::TempDir() + name);
  EXPECT_TRUE(schema::write_height_map(path, map, schema::Existing::replace));
  schema::PieceRelief relief;
  relief.file = path;
  return relief;
}

Piece raised_floor() {
  Piece floor;
  floor.name = "floor";
  floor.stiffness_n_per_m = 2000;
  floor.relief = relief_of("hills", hills_m);
  return floor;
}

Piece wall_at(double x_m) {
  Piece wall;
  wall.name = "wall", wall.stiffness_n_per_m = 2000;
  wall.x_m = x_m, wall.direction = {1, 0, 0};
  return wall;
}

// The height of the relief of an upright floor at the origin.
double height_below(const ArmOnPieces& on, const InSpace& place_m) {
  const Relief& relief = on.scene.reliefs.of(*on.scene.pieces.front().relief);
  const ReliefLevel& level = relief.levels.front();
  return spline_of(level, place_on_level(relief, level, 0, place_m[0]),
                   place_on_level(relief, level, 1, place_m[1]))
      .value;
}

TEST(PieceReliefTest, ThroughTheHeightsOfTheMap) {
  ArmOnPieces on({raised_floor()});
  for (const auto& [i, j] : {std::pair{0, 0}, {13, -40}, {-70, 61}}) {
    const InSpace place = {kReliefPitch_m * i, kReliefPitch_m * j, 0};
    const double height_m = hills_m(place[0], place[1]);
    EXPECT_NEAR(height_below(on, place), height_m, 1e-9);
    on.at({place[0], place[1], 2e-3});
    EXPECT_EQ(on.at({place[0], place[1], height_m + 2e-6})[2], 0);
    EXPECT_GT(on.at({place[0], place[1], height_m - 2e-6})[2], 0);
  }
}

// The second derivative of the height along a way, by a difference of the spline in double precision: its
// third derivative, some 1e6 / m^2, changes it by less than 10 per m over 1 um; single precision by less than
// 0.1.
TEST(PieceReliefTest, TheBendAlongAWayIsThatOfTheSpline) {
  const ArmOnPieces on({raised_floor()});
  const auto& table = core::table_of<core::ReliefPieceTable>(on.view, on.view.layers[0]);
  constexpr double kStep_m = 1e-6;
  double largest = 0;
  for (int i = 0; i < 200; ++i) {
    const double x = 4e-3 * std::sin(1.7 * i), y = 3e-3 * std::cos(2.3 * i), u = std::sin(0.9 * i),
                 v = std::cos(0.9 * i);
    const auto height = [&](double by_u, double by_v) { return height_below(on, {x + by_u, y + by_v, 0}); };
    const auto slope = [&](double by_u, double by_v) {
      return (height(by_u, by_v) - height(-by_u, -by_v)) / (2 * kStep_m);
    };
    const double bend = (height(kStep_m * u, kStep_m * v) - 2 * height(0, 0) +
                         height(-kStep_m * u, -kStep_m * v)) /
                        (kStep_m * kStep_m),
                 steep = std::hypot(1, slope(kStep_m, 0), slope(0, kStep_m));
    const float found = core::relief_bend(table, {static_cast<float>(x), static_cast<float>(y), 0},
                                          {static_cast<float>(u), static_cast<float>(v), 0});
    EXPECT_NEAR(double{found}, std::max(0.0, bend / steep), 10) << i;
    largest = std::max(largest, std::abs(bend));
  }
  EXPECT_GT(largest, 300);
}

// Places are in single precision from the origin of the piece: the bound is that of the issue.
TEST(PieceReliefTest, TheKernelIsTheReference) {
  Piece tilted = raised_floor(), rough = raised_floor();
  tilted.direction = {1, -2, 8}, tilted.relief->axes = {{{0, 3, 0}, {-1, 1, 0}}}, tilted.x_m = 1e-3;
  rough.static_friction = 0.5, rough.kinetic_friction = 0.3, rough.damping_n_s_per_m = 2;
  Piece flat = raised_floor();
  flat.relief->interpolated = true;
  for (const std::vector<Piece>& pieces :
       {std::vector{raised_floor()}, {tilted}, {rough}, {flat}, {raised_floor(), wall_at(-3e-3)}})
    for (const double by : {1.0, 6.0}) {
      ArmOnPieces on(pieces);
      for (int i = 0; i < 4000; ++i) {
        const double t = 1e-3 * by * i;
        on.compare_at(
            {4e-3 * std::sin(2 * t), 3e-3 * std::cos(3.1 * t), 0.8e-3 * std::cos(0.9 * t) - 0.1e-3});
      }
      EXPECT_GT(on.largest_n, 0.5);
      // Slips of the friction happen in another tick where rounding decides.
      EXPECT_LT(on.largest_error_n, (pieces.front().static_friction > 0 ? 1e-3 : 1e-5) * on.largest_n)
          << pieces.size() << tilted.name << by;
      std::printf("[ measured ] %.2g of %.2g N\n", on.largest_error_n, on.largest_n);
    }
}

struct WorkOfTurn {
  double net_j = 0, absolute_j = 0;
};

// Of the force on a hand on a closed path below the surface, over the ticks of one turn.
WorkOfTurn work_below(ArmOnPieces& on, bool follows) {
  constexpr int kTicks = 24'000;
  constexpr double kTurnOf = 2 * std::numbers::pi;
  const auto place = [&](double t) -> InSpace {
    const double x = 5e-3 * std::cos(t), y = 4e-3 * std::sin(t) + 1e-3 * std::sin(3 * t);
    return {x, y, (follows ? hills_m(x, y) : 0) - 6e-4 - 3e-4 * std::sin(5 * t)};
  };
  WorkOfTurn work;
  for (int i = -10; i < kTicks; ++i) {
    const double t = kTurnOf * i / kTicks, step = kTurnOf / kTicks;
    if (i == -10) on.at({place(t)[0], place(t)[1], 2e-3});
    const InSpace force_n = on.at(place(t)), before = place(t - step / 2), after = place(t + step / 2);
    if (i < 0) continue;
    double step_j = 0;
    for (std::size_t j = 0; j < 3; ++j) step_j += force_n[j] * (after[j] - before[j]);
    work.net_j += step_j, work.absolute_j += std::abs(step_j);
  }
  return work;
}

TEST(PieceReliefTest, AClosedPathDoesNoWorkUnlessNormalsAreInterpolated) {
  Piece floor = raised_floor();
  ArmOnPieces exact({floor}, 1e-8);
  const WorkOfTurn none = work_below(exact, true);
  std::printf("[ measured ] exact normals: net work %.2g of %.3g uJ\n", 1e6 * none.net_j,
              1e6 * none.absolute_j);
  EXPECT_GT(none.absolute_j, 1e-5);
  EXPECT_LT(std::abs(none.net_j), 1e-6 * none.absolute_j);
  floor.relief->interpolated = true;
  ArmOnPieces flat({floor}, 1e-8);
  const WorkOfTurn some = work_below(flat, false);
  std::printf("[ measured ] interpolated normals: net work %.3g of %.3g uJ\n", 1e6 * some.net_j,
              1e6 * some.absolute_j);
  EXPECT_GT(std::abs(some.net_j), 1e-3 * some.absolute_j);
}

// Down a slope with the peak force, back up without one.
TEST(PieceReliefTest, InterpolatedNormalsGiveAtMostWhatIsStated) {
  Piece floor = raised_floor();
  constexpr double kPerM = 500, kHeight_m = 5e-4;
  floor.relief = relief_of("wave", [](double u, double /*v*/) { return kHeight_m * std::cos(kPerM * u); });
  floor.relief->interpolated = true;
  ArmOnPieces on({floor}, 1e-7);
  schema::Device device = *schema::read_device("arm");
  const double depth_m = device.peak_force_n / floor.stiffness_n_per_m, half_m = std::numbers::pi / kPerM;
  double work_j = 0;
  on.at({0, 0, 1e-3});
  InSpace last = {0, 0, 0};
  const auto go_to = [&](const InSpace& end) {
    const InSpace start = last;
    constexpr int kSteps = 5000;
    for (int i = 1; i <= kSteps; ++i) {
      InSpace to;
      for (std::size_t j = 0; j < 3; ++j) to[j] = start[j] + (end[j] - start[j]) * i / kSteps;
      const InSpace force_n = on.at({(to[0] + last[0]) / 2, 0, (to[2] + last[2]) / 2});
      for (std::size_t j = 0; j < 3; ++j) work_j += force_n[j] * (to[j] - last[j]);
      last = to;
    }
  };
  go_to({0, 0, -depth_m});
  go_to({half_m, 0, -depth_m});
  go_to({half_m, 0, 0});
  go_to({0, 0, 0});
  const double stated_j = most_energy_j(on.scene.pieces.front(), device);
  std::printf("[ measured ] gained %.3g mJ, stated %.3g mJ\n", 1e3 * work_j, 1e3 * stated_j);
  EXPECT_LT(work_j, stated_j);
  EXPECT_GT(work_j, 0.8 * device.peak_force_n * 2 * kHeight_m);
}

TEST(PieceReliefTest, ARandomHandFallsThroughNoRelief) {
  for (const bool walled : {false, true})
    for (const double step_m : {1e-5, 1e-7, 1e-3}) {
      std::vector<Piece> pieces = {raised_floor()};
      if (walled) pieces.push_back(wall_at(-4e-3));
      ArmOnPieces on(pieces, step_m);
      std::mt19937_64 random(32);
      const auto anywhere = [&](double half_m) {
        return 2 * half_m * (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5);
      };
      InSpace hand = {0, 0, 3e-3}, goal = {};
      double deepest_m = 0;
      for (int tick = 0; tick < 30'000; ++tick) {
        if (tick % 50 == 49) goal = {anywhere(0.03), anywhere(0.03), anywhere(4e-3)};
        if (tick % 1000 == 999) hand = {anywhere(0.03), anywhere(0.03), anywhere(4e-3)};  // within one tick
        for (std::size_t i = 0; i < 3; ++i) hand[i] += 0.05 * (goal[i] - hand[i]);
        const InSpace at = on.ghost_at(hand);
        deepest_m = std::max(deepest_m, height_below(on, at) - at[2]);
        if (walled) deepest_m = std::max(deepest_m, -4e-3 - at[0]);
      }
      EXPECT_LT(deepest_m, 1.5e-6) << step_m << walled;  // GhostPoint states 1e-6 along the normal
    }
}

// By at most one sample a step, onto the surface, and never away from the hand.
TEST(PieceReliefTest, ASlideEndsNearerToTheHand) {
  ArmOnPieces on({raised_floor()});
  const auto& table = core::table_of<core::ReliefPieceTable>(on.view, on.view.layers[0]);
  std::mt19937_64 random(1996);
  const auto anywhere = [&](double half_m) {
    return static_cast<float>(2 * half_m * (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5));
  };
  int far = 0;
  for (int i = 0; i < 2000; ++i) {
    const core::SpaceVector hand = {anywhere(0.01), anywhere(0.01), anywhere(1e-3) - 1.5e-3F};
    core::SpaceVector start = {hand.x + anywhere(5e-3), hand.y + anywhere(5e-3), 0};
    const auto height = [&](const core::SpaceVector& at) {
      return height_below(on, {double{at.x}, double{at.y}, 0});
    };
    start.z = static_cast<float>(height(start));
    const core::SpaceVector end = core::slid_on_relief(table, hand, start);
    const double way_m = std::hypot(double{end.x - start.x}, double{end.y - start.y});
    EXPECT_NEAR(double{end.z}, height(end), 1e-8);
    EXPECT_LE(way_m, 1.001 * core::kSlideSteps * kReliefPitch_m);
    EXPECT_LE(length(end - hand), length(start - hand) + 1e-8F);
    far += way_m > 2e-3 ? 1 : 0;
  }
  EXPECT_GT(far, 500);
}

// A hand that jumps from valley to valley below the surface: the ghost follows on it, or over it, in some
// ticks.
TEST(PieceReliefTest, TheGhostComesAfterAHandThatJumps) {
  ArmOnPieces on({raised_floor()});
  on.ghost_at({0, 0, 2e-3});
  InSpace last = on.ghost_at({0, 0, -1e-3});
  const std::array<InSpace, 4> hands = {
      {{8e-3, 1e-3, -1e-3}, {8e-3, 9e-3, -2e-3}, {-7e-3, 3e-3, -1.2e-3}, {0, 0, -1e-3}}};
  for (const InSpace& hand : hands) {
    const auto from_hand = [&](const InSpace& place) {
      return std::hypot(place[0] - hand[0], place[1] - hand[1], place[2] - hand[2]);
    };
    for (int tick = 0; tick < 100; ++tick) {
      const InSpace at = on.ghost_at(hand);
      EXPECT_LE(from_hand(at), from_hand(last) + 1e-6);
      EXPECT_GE(at[2], height_below(on, at) - 1e-6);
      last = at;
    }
    EXPECT_NEAR(last[2], height_below(on, last), 1e-7) << "at rest on the surface";
    EXPECT_LT(from_hand(last), 3e-3);
  }
}

// A flat map is the plane at its height.
TEST(PieceReliefTest, AFlatMapIsAPlane) {
  Piece raised = raised_floor(), plane = raised_floor();
  raised.relief = relief_of("flat", [](double, double) { return 1e-3; });
  plane.relief.reset(), plane.z_m = 1e-3;
  ArmOnPieces on_map({raised}), on_plane({plane});
  for (int i = 0; i < 500; ++i) {
    const InSpace hand = {1e-3 * std::sin(0.01 * i), 0, 1e-3 + 5e-4 * std::cos(0.02 * i)};
    const InSpace a = on_map.at(hand), b = on_plane.at(hand);
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(a[j], b[j], 1e-6);
  }
}

TEST(PieceReliefTest, ABlockWithAxesThatAreNotAcrossIsRefused) {
  ArmOnPieces on({raised_floor()});
  const auto fault_with = [&](float first_axis_z) {
    std::vector<std::uint32_t> words = on.scene.words;
    const core::SceneView view = on.scene.view();
    auto* const table =
        reinterpret_cast<core::ReliefPieceTable*>(words.data() + (view.tables - on.scene.words.data()));
    table->axes[0][2] = first_axis_z;
    const auto bytes = static_cast<std::uint32_t>(words.size() * sizeof(std::uint32_t));
    reinterpret_cast<core::SceneHeader*>(words.data())->check = core::scene_check(words.data(), bytes);
    core::SceneView read;
    return core::read_scene_block(words.data(), bytes, read);
  };
  EXPECT_EQ(fault_with(0), core::SceneFault::none);
  EXPECT_EQ(fault_with(1e-3F), core::SceneFault::value);
  EXPECT_EQ(fault_with(NAN), core::SceneFault::value);
}

}  // namespace
}  // namespace tacto::playback
