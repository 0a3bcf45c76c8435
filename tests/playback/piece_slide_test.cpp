// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces that slide: the motion against closed forms, detents and stops, the ghost that is taken along, and
// the reference in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "data-schema/mesh/mesh.hpp"
#include "firmware-host/core/scene/piece_slide.hpp"
#include "firmware-host/core/scene/scene_kernel.hpp"
#include "playback/prepare/scene/judged_piece.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/prepare/scene/slide_table.hpp"
#include "playback/render/reference/exact_scene.hpp"
#include "tests/playback/arm_on_pieces.hpp"

namespace tacto::playback {
namespace {

using schema::Piece;
using SlidePlace = ArmOnPieces::Place;

constexpr double kSlideTick_s = 1e-3, kKnobRadius_m = 0.01;

Piece knob_on_slide() {
  Piece knob;
  knob.name = "knob", knob.shape = schema::PieceShape::sphere, knob.radius_m = kKnobRadius_m;
  knob.stiffness_n_per_m = 1000, knob.damping_n_s_per_m = 2;
  knob.slide = schema::PieceSlide{{2, 0, 0}, -0.03, 0.03, 0.05, 1, 0.3, 0, 0};
  return knob;
}

// A cube of 20 mm around its place.
Piece cube_on_slide() {
  schema::Mesh cube;
  for (int i = 0; i < 8; ++i)
    cube.vertices_m.push_back(
        {(i & 1) != 0 ? 0.01 : -0.01, (i & 2) != 0 ? 0.01 : -0.01, (i & 4) != 0 ? 0.01 : -0.01});
  cube.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  const std::string path = testing::TempDir() + "piece_slide_test.mesh.nc";
  EXPECT_TRUE(schema::write_mesh(path, cube, schema::Existing::replace));
  Piece piece = knob_on_slide();
  piece.name = "cube", piece.shape = schema::PieceShape::mesh, piece.mesh = path, piece.radius_m = 0;
  return piece;
}

Piece still_plane(const std::string& name, const SlidePlace& at, const SlidePlace& direction) {
  Piece plane;
  plane.name = name, plane.stiffness_n_per_m = 1000, plane.direction = direction;
  plane.x_m = at[0], plane.y_m = at[1], plane.z_m = at[2];
  return plane;
}

core::SlideTable table_of(const schema::PieceSlide& slide) {
  Piece piece;
  piece.slide = slide;
  const auto table = slide_table(piece, kSlideTick_s, "");
  EXPECT_TRUE(table);
  return *table;
}

void tick_alone(const core::SlideTable& table, core::WallState& state, double push_n) {
  core::push_slide(table, state, static_cast<float>(push_n));
  state.slid_m += core::slide_way(table, state, static_cast<float>(kSlideTick_s));
}

// v = (F - R) / b (1 - e^(-b t / m)): the place is within half of a tick's change of the speed.
TEST(PieceSlideTest, AConstantPushAgainstFrictionIsTheClosedForm) {
  constexpr double kPush_n = 0.8, kMass_kg = 0.2, kViscous = 2, kDry_n = 0.5;
  const core::SlideTable table = table_of({{1, 0, 0}, 0, 1, kMass_kg, kViscous, kDry_n, 0, 0});
  core::WallState state;
  for (int i = 1; i <= 1000; ++i) {
    tick_alone(table, state, kPush_n);
    const double t = kSlideTick_s * i, end = (kPush_n - kDry_n) / kViscous,
                 share = std::exp(-kViscous * t / kMass_kg);
    EXPECT_NEAR(double{state.slid_m}, end * (t - kMass_kg / kViscous * (1 - share)),
                0.5 * kSlideTick_s * end + 1e-6);
    EXPECT_NEAR(double{state.slid_mps}, end * (1 - share),
                0.5 * kSlideTick_s * (kPush_n - kDry_n) / kMass_kg);
  }
  // Let go: it stops within v m / R, and stays to the bit.
  for (int i = 0; i < 200; ++i) tick_alone(table, state, 0);
  EXPECT_EQ(state.slid_mps, 0);
  const float rest_m = state.slid_m;
  for (int i = 0; i < 1000; ++i) tick_alone(table, state, i % 2 == 0 ? 0.99 * kDry_n : -0.99 * kDry_n);
  EXPECT_EQ(state.slid_m, rest_m);
}

TEST(PieceSlideTest, AStopHolds) {
  const core::SlideTable table = table_of({{1, 0, 0}, -0.01, 0.02, 0.1, 0, 0, 0, 0});
  for (const double push_n : {3.0, -3.0}) {
    core::WallState state;
    for (int i = 0; i < 500; ++i) tick_alone(table, state, push_n);
    EXPECT_EQ(state.slid_m, push_n > 0 ? table.to_m : table.from_m);
  }
}

// Without friction the semi-implicit motion keeps a modified energy: the amplitude stays for minutes. With it
// the piece comes to rest within R / k of a detent.
TEST(PieceSlideTest, ADetentHoldsAndGivesNoEnergy) {
  constexpr double kDetent_n = 1, kDistance_m = 5e-3, kTurn = 2 * std::numbers::pi;
  schema::PieceSlide slide{{1, 0, 0}, -0.02, 0.02, 0.05, 0, 0, kDetent_n, kDistance_m};
  const core::SlideTable free = table_of(slide);
  core::WallState state;
  state.slid_m = 1e-3F;
  float farthest_m = 0;
  for (int i = 0; i < 120'000; ++i) {
    tick_alone(free, state, 0);
    farthest_m = std::max(farthest_m, std::abs(state.slid_m));
  }
  EXPECT_LT(farthest_m, 1.05e-3F);  // w T = 0.16: the modified energy is 0.6 % off, and half of this in place
  slide.friction_n = 0.1, slide.viscous_n_s_per_m = 1;
  const core::SlideTable rough = table_of(slide);
  for (const double start_m : {1e-3, 6.9e-3, -8.2e-3}) {
    state = {};
    state.slid_m = static_cast<float>(start_m);
    for (int i = 0; i < 2000; ++i) tick_alone(rough, state, 0);
    const double detent_m = kDistance_m * std::round(start_m / kDistance_m);
    EXPECT_EQ(state.slid_mps, 0);
    EXPECT_NEAR(double{state.slid_m}, detent_m, 1.02 * 0.1 / (kTurn * kDetent_n / kDistance_m));
  }
}

// Of the first piece.
double slid_m(const ArmOnPieces& on) {
  return double{on.live[core::kPieceNumbers + core::kWallStateWords - 2]};
}

// No slip, stop or detent of these paths is so near that rounding decides its tick.
TEST(PieceSlideTest, TheKernelIsTheReference) {
  Piece detents = knob_on_slide(), rough = knob_on_slide();
  detents.slide->detent_n = 0.5, detents.slide->detent_m = 4e-3;
  rough.static_friction = rough.kinetic_friction = 0.5;
  for (const Piece& piece : {knob_on_slide(), detents, rough, cube_on_slide()}) {
    ArmOnPieces on({piece, still_plane("floor", {0, 0, -0.004}, {0, 0, 1})});
    double farthest_m = 0;
    for (int i = 0; i < 6000; ++i) {
      const double t = 1e-3 * i;
      on.compare_at({0.015 * std::sin(1.1 * t - 1.5), 2e-3 * std::sin(t), 2e-3 * std::cos(2 * t)});
      farthest_m = std::max(farthest_m, std::abs(slid_m(on)));
    }
    std::printf("[ measured ] %s: %.2g of %.2g N, slid %.3g mm\n", piece.name.c_str(), on.largest_error_n,
                on.largest_n, 1e3 * farthest_m);
    EXPECT_GT(farthest_m, 3e-3);
    EXPECT_LT(on.largest_error_n, 1e-4 * on.largest_n);
  }
}

// Between a floor and a wall, which hold the ghost where the piece would push it into them.
TEST(PieceSlideTest, ASlidingPieceNeverPassesTheGhost) {
  for (const bool cube : {false, true})
    for (const double step_m : {1e-5, 1e-7}) {
      Piece piece = cube ? cube_on_slide() : knob_on_slide();
      piece.slide->friction_n = 0, piece.slide->viscous_n_s_per_m = 0.1;
      piece.slide->detent_n = 2, piece.slide->detent_m = 0.02;  // drives it to and fro
      ArmOnPieces on({piece, still_plane("floor", {0, 0, -4e-3}, {0, 0, 1}),
                      still_plane("wall", {-0.035, 0, 0}, {1, 0, 0})},
                     step_m);
      std::mt19937_64 random(32);
      const auto anywhere = [&](double half_m) {
        return 2 * half_m * (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5);
      };
      SlidePlace hand = {0, 0, 0.03}, goal = {};
      double deepest_m = 0, farthest_m = 0;
      for (int tick = 0; tick < 60'000; ++tick) {
        if (tick % 40 == 39) goal = {anywhere(0.045), anywhere(0.015), anywhere(0.015)};
        for (std::size_t i = 0; i < 3; ++i) hand[i] += 0.05 * (goal[i] - hand[i]);
        const SlidePlace at = on.ghost_at(hand);
        const double x = at[0] - slid_m(on);
        const double in_m = cube ? 0.01 - std::max({std::abs(x), std::abs(at[1]), std::abs(at[2])})
                                 : kKnobRadius_m - std::hypot(x, at[1], at[2]);
        deepest_m = std::max({deepest_m, in_m, -4e-3 - at[2], -0.035 - at[0]});
        farthest_m = std::max(farthest_m, std::abs(slid_m(on)));
      }
      std::printf("[ measured ] deepest %.2g um, slid %.3g mm\n", 1e6 * deepest_m, 1e3 * farthest_m);
      EXPECT_GT(farthest_m, 0.02);
      EXPECT_LE(farthest_m, 0.03 + 1e-8);
      EXPECT_LT(deepest_m, 2e-6) << cube << step_m;  // GhostPoint states 1e-6
    }
}

// A hand at rest in a piece without friction: the bound of the stiffness is that at which the motion grows.
TEST(PieceSlideTest, ATooLightPieceIsRefusedWhereItsMotionGrows) {
  Piece knob = knob_on_slide();
  knob.damping_n_s_per_m = 0;
  *knob.slide = {{1, 0, 0}, -0.5, 0.5, 1e-3, 0, 0, 0.5, 1e-2};
  const double stiffest = stiffest_slide_n_per_m(knob, kSlideTick_s);
  knob.stiffness_n_per_m = 1.001 * stiffest;
  EXPECT_FALSE(slide_table(knob, kSlideTick_s, ""));
  for (const double share : {0.98, 1.02}) {
    *knob.slide = {{1, 0, 0}, -0.5, 0.5, 1e-3, 0, 0, 0.5, 1e-2};
    knob.stiffness_n_per_m = 0;
    const auto table = slide_table(knob, kSlideTick_s, "");
    core::WallState state;
    state.slid_m = 1e-7F;
    for (int i = 0; i < 1000; ++i)
      tick_alone(*table, state,
                 -share * stiffest * double{state.slid_m});  // bilateral, as its wall at a depth
    EXPECT_EQ(std::abs(state.slid_m) > 1e-5F, share > 1) << state.slid_m;
  }
}

}  // namespace
}  // namespace tacto::playback
