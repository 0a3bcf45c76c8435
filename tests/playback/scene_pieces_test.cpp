// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces in space: the kernel's ghost point against closed forms and double precision, walls on the emulated
// arm, and what is refused.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <span>
#include <tuple>

#include "firmware-host/core/scene/scene_kernel.hpp"
#include "firmware-host/sim/planar/planar_body.hpp"
#include "playback/prepare/scene/judged_piece.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/render/reference/exact_scene.hpp"
#include "tests/playback/unlimited_device.hpp"

namespace tacto::playback {
namespace {

using schema::Piece;
using schema::PieceShape;

constexpr double kPieceStep_m = 1e-5;  // of the preset arm
constexpr double kPieceStiffness = 2000;

Piece piece_at(PieceShape shape, double x_m, double y_m, double z_m) {
  Piece piece;
  piece.name = fmt::format("p{}_{}_{}_{}", static_cast<int>(shape), x_m, y_m, z_m);
  piece.shape = shape;
  piece.x_m = x_m, piece.y_m = y_m, piece.z_m = z_m;
  piece.stiffness_n_per_m = kPieceStiffness;
  return piece;
}

Piece plane_at(double x_m, double y_m, double z_m, std::array<double, 3> direction, double thickness_m = 0) {
  Piece piece = piece_at(PieceShape::plane, x_m, y_m, z_m);
  piece.direction = direction;
  piece.thickness_m = thickness_m;
  return piece;
}

Piece sphere_at(double x_m, double y_m, double z_m, double radius_m) {
  Piece piece = piece_at(PieceShape::sphere, x_m, y_m, z_m);
  piece.radius_m = radius_m;
  return piece;
}

Piece ellipsoid_at(double x_m, double y_m, double z_m, std::array<double, 3> half_axes_m) {
  Piece piece = piece_at(PieceShape::quadric, x_m, y_m, z_m);
  for (std::size_t i = 0; i < 3; ++i) piece.coefficients[i] = 1 / (half_axes_m[i] * half_axes_m[i]);
  piece.coefficients[9] = -1;
  return piece;
}

schema::Scene scene_of(std::vector<Piece> pieces,
                       schema::PieceContact contact = schema::PieceContact::ghost) {
  schema::Scene scene;
  scene.pieces = std::move(pieces);
  scene.contact = contact;
  return scene;
}

using Space3 = std::array<double, 3>;

struct PiecesOnArm {
  schema::Device device;
  core::ForceSetup setup;
  PreparedScene scene;
  std::vector<float> live;
  core::SceneKernel kernel;

