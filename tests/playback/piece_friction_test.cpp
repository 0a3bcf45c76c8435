// SPDX-License-Identifier: GPL-3.0-or-later
// Friction on pieces in space: slips within a tick, nothing drifts, the force stays in its cone, and what is
// refused.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "firmware-host/core/scene/scene_kernel.hpp"
#include "playback/prepare/scene/piece_block.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/render/reference/exact_scene.hpp"
#include "tests/playback/arm_on_pieces.hpp"

namespace tacto::playback {
namespace {

using schema::Piece;
using Space = ArmOnPieces::Place;

constexpr double kFineStep_m = 1e-6, kTick_s = 1e-3;

double size_of(const Space& v) {
  return std::hypot(v[0], v[1], v[2]);
}

// From above.
void rest_at(ArmOnPieces& on, const Space& place_m) {
  on.at({place_m[0], place_m[1], place_m[2] + 0.005});
  for (int i = 0; i < 200; ++i) on.at(place_m);
}

// 1 N/mm: 1 N at a depth of 1 mm.
Piece rough_floor(double fixed, double kinetic) {
  Piece floor;
  floor.name = "floor";
  floor.stiffness_n_per_m = 1000;
  floor.static_friction = fixed, floor.kinetic_friction = kinetic;
  return floor;
}

TEST(PieceFrictionTest, WithoutAKineticCoefficientItIsTheStaticOne) {
  const auto kinetic_of = [](const std::string& members) {
    const auto scene = schema::parse_scene(
        R"({"kind": "scene", "version": "1.0", "pieces": [{"name": "a", "shape": "plane", "place": {"x_m": 0, "y_m": 0, "z_m": 0}, "stiffness_n_per_m": 1, )" +
            members + "}]}",
        "s.scene.json");
    EXPECT_TRUE(scene) << schema::message(scene.error());
    static int count = 0;
    const std::string stem = testing::TempDir() + "friction" + std::to_string(++count);
    EXPECT_TRUE(schema::write_scene(stem, *scene));
    EXPECT_EQ(schema::read_scene(stem)->pieces[0].kinetic_friction, scene->pieces[0].kinetic_friction);
    return scene->pieces[0].kinetic_friction;
  };
  EXPECT_EQ(kinetic_of(R"("static_friction": 0.6)"), 0.6);
  EXPECT_EQ(kinetic_of(R"("static_friction": 0.6, "kinetic_friction": 0)"), 0);
  EXPECT_EQ(kinetic_of(R"("static_friction": {"value": 0.6, "slider": {"from": 0.2, "to": 1}})"), 0.2);
  EXPECT_EQ(kinetic_of(R"("viscous_n_s_per_m": 1)"), 0);
}

// It is not held from the origin of the piece, which may be anywhere.
TEST(PieceFrictionTest, AHandThatBeginsInAPieceIsHeldFromThere) {
  Piece floor = rough_floor(0.6, 0.4), ball = rough_floor(0.6, 0.4);
  floor.x_m = -0.05, floor.y_m = 0.09;
  ball.shape = schema::PieceShape::sphere, ball.radius_m = 0.02, ball.z_m = -0.02;
  for (const Piece& piece : {floor, ball})
    for (const auto& contact : {schema::PieceContact::ghost, schema::PieceContact::add}) {
      ArmOnPieces rough({piece}, kFineStep_m, contact);
      Space force_n = {};
      for (int i = 0; i < 300; ++i) {
        force_n = rough.at({0, 0, -2e-3});
        const auto reference = rough.exact->tick({0, 0, -2000}).force_n;
        EXPECT_NEAR(std::hypot(force_n[0], force_n[1]), 0, 1e-6);
        EXPECT_NEAR(std::hypot(reference[0], reference[1]), 0, 1e-6);
      }
      EXPECT_NEAR(force_n[2], 2, 1e-5);
      for (int i = 1; i <= 100; ++i) force_n = rough.at({0, 20e-6 * i, -2e-3});
      EXPECT_GT(-force_n[1],
                0.3 * force_n[2]);  // at least the kinetic friction, but for the slope of the ball
    }
}

// Each slip gives back (0.6 - 0.4) N / 1 N/mm; in ticks of 47 um it would be found 5 ticks later, after 235.
TEST(PieceFrictionTest, DraggedItSlipsEvery200Micrometres) {
  constexpr double kWay_m = 47e-6, kSlip_m = 200e-6;
  for (const auto& contact : {schema::PieceContact::ghost, schema::PieceContact::add}) {
    ArmOnPieces rough({rough_floor(0.6, 0.4)}, kFineStep_m, contact);
    rest_at(rough, {0, 0, -1e-3});
    double last_m = 0, first_slip_m = 0, last_slip_m = 0;
    int slips = 0;
    for (int i = 1; i * kWay_m <= 1; ++i) {
      const Space force_n = rough.at({i * kWay_m, 0, -1e-3});
      EXPECT_NEAR(force_n[2], 1, 1e-6);
      EXPECT_LE(-force_n[0], 0.6 * force_n[2] + 1e-6);
      EXPECT_LE(std::abs(force_n[1]), 1e-6);
      const double stretch_m = -force_n[0] / 1000;
      const int now = static_cast<int>(std::lround((last_m + kWay_m - stretch_m) / kSlip_m));
      last_m = stretch_m;
      if (now == 0) continue;
      EXPECT_GE(-force_n[0], 0.4 * force_n[2] - 1e-4);  // 1e-7 m: single precision of 1 m
      if (slips == 0) first_slip_m = i * kWay_m;
      slips += now, last_slip_m = i * kWay_m;
    }
    EXPECT_GT(slips, 4900);
    EXPECT_NEAR((last_slip_m - first_slip_m) / (slips - 1) / kSlip_m, 1, 1e-3);
  }
}

// A fast hand slips several times a tick.
TEST(PieceFrictionTest, SlipsOfOneTickAreAllFound) {
  ArmOnPieces rough({rough_floor(0.6, 0.4)});
  rest_at(rough, {0, 0, -1e-3});
  for (int i = 1; i <= 200; ++i) {
    const double way_m = 2.9e-3 * i;  // 14.5 slips a tick
    const double expected_m = 400e-6 + std::fmod(way_m - 400e-6, 200e-6);
    const double stretch_m = -rough.at({way_m, 0, -1e-3})[0] / 1000;
    const double off_m = std::abs(stretch_m - expected_m);
    EXPECT_LT(std::min(off_m, 200e-6 - off_m), 1e-6) << i;  // 200 slips a tick of 3e-9 m of rounding
  }
}

TEST(PieceFrictionTest, BelowBreakAwayNothingDrifts) {
  ArmOnPieces rough({rough_floor(0.6, 0.4)});
  rest_at(rough, {0.01, 0.02, -1e-3});
  std::vector<Space> first;
  for (int cycle = 0; cycle < 200; ++cycle)
    for (int i = 0; i < 50; ++i) {
      const double stretch_m = 300e-6 + 60e-6 * std::sin(i * 0.12566370614);  // 0.4 to 0.6 of break-away
      const Space force_n = rough.at({0.01 + 0.6 * stretch_m, 0.02 - 0.8 * stretch_m, -1e-3});
      if (cycle == 0) first.push_back(force_n);
      EXPECT_EQ(force_n, first[static_cast<std::size_t>(i)]) << cycle << ' ' << i;
    }
  EXPECT_NEAR(std::hypot(first[12][0], first[12][1]), 0.36, 1e-3);
}

// On a tilted plane, along a curve, at changing depth.
TEST(PieceFrictionTest, TheForceStaysInItsCone) {
  Piece slope = rough_floor(0.8, 0.5);
  slope.direction = {0, 0.6, 0.8};
  ArmOnPieces rough({slope});
  rest_at(rough, {0, 0, -1e-3});
  double most = 0;
  int slipped = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double t = i * kTick_s, u = 0.01 * std::sin(3 * t), v = 0.01 * std::sin(2.1 * t),
                 depth_m = 1e-3 * (1.2 + std::sin(17 * t));
    const Space force_n = rough.at({u, 0.8 * v - 0.6 * depth_m, -0.6 * v - 0.8 * depth_m});
    const double normal_n = 0.6 * force_n[1] + 0.8 * force_n[2];
    const double along_n = size_of({force_n[0], force_n[1] - 0.6 * normal_n, force_n[2] - 0.8 * normal_n});
    ASSERT_GT(normal_n, 0) << i;
    EXPECT_LE(along_n, (0.8 + 1e-6) * normal_n + 1e-6) << i;
    most = std::max(most, along_n / normal_n);
    slipped += along_n < 0.51 * normal_n;
  }
  EXPECT_GT(most, 0.79);
  EXPECT_GT(slipped, 100);
}

// With equal coefficients there are no jumps: along a wild path the kernel is as near to double precision as
// single precision is, at 0.1 m and 1,000 N/m. With a jump a slip may fall into the next tick.
TEST(PieceFrictionTest, SinglePrecisionIsNearDoublePrecision) {
  for (const auto& contact : {schema::PieceContact::ghost, schema::PieceContact::add})
    for (const double kinetic : {0.5, 0.3}) {
      Piece ball = rough_floor(0.5, kinetic);
      ball.name = "ball", ball.shape = schema::PieceShape::sphere;
      ball.radius_m = 0.03, ball.x_m = 0.05;
      ball.viscous_n_s_per_m = 2;
      Piece floor = rough_floor(0.5, kinetic);
      floor.z_m = 0;
      ArmOnPieces rough({ball, floor}, kFineStep_m, contact);
      std::mt19937_64 random(4);
      Space place_m = {0, 0, 0.01}, to_m = place_m;
      rest_at(rough, place_m);
      double worst_n = 0;
      int far = 0, touched = 0;
      for (int i = 0; i < 3000; ++i) {
        if (i % 150 == 0)
          for (double& each : to_m) each = -0.03 + 0.06 * static_cast<double>(random() >> 11) * 0x1p-53;
        for (std::size_t k = 0; k < 3; ++k) place_m[k] += 0.02 * (to_m[k] - place_m[k]);
        const Space force_n = rough.at(place_m);
        const auto wanted = rough.exact->tick(rough.counts_of(place_m));
        double off_n = 0, size_n = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          off_n = std::max(off_n, std::abs(force_n[k] - wanted.force_n[k]));
          size_n = std::max(size_n, std::abs(wanted.force_n[k]));
        }
        touched += size_n > 0;
        if (off_n > 1e-3)
          ++far;
        else
          worst_n = std::max(worst_n, off_n);
      }
      EXPECT_GT(touched, 1000);
      EXPECT_LE(far, kinetic < 0.5 ? 15 : 0) << kinetic << ' ' << worst_n;
    }
}