  explicit PiecesOnArm(const schema::Scene& of, schema::Device on = unlimited_device(kPieceStep_m, "arm"))
      : device(std::move(on)),
        setup(*force_setup_of(device, 1000)),
        scene(*prepare_scene(of, "s.scene.json", device, 1000)),
        live(scene.view().live_words()) {
    kernel.set(scene.view(), setup, live.data());
  }
  std::vector<std::int32_t> counts_at(const Space3& place_m) const {
    std::vector<std::int32_t> counts;
    for (std::size_t i = 0; i < 3; ++i)
      counts.push_back(firmware_host::encoder_count(device.axes[i], place_m[i]));
    return counts;
  }
  Space3 at(const Space3& place_m) {
    const core::ForceOutput output = kernel.tick(counts_at(place_m).data(), true);
    return {double{output.force_n[0]}, double{output.force_n[1]}, double{output.force_n[2]}};
  }
};

double length_of(const Space3& v) {
  return std::hypot(v[0], v[1], v[2]);
}

// Around a closed path in the solid, at whole counts: the net work and its absolute sum, by the mean of the
// forces at both ends of each step (exact where the force is linear).
double net_work_share(const schema::Scene& scene, const std::function<Space3(double)>& path) {
  PiecesOnArm arm(scene);
  constexpr int kTicks = 20'000;
  for (int i = 0; i < 100; ++i) arm.at(path(0));
  Space3 last_m = path(0), last_n = arm.at(last_m);
  double net = 0, absolute = 0;
  for (int i = 1; i <= kTicks; ++i) {
    const Space3 wanted_m = path(static_cast<double>(i) / kTicks);
    const auto counts = arm.counts_at(wanted_m);
    const Space3 force_n = arm.at(wanted_m);
    double work = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double from_m = std::round(last_m[k] / kPieceStep_m) * kPieceStep_m;
      work += (counts[k] * kPieceStep_m - from_m) * (force_n[k] + last_n[k]) / 2;
    }
    net += work, absolute += std::abs(work);
    last_m = wanted_m, last_n = force_n;
    EXPECT_GT(length_of(force_n), 0) << i;
  }
  return std::abs(net) / absolute;
}

TEST(ScenePiecesTest, ForceOnAPlaneASphereAndACylinderIsThatOfTheNearestPlace) {
  const double size = std::sqrt(14.0);
  Piece cylinder = piece_at(PieceShape::cylinder, -0.02, 0.01, 0.02);
  cylinder.direction = {3, 0, 4};
  cylinder.radius_m = 0.02;
  const auto depth_in = [&](const Piece& piece, const Space3& p) {
    const Space3 from = {p[0] - piece.x_m, p[1] - piece.y_m, p[2] - piece.z_m};
    if (piece.shape == PieceShape::plane)
      return std::pair{-(from[0] + 2 * from[1] + 3 * from[2]) / size, Space3{1 / size, 2 / size, 3 / size}};
    const double along = piece.shape == PieceShape::cylinder ? 0.6 * from[0] + 0.8 * from[2] : 0;
    const Space3 arm = {from[0] - 0.6 * along, from[1], from[2] - 0.8 * along};
    const double radius = length_of(arm);
    return std::pair{piece.radius_m - radius, Space3{arm[0] / radius, arm[1] / radius, arm[2] / radius}};
  };
  for (const Piece& piece :
       {plane_at(0.01, 0.02, 0.03, {1, 2, 3}), sphere_at(0.01, 0.02, -0.01, 0.03), cylinder}) {
    PiecesOnArm arm(scene_of({piece}));
    double worst_n = 0, most_n = 0;
    for (int i = 0; i < 20'000; ++i) {
      const double t = i * 2e-4;
      const Space3 wanted = {piece.x_m + 0.025 * std::cos(3 * t), piece.y_m + 0.025 * std::sin(2.2 * t),
                             piece.z_m + 0.02 * std::cos(1.7 * t)};
      auto [depth_m, normal] = depth_in(piece, wanted);
      const double to_m = 0.002 * std::sin(5 * t);  // deep, to above the surface
      const Space3 place = {wanted[0] + (depth_m - to_m) * normal[0],
                            wanted[1] + (depth_m - to_m) * normal[1],
                            wanted[2] + (depth_m - to_m) * normal[2]};
      const auto counts = arm.counts_at(place);
      const Space3 force_n = arm.at(place);
      std::tie(depth_m, normal) =
          depth_in(piece, {counts[0] * kPieceStep_m, counts[1] * kPieceStep_m, counts[2] * kPieceStep_m});
      for (std::size_t k = 0; k < 3; ++k) {
        const double expected_n = std::max(0.0, depth_m) * kPieceStiffness * normal[k];
        worst_n = std::max(worst_n, std::abs(force_n[k] - expected_n));
        most_n = std::max(most_n, std::abs(expected_n));
      }
    }
    EXPECT_LT(worst_n, 1e-5 * most_n) << piece.name;  // the issue's bound; 24 bits of 0.03 m are 1e-6 of 2 mm
    RecordProperty(piece.name, fmt::format("{:.2g}", worst_n / most_n));
  }
}

TEST(ScenePiecesTest, ThePointsRadiusMakesPiecesLargerByIt) {
  for (const Piece& piece : {plane_at(0, 0, 0, {0, 0, 1}), sphere_at(0, 0, -0.02, 0.02)}) {
    schema::Scene scene = scene_of({piece});
    scene.point_radius_m = 0.003;
    PiecesOnArm arm(scene);
    arm.at({0, 0, 0.01});
    EXPECT_EQ(arm.at({0, 0, 0.0031})[2], 0);
    EXPECT_NEAR(arm.at({0, 0, 0.002})[2], 1e-3 * kPieceStiffness, 1e-5);
  }
}

TEST(ScenePiecesTest, ThroughAPlateTheGhostHoldsAndAddTurnsRound) {
  const Piece plate = plane_at(0, 0, 0, {0, 0, 1}, 1e-3);
  PiecesOnArm ghost(scene_of({plate})), add(scene_of({plate}, schema::PieceContact::add));
  for (int count = 100; count >= -300; --count) {
    const double z_m = count * kPieceStep_m;
    const double held_n = ghost.at({0, 0, z_m})[2], added_n = add.at({0, 0, z_m})[2];
    EXPECT_NEAR(held_n, kPieceStiffness * std::max(0.0, -z_m), 1e-5) << count;
    const double expected_n = count >= 0 || count <= -100 ? 0
                              : count >= -50              ? -kPieceStiffness * z_m
                                                          : -kPieceStiffness * (1e-3 + z_m);
    if (count != -50) {
      EXPECT_NEAR(added_n, expected_n, 1e-5) << count;  // at 0.5 mm both faces are as near
    }
  }
  EXPECT_NEAR(ghost.at({0, 0, -0.003})[2], 3e-3 * kPieceStiffness, 1e-5);
}

TEST(ScenePiecesTest, ACornerHoldsAlongItsExactDiagonalAndAnEdgeByTwoPlanes) {
  PiecesOnArm arm(
      scene_of({plane_at(0, 0, 0, {1, 0, 0}), plane_at(0, 0, 0, {0, 1, 0}), plane_at(0, 0, 0, {0, 0, 1})}));
  for (int count = 100; count >= -500; --count) {
    const double at_m = count * kPieceStep_m;
    for (const double force_n : arm.at({at_m, at_m, at_m}))
      EXPECT_NEAR(force_n, kPieceStiffness * std::max(0.0, -at_m), 1e-5) << count;
  }
  const Space3 edge_n = arm.at({-0.003, -0.001, 0.01});
  EXPECT_NEAR(edge_n[0], 6, 1e-5);
  EXPECT_NEAR(edge_n[1], 2, 1e-5);
  EXPECT_NEAR(edge_n[2], 0, 1e-5);
}

TEST(ScenePiecesTest, AThinShellIsNotPassedAlthoughItsOtherSideIsNearer) {
  PiecesOnArm arm(scene_of({ellipsoid_at(0, 0, 0, {0.03, 0.03, 0.0005})}));
  double last_n = 0;
  for (int count = 100; count >= -200; --count) {
    const double force_n = arm.at({0, 0, count * kPieceStep_m})[2];
    EXPECT_GE(force_n, last_n - 1e-5) << count;
    last_n = force_n;
  }
  EXPECT_NEAR(last_n, kPieceStiffness * 0.0025, 1e-4);
}

TEST(ScenePiecesTest, AFrictionlessClosedPathGivesNoWork) {
  const auto turn = [](double part, double times) { return 2 * std::numbers::pi * part * times; };
  const auto floor = [&](double part) {
    return Space3{0.02 * std::cos(turn(part, 1)), 0.02 * std::sin(turn(part, 1)),
                  -0.008 + 0.001 * std::sin(turn(part, 3))};
  };
  const auto ball = [&](double part) {
    const double r_m = 0.028 + 0.001 * std::sin(turn(part, 3)), tilt = 1.2 + 0.4 * std::sin(turn(part, 2));
    return Space3{r_m * std::sin(tilt) * std::cos(turn(part, 1)),
                  r_m * std::sin(tilt) * std::sin(turn(part, 1)), r_m * std::cos(tilt)};
  };
  const auto egg = [&](double part) {
    const Space3 unit = ball(part);
    return Space3{unit[0], unit[1] * 2 / 3, unit[2] / 2};
  };
  // Rounding of the forces alone: 24 bits of places of 0.03 m against depths of 1 mm and more, in 20,000
  // steps of either sign.
  EXPECT_LT(net_work_share(scene_of({plane_at(0, 0, 0, {0.2, 0.1, 1})}), floor), 1e-6);
  EXPECT_LT(net_work_share(scene_of({sphere_at(0, 0, 0, 0.03)}), ball), 1e-6);
  EXPECT_LT(net_work_share(scene_of({ellipsoid_at(0, 0, 0, {0.03, 0.02, 0.015})}), egg), 1e-6);
}

// A box of six planes, in it a ball, an ellipsoid, a cylinder, and a plate across the box.
std::vector<Piece> crowded_box() {
  Piece cylinder = piece_at(PieceShape::cylinder, -0.02, -0.02, 0);
  cylinder.direction = {0.6, 0, 0.8};
  cylinder.radius_m = 0.008;
  return {plane_at(0, 0, -0.05, {0.1, 0.2, 1}),
          plane_at(-0.05, 0, 0, {1, 0.1, 0}),
          plane_at(0.05, 0, 0, {-1, 0, 0.1}),
          plane_at(0, -0.05, 0, {0, 1, 0.05}),
          plane_at(0, 0.05, 0, {0.02, -1, 0}),
          plane_at(0, 0, 0.05, {0, 0, -1}),
          plane_at(0, 0, 0.03, {0.05, 0.02, 1}, 1e-3),
          sphere_at(0, 0, 0, 0.02),
          ellipsoid_at(0.03, 0.02, 0.01, {0.015, 0.01, 0.02}),
          cylinder};
}

// Below each plane, or in a solid, by more than rounding of a place.
double deepest_in(const std::vector<Piece>& pieces, const Space3& p) {
  double deepest_m = 0;
  for (const Piece& piece : pieces) {
    const Space3 from = {p[0] - piece.x_m, p[1] - piece.y_m, p[2] - piece.z_m};
    const double size = length_of(piece.direction);
    const double along =
        (from[0] * piece.direction[0] + from[1] * piece.direction[1] + from[2] * piece.direction[2]) / size;
    double distance_m = along;
    if (piece.thickness_m > 0) distance_m = -piece.thickness_m - along;  // it begins below the plate
    if (piece.shape == PieceShape::sphere) distance_m = length_of(from) - piece.radius_m;
    if (piece.shape == PieceShape::cylinder)
      distance_m = std::sqrt(std::max(0.0, std::pow(length_of(from), 2) - along * along)) - piece.radius_m;
    if (piece.shape == PieceShape::quadric) {
      const auto& c = piece.coefficients;
      const Space3 slope = {2 * c[0] * from[0], 2 * c[1] * from[1], 2 * c[2] * from[2]};
      distance_m = (c[0] * from[0] * from[0] + c[1] * from[1] * from[1] + c[2] * from[2] * from[2] - 1) /
                   length_of(slope);
    }
    deepest_m = std::max(deepest_m, -distance_m);
  }
  return deepest_m;
}

TEST(ScenePiecesTest, ARandomHandFallsThroughNothing) {
  const std::vector<Piece> pieces = crowded_box();
  for (const double step_m : {1e-5, 1e-7, 1e-3}) {
    const schema::Device device = unlimited_device(step_m, "arm");
    PiecesOnArm arm(scene_of(pieces), device);
    core::GhostPoint ghost;
    const auto single = static_cast<float>(step_m);
    const float steps[3] = {single, single, single};
    std::mt19937_64 random(32);
    const auto anywhere = [&] { return 0.2 * (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5); };
    Space3 hand = {0.03, 0, -0.03}, goal = {};
    double deepest_m = 0;
    for (int tick = 0; tick < 1'000'000 / 3; ++tick) {
      if (tick % 50 == 49) goal = {anywhere(), anywhere(), anywhere()};
      if (tick % 1000 == 999) hand = {anywhere(), anywhere(), anywhere()};  // a jump within one tick
      for (std::size_t i = 0; i < 3; ++i) hand[i] += 0.05 * (goal[i] - hand[i]);
      const auto counts = arm.counts_at(hand);
      ghost.force(arm.scene.view(), arm.live.data(), {{counts[0], counts[1], counts[2]}, {}}, steps,
                  arm.setup);
      const core::SpacePlace& at = ghost.place();
      deepest_m = std::max(deepest_m, deepest_in(pieces, {at.counts[0] * step_m + double{at.rest_m.x},
                                                          at.counts[1] * step_m + double{at.rest_m.y},
                                                          at.counts[2] * step_m + double{at.rest_m.z}}));
    }
    EXPECT_LT(deepest_m, 1e-6) << step_m;  // ten times what GhostPoint states for rounding
  }
}

// Cones, cavities, saddles and their complements bend towards the point: the passes of a tick may end inside,
// and the ghost has to stay outside all the same. A ghost that begins inside is moved out in the first ticks.
TEST(ScenePiecesTest, ARandomHandFallsThroughNoQuadric) {
  constexpr double kBend = 1 / (0.03 * 0.03);
  const std::array<double, 10> cavity = {-kBend, -2 * kBend, -kBend, 0, 0, 0, 0, 0, 0, 1},
                               saddle = {20, -20, 0, 0, 0, 0, 0, 0, 1, 0};
  const std::vector<std::vector<std::array<double, 10>>> scenes = {
      {{1, 1, -0.3, 0, 0, 0, 0, 0, 0, 0}},
      {{-1, -1, 0.3, 0, 0, 0, 0, 0, 0, 0}},
      {{-kBend, -kBend, kBend, 0, 0, 0, 0, 0, 0, 1}},
      {{kBend, kBend, -kBend, 0, 0, 0, 0, 0, 0, 1}},
      {{1, 1, 1e4, 0, 0, 0, 0, 0, 0, -1e-3}},
      {cavity},
      {saddle},
      {cavity, saddle}};
  for (const auto& scene : scenes) {
    std::vector<Piece> pieces;
    for (const auto& coefficients : scene) {
      pieces.push_back(piece_at(PieceShape::quadric, 0, 0, 1e-9 * static_cast<double>(pieces.size())));
      pieces.back().coefficients = coefficients;
    }
    PiecesOnArm arm(scene_of(pieces));
    core::GhostPoint ghost;
    const float steps[3] = {1e-5F, 1e-5F, 1e-5F};
    std::mt19937_64 random(1995);
    const auto anywhere = [&] { return 0.12 * (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5); };
    Space3 hand = {0.004, 0.002, 0.001}, goal = hand;
    double deepest_m = 0;
    for (int tick = 0; tick < 50'000; ++tick) {
      if (tick % 50 == 49) goal = {anywhere(), anywhere(), anywhere()};
      if (tick % 1000 == 999) hand = {anywhere(), anywhere(), anywhere()};
      for (std::size_t i = 0; i < 3; ++i) hand[i] += 0.05 * (goal[i] - hand[i]);
      const auto counts = arm.counts_at(hand);
      ghost.force(arm.scene.view(), arm.live.data(), {{counts[0], counts[1], counts[2]}, {}}, steps,
                  arm.setup);
      if (tick < 100) continue;
      const core::SpacePlace& at = ghost.place();
      const double x = at.counts[0] * 1e-5 + double{at.rest_m.x},
                   y = at.counts[1] * 1e-5 + double{at.rest_m.y},
                   z = at.counts[2] * 1e-5 + double{at.rest_m.z};
      for (const auto& c : scene) {
        const double value = c[0] * x * x + c[1] * y * y + c[2] * z * z + c[8] * z + c[9];
        const double slope = std::hypot(2 * c[0] * x, 2 * c[1] * y, 2 * c[2] * z + c[8]);
        deepest_m = std::max(deepest_m, -value / std::max(slope, 1e-3));
      }
    }
    EXPECT_LT(deepest_m, 2e-6) << scene[0][2] << " " << scene[0][9];  // GhostPoint states 1e-6
  }
}

// A hole with a floor holds the ghost by both; the nearest place is known in closed form. Its wall bends
// towards the ghost: the force has to be that of a place on the wall, not of one behind it.
TEST(ScenePiecesTest, InAHoleWithAFloorTheForceIsThatOfTheNearestPlace) {
  constexpr double kHole_m = 0.01;
  Piece hole = piece_at(PieceShape::quadric, 0, 0, 0);
  hole.coefficients = {-1 / (kHole_m * kHole_m), -1 / (kHole_m * kHole_m), 0, 0, 0, 0, 0, 0, 0, 1};
  PiecesOnArm arm(scene_of({hole, plane_at(0, 0, -0.01, {0, 0, 1})}));
  double worst_m = 0;
  for (int tick = 0; tick < 4000; ++tick) {
    const double radius_m = 5e-6 * tick, angle = 2e-3 * tick, z_m = std::max(-0.011, -1e-4 * tick);
    const Space3 wanted = {radius_m * std::cos(angle), radius_m * std::sin(angle), z_m};
    const auto counts = arm.counts_at(wanted);
    const Space3 hand = {counts[0] * kPieceStep_m, counts[1] * kPieceStep_m, counts[2] * kPieceStep_m};
    const Space3 force_n = arm.at(wanted);
    const double r_m = std::hypot(hand[0], hand[1]), outwards = r_m > kHole_m ? kHole_m / r_m - 1 : 0;
    const Space3 expected_m = {outwards * hand[0], outwards * hand[1], std::max(0.0, -0.01 - hand[2])};
    for (std::size_t k = 0; k < 3; ++k)
      worst_m = std::max(worst_m, std::abs(force_n[k] / kPieceStiffness - expected_m[k]));
  }
  EXPECT_LT(worst_m, 1e-6);  // as deep as GhostPoint lets the ghost be
}

// The way of a far jump leads over two surfaces whose normals are nearly opposite, where Cramer's rule loses
// digits: the hand is deep in the floor, and there is a force in each tick.
TEST(ScenePiecesTest, AfterAJumpThereIsAForceInTheSameTick) {
  PiecesOnArm arm(scene_of({plane_at(0, 0, -0.01, {0, 0.3, 1}), sphere_at(0, 0, 0, 0.008)}));
  arm.at({0.03, 0, 0.01});
  arm.at({0.0013, 0.0033, -0.0072});
  arm.at({0.00072, 0.00189, -0.00403});
  const Space3 force_n = arm.at({-0.00316, -0.02674, -0.02402});
  const double normal = std::hypot(0.3, 1.0), depth_m = (0.02674 * 0.3 + 0.02402 - 0.01) / normal;
  EXPECT_NEAR(force_n[0], 0, 1e-3);
  EXPECT_NEAR(force_n[1], kPieceStiffness * depth_m * 0.3 / normal, 1e-3);
  EXPECT_NEAR(force_n[2], kPieceStiffness * depth_m / normal, 1e-3);
}

// Of an ellipsoid with half axes a > b the place of its short axis is the nearest as long as the hand is near
// the centre: depth = sqrt((p - h)^2) with p = a^2 h / (a^2 - b^2) along the long axes, in closed form.
TEST(ScenePiecesTest, AddGivesTheNearestFaceOfAQuadricNearItsCentre) {
  constexpr double kLong_m = 0.01, kShort_m = 0.005;
  PiecesOnArm arm(scene_of({ellipsoid_at(0, 0, 0, {kLong_m, kLong_m, kShort_m})}, schema::PieceContact::add));
  for (int count = 1; count < 700; ++count) {
    const double x_m = count * kPieceStep_m;
    const double along_m = kLong_m * kLong_m * x_m / (kLong_m * kLong_m - kShort_m * kShort_m);
    const double up_m = kShort_m * std::sqrt(1 - std::pow(along_m / kLong_m, 2));
    const double depth_m = std::hypot(along_m - x_m, up_m);
    EXPECT_NEAR(length_of(arm.at({x_m, 0, 0})), kPieceStiffness * depth_m, 1e-4) << count;
  }
}

TEST(ScenePiecesTest, AQuadricDoesNotDependOnTheScaleOfItsCoefficients) {
  constexpr double kBall_m = 0.01;
  for (const double scale : {1e4, 1.0, 1e-6, 1e-9}) {
    for (const auto contact : {schema::PieceContact::ghost, schema::PieceContact::add}) {
      Piece ball = piece_at(PieceShape::quadric, 0, 0, 0);
      ball.coefficients = {scale, scale, scale, 0, 0, 0, 0, 0, 0, -kBall_m * kBall_m * scale};
      PiecesOnArm arm(scene_of({ball}, contact));
      for (int i = 0; i < 1200; ++i) {
        const double turn = 5e-3 * i, r_m = i < 100 ? 0.02 - 1.2e-4 * i : 0.008;
        const Space3 wanted = {r_m * std::cos(turn), r_m * std::sin(turn), 0};
        const auto counts = arm.counts_at(wanted);
        const double depth_m = kBall_m - std::hypot(counts[0], counts[1]) * kPieceStep_m;
        EXPECT_NEAR(length_of(arm.at(wanted)), kPieceStiffness * std::max(0.0, depth_m), 1e-4)
            << scale << " " << i;
      }
    }
  }
}

TEST(ScenePiecesTest, SinglePrecisionIsNearDoublePrecision) {
  for (const auto contact : {schema::PieceContact::ghost, schema::PieceContact::add}) {
    std::vector<Piece> pieces = {plane_at(0, 0, 0.0125, {0.1, 0, 1}), sphere_at(0.02, 0, 0, 0.015),
                                 ellipsoid_at(-0.02, 0, 0, {0.02, 0.01, 0.015})};
    for (Piece& piece : pieces) piece.damping_n_s_per_m = 3, piece.arrest_mass_kg = 0.1;
    pieces[0].integral_n_per_m_s = 3000, pieces[0].integral_bound_n = 2, pieces[0].integral_leak_per_s = 1;
    pieces[1].transient = {32, 50, 92}, pieces[2].transient = {50, 200, 300};
    PiecesOnArm arm(scene_of(pieces, contact));
    ExactScene exact(arm.scene, arm.device, 1000);
    double worst_n = 0, most_n = 0;
    for (int i = 0; i < 3000; ++i) {
      const double t = i * 1e-3;
      const auto counts =
          arm.counts_at({0.03 * std::cos(2 * t), 0.002 * std::sin(3 * t), 0.0135 + 0.003 * std::cos(9 * t)});
      const core::ForceOutput output = arm.kernel.tick(counts.data(), true);
      const auto reference = exact.tick(counts);
      for (std::size_t k = 0; k < 3; ++k) {
        worst_n = std::max(worst_n, std::abs(double{output.unlimited_n[k]} - reference.unlimited_n[k]));
        most_n = std::max(most_n, std::abs(reference.unlimited_n[k]));
      }
    }
    EXPECT_GT(most_n, 1);
    EXPECT_LT(worst_n, 1e-5 * most_n) << to_string(contact);
  }
}

struct Tap {
  double depth_m = 0, rebound_mps = 0, at_last_counts = 0;
  int strong_ticks = 0;
};

// Let go above the wall at 0.2 m/s, pushed by 1 N, for `ticks`.
Tap tap_on(const Piece& wall, double height_m, int ticks) {
  PiecesOnArm arm(scene_of({wall}), *schema::read_device("arm"));
  firmware_host::PlanarBody body(arm.device, schema::Hand(), 1e-3);
  const std::vector<double> none(3);
  body.start_at({0, 0, height_m}, {0, 0, -0.2}, {0, 0, -1});
  Tap tap;
  bool touched = false;
  for (int i = 0; i < ticks; ++i) {
    const std::int32_t counts[3] = {body.count(0), body.count(1), body.count(2)};
    const core::ForceOutput output = arm.kernel.tick(counts, true);
    const double before_m = body.place_m(2);
    std::vector<double> force_n;
    for (const float force : std::span(output.force_n, 3)) force_n.push_back(double{force});
    if (force_n[2] > 5) ++tap.strong_ticks;
    body.step(force_n, none, none);
    tap.depth_m = std::max(tap.depth_m, -body.place_m(2));
    touched = touched || body.place_m(2) < -1e-4;
    if (touched && i < 200) tap.rebound_mps = std::max(tap.rebound_mps, (body.place_m(2) - before_m) * 1000);
    if (i > ticks - 1000)
      tap.at_last_counts = std::max(tap.at_last_counts, std::abs(body.place_m(2)) / kPieceStep_m);
  }
  return tap;
}

// The figures of issue 32; each over the phase of the contact between two ticks.
TEST(ScenePiecesTest, WallsOnTheArm) {
  Piece spring = plane_at(0, 0, 0, {0, 0, 1}), damped = spring;
  damped.damping_n_s_per_m = 4;
  Piece arrested = damped, steady = damped;
  arrested.arrest_mass_kg = 0.15;
  steady.integral_n_per_m_s = 5000, steady.integral_bound_n = 10;
  for (int phase = 0; phase <= 20; ++phase) {
    const double height_m = 1e-3 + phase * 1e-5;
    const Tap a = tap_on(spring, height_m, 500), b = tap_on(damped, height_m, 500),
              c = tap_on(arrested, height_m, 500), d = tap_on(steady, height_m, 6000);
    EXPECT_GT(a.depth_m, 2.55e-3);
    EXPECT_LT(a.depth_m, 2.60e-3);
    EXPECT_GT(b.depth_m, 2.11e-3);
    EXPECT_LT(b.depth_m, 2.18e-3);
    EXPECT_GT(b.rebound_mps, 0.16);
    EXPECT_LT(b.rebound_mps, 0.17);
    EXPECT_GT(c.depth_m, 0.48e-3);
    EXPECT_LT(c.depth_m, 0.69e-3);
    EXPECT_LT(c.rebound_mps, 0.025);
    EXPECT_GE(c.strong_ticks, 4);
    EXPECT_LE(c.strong_ticks, 5);
    EXPECT_LE(d.at_last_counts, 2);
  }
}

TEST(ScenePiecesTest, AnUnstableIntegralIsRefused) {
  const schema::Device arm = *schema::read_device("arm");
  Piece wall = plane_at(0, 0, 0, {0, 0, 1});
  wall.damping_n_s_per_m = 4;
  wall.integral_bound_n = 10;
  for (const auto& [integral, accepted] : {std::pair{5000.0, true}, {50'000.0, false}}) {
    wall.integral_n_per_m_s = integral;
    const auto scene = prepare_scene(scene_of({wall}), "s.scene.json", arm, 1000);
    EXPECT_EQ(bool{scene}, accepted) << integral << " " << wall_growth(wall, arm, 1000, std::nullopt);
    if (!scene) {
      EXPECT_EQ(scene.error().where, "s.scene.json#/pieces/0/integral_n_per_m_s");
    }
  }
}

// Without an integral the wall is a sampled spring with a damper, whose limit is computed without
// eigenvalues.
TEST(ScenePiecesTest, GrowthIsOneAtTheLimitOfASpring) {
  schema::Hand hand;
  hand.mass_kg = 0.1, hand.damping_n_s_per_m = 2, hand.stiffness_n_per_m = 500;
  for (const double delay_s : {0.0, 2e-4, 1e-3, 2.5e-3})
    for (const double damping : {0.0, 4.0, 20.0})
      for (const auto& held : {std::optional<schema::Hand>(), std::optional(hand)}) {
        schema::Device arm = *schema::read_device("arm");
        arm.delay_s = delay_s;
        Piece wall = plane_at(0, 0, 0, {0, 0, 1});
        wall.damping_n_s_per_m = damping;
        const double limit = stiffness_limit_of(arm, 1000, held, damping, true);
        ASSERT_GT(limit, 0);
        wall.stiffness_n_per_m = limit * (1 - 1e-4);
        EXPECT_LE(wall_growth(wall, arm, 1000, held), 1) << delay_s << " " << damping;
        wall.stiffness_n_per_m = limit * (1 + 1e-4);
        EXPECT_GT(wall_growth(wall, arm, 1000, held), 1) << delay_s << " " << damping;
      }
}

// What an emulated board reads of a place that is no number is the least count; the firmware answers such a
// jump with a fault (firmware_scene_test), and the pieces do not hold the hand there.
TEST(ScenePiecesTest, AHandWhosePlaceIsNoNumberIsHeldByNothingAtOnce) {
  PiecesOnArm arm(scene_of({plane_at(0, 0, 0, {0, 0, 1})}), *schema::read_device("arm"));
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(arm.at({0, 0, -0.002})[2], 4, 1e-5);
  const Space3 lost = {0, 0, std::nan("")};
  EXPECT_EQ(arm.counts_at(lost)[2], std::numeric_limits<std::int32_t>::min());
  EXPECT_EQ(arm.at(lost)[2], 0);
  EXPECT_EQ(arm.at({0, 0, 0.01})[2], 0);
}

TEST(ScenePiecesTest, TheForceNeverPulls) {
  Piece wall = plane_at(0, 0, 0, {0, 0, 1});
  wall.damping_n_s_per_m = 1000;
  PiecesOnArm arm(scene_of({wall}));
  double most_n = 0;
  for (int i = 0; i < 2000; ++i) {
    const double force_n = arm.at({0, 0, 0.001 * std::sin(0.05 * i)})[2];
    EXPECT_GE(force_n, 0) << i;
    most_n = std::max(most_n, force_n);
  }
  EXPECT_GT(most_n, 10);
}

TEST(ScenePiecesTest, ASceneIsReadAndWrittenAgain) {
  const std::string text =
      R"({"kind": "scene", "version": "1.0", "radius_m": 0.002, "contact": "add", "pieces": [)"
      R"({"name": "a", "shape": "cylinder", "place": {"x_m": 1, "y_m": 2, "z_m": 3}, "direction": [0, 3, 4],)"
      R"( "radius_m": 0.5, "stiffness_n_per_m": 100, "integral_n_per_m_s": 7, "integral_bound_n": 2}]})";
  const auto scene = schema::parse_scene(text, "s");
  ASSERT_TRUE(scene) << message(scene.error());
  const auto again = schema::parse_scene(*schema::scene_json(*scene, "s"), "s");
  ASSERT_TRUE(again) << message(again.error());
  EXPECT_EQ(again->contact, schema::PieceContact::add);
  EXPECT_EQ(again->point_radius_m, 0.002);
  const Piece& piece = again->pieces.at(0);
  EXPECT_EQ(piece.shape, PieceShape::cylinder);
  EXPECT_EQ(piece.direction, (std::array<double, 3>{0, 3, 4}));
  EXPECT_EQ(piece.radius_m, 0.5);
  EXPECT_EQ(piece.integral_bound_n, 2);
}

TEST(ScenePiecesTest, WhatCannotBeIsRefused) {
  const auto refused_at = [](const std::string& members, const std::string& beside = "") {
    const auto scene = schema::parse_scene(
        fmt::format(R"({{"kind": "scene", "version": "1.0"{}, "pieces": [{{"name": "a", "place": {{"x_m": 0,)"
                    R"( "y_m": 0, "z_m": 0}}, "stiffness_n_per_m": 1, {}}}]}})",
                    beside, members),
        "s");
    return scene ? std::string("read") : scene.error().where;
  };
  const std::string unit = R"("shape": "quadric", "coefficients": [1, 1, 1, 0, 0, 0, 0, 0, 0, )";
  EXPECT_EQ(refused_at(R"("shape": "plane")"), "read");
  EXPECT_EQ(refused_at(unit + "-1]"), "read");
  EXPECT_EQ(refused_at(unit + "1]"), "s#/pieces/0/coefficients");  // empty
  EXPECT_EQ(refused_at(R"("shape": "quadric", "coefficients": [-1, -1, -1, 0, 0, 0, 0, 0, 0, -1])"),
            "s#/pieces/0/coefficients");  // the whole space
  EXPECT_EQ(refused_at(unit + "-1]", R"(, "radius_m": 0.01)"), "s#/radius_m");
  EXPECT_EQ(refused_at(R"("shape": "sphere", "radius_m": 1, "thickness_m": 1)"), "s#/pieces/0/thickness_m");
  EXPECT_EQ(refused_at(R"("shape": "plane", "direction": [0, 0, 0])"), "s#/pieces/0/direction");
  EXPECT_EQ(refused_at(R"("shape": "plane", "integral_n_per_m_s": 5)"), "s#/pieces/0/integral_n_per_m_s");
  EXPECT_EQ(refused_at(R"("shape": "sphere", "radius_m": 1, "direction": [1, 0, 0])"),
            "s#/pieces/0/direction");
  EXPECT_EQ(refused_at(R"("shape": "plane", "coefficients": [1, 1, 1, 0, 0, 0, 0, 0, 0, -1])"),
            "s#/pieces/0/coefficients");
  EXPECT_EQ(refused_at(R"("shape": "plane", "integral_bound_n": 1)"), "s#/pieces/0/integral_bound_n");
  EXPECT_EQ(refused_at(R"("shape": "plane", "integral_leak_per_s": 1)"), "s#/pieces/0/integral_leak_per_s");
  EXPECT_NE(refused_at(R"("shape": "sphere")"), "read");  // without a radius
  EXPECT_NE(refused_at(R"("shape": "plane", "dampng": 1)"), "read");
}

}  // namespace
}  // namespace tacto::playback