TEST(PieceFrictionTest, ViscousFrictionComesOnTop) {
  Piece floor = rough_floor(0, 0);
  floor.viscous_n_s_per_m = 5;
  ArmOnPieces rough({floor});
  rest_at(rough, {0, 0, -1e-3});
  Space force_n = {};
  for (int i = 1; i < 200; ++i) force_n = rough.at({0, 1e-4 * i, -1e-3});
  EXPECT_NEAR(force_n[1], -0.5, 1e-5);
  EXPECT_NEAR(force_n[0], 0, 1e-6);
  for (int i = 0; i < 20; ++i) force_n = rough.at({0, 0.02 + 1e-4 * i, 1e-3});
  EXPECT_EQ(size_of(force_n), 0);
}

TEST(PieceFrictionTest, KineticAboveStaticFrictionIsRefused) {
  schema::Scene scene;
  scene.pieces = {rough_floor(0.3, 0.4)};
  const auto text = schema::scene_json(scene, "s");
  const auto read = text ? schema::parse_scene(*text, "s") : schema::Result<schema::Scene>();
  ASSERT_FALSE(text && read);
  const auto json = [](const std::string& members) {
    return schema::parse_scene(
        R"({"kind": "scene", "version": "1.0", "pieces": [{"name": "a", "shape": "plane", "stiffness_n_per_m": 1,)"
        R"( "place": {"x_m": 0, "y_m": 0, "z_m": 0}, )" +
            members + "}]}",
        "s");
  };
  EXPECT_EQ(json(R"("static_friction": 0.3, "kinetic_friction": 0.4)").error().where,
            "s#/pieces/0/kinetic_friction");
  EXPECT_FALSE(json(R"("static_friction": -0.3)"));
  const auto kept = json(R"("static_friction": 0.5, "kinetic_friction": 0.4, "viscous_n_s_per_m": 3)");
  ASSERT_TRUE(kept) << message(kept.error());
  const auto again = schema::parse_scene(*schema::scene_json(*kept, "s"), "s");
  ASSERT_TRUE(again);
  EXPECT_EQ(again->pieces[0].static_friction, 0.5);
  EXPECT_EQ(again->pieces[0].kinetic_friction, 0.4);
  EXPECT_EQ(again->pieces[0].viscous_n_s_per_m, 3);
}

}  // namespace
}  // namespace tacto::playback
