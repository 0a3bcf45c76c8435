// SPDX-License-Identifier: GPL-3.0-or-later
// Textures on pieces in space: the recorded force along the path, a bump map and a sine, their work, and the
// reference in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "data-schema/height/height_map.hpp"
#include "data-schema/texture/texture.hpp"
#include "firmware-host/core/scene/piece_texture.hpp"
#include "firmware-host/core/scene/scene_kernel.hpp"
#include "playback/prepare/scene/piece_block.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/render/reference/exact_scene.hpp"
#include "tests/playback/arm_on_pieces.hpp"

namespace tacto::playback {
namespace {

using schema::Piece;
using Space = ArmOnPieces::Place;

constexpr double kCount_m = 1e-6, kSample_m = 1e-5, kTurn = 2 * std::numbers::pi;

// Written to a file; `force_n` by the position.
schema::PieceTexture recording(const std::string& name, double length_m,
                               const std::function<double(double)>& force_n) {
  schema::Texture made;
  made.signal.pitch_m = kSample_m;
  for (std::size_t i = 0; i < static_cast<std::size_t>(std::lround(length_m / kSample_m)); ++i)
    made.signal.values.push_back(force_n(static_cast<double>(i) * kSample_m));
  const std::string path = testing::TempDir() + name;
  EXPECT_TRUE(schema::write_texture(path, made));
  return {schema::PieceTextureType::recording, path};
}

// The same, 200 um apart, 24 mm x 20 mm; `height_m` by the place from its centre.
schema::PieceTexture bump(const std::string& name, const std::function<double(double, double)>& height_m) {
  constexpr double kPitch_m = 2e-4;
  schema::HeightMap map;
  map.columns = 121, map.rows = 101, map.pitch_m = kPitch_m;
  for (int j = -50; j <= 50; ++j)
    for (int i = -60; i <= 60; ++i)
      map.height_m.push_back(static_cast<float>(height_m(kPitch_m * i, kPitch_m * j)));
  const std::string path = schema::height_map_path(testing::TempDir() + name);
  EXPECT_TRUE(schema::write_height_map(path, map, schema::Existing::replace));
  return {schema::PieceTextureType::bump, path};
}

// Periods of 0.31 to 1.7 mm.
double noise_n(double x) {
  double sum = 0;
  for (int i = 0; i < 8; ++i) sum += 0.05 * std::sin(kTurn * x / (1.7e-3 * std::pow(0.785, i)) + i * i);
  return sum;
}

Piece textured_floor(schema::PieceTexture texture) {
  Piece floor;
  floor.name = "floor";
  floor.stiffness_n_per_m = 1000;
  floor.texture = std::move(texture);
  return floor;
}

// The slope of a B-spline through 100 samples a period: within 1e-5 of the sine. The path begins half a
// sample before the first column of the map, and a sample is half a column behind its column.
TEST(PieceTextureTest, ARecordingIsThatOfItsPlaceOnTheWayForthAndBack) {
  constexpr double kAmplitude_n = 0.2, kPeriod_m = 1e-3;
  const auto sine = [&](double x) { return kAmplitude_n * std::sin(kTurn * x / kPeriod_m); };
  for (const auto& contact : {schema::PieceContact::ghost, schema::PieceContact::add})
    for (const double gain : {1.0, -2.0}) {
      Piece floor = textured_floor(recording("sine", 0.02, sine));
      floor.texture_gain = gain;
      ArmOnPieces on({floor}, kCount_m, contact);
      on.at({0, 0, 1e-3});
      EXPECT_EQ(on.at({0, 0, -1e-3})[0], 0) << "before the first way there is no direction";
      int judged = 0;
      for (int i = 1; i <= 1400; ++i) {
        const double x = 20e-6 * (i <= 700 ? i : 1400 - i);
        const Space force_n = on.at({x, 0, -1e-3});
        EXPECT_NEAR(force_n[2], 1, 1e-6);
        EXPECT_EQ(force_n[1], 0);
        if (x < 1.2e-3) continue;  // the fade at the end of the texture
        ++judged;
        EXPECT_NEAR(force_n[0], -gain * sine(x - kSample_m), 1e-4 * kAmplitude_n * std::abs(gain)) << i;
      }
      EXPECT_GT(judged, 1200);
      EXPECT_EQ(on.at({0, 0, 1e-3})[0], 0) << "nothing is touched";
    }
}

// Around a corner of 90 degrees the line of the path turns by d(angle) = -sin(angle) ds / kPathLine_m: of its
// length ln 2 kPathLine_m is lost.
TEST(PieceTextureTest, ThePathTurnsWithTheWay) {
  const auto sine = [](double x) { return 0.2 * std::sin(kTurn * x / 1e-3); };
  ArmOnPieces on({textured_floor(recording("corner", 0.02, sine))});
  on.at({0, 0, 1e-3});
  for (int i = 0; i <= 2000; ++i) on.at({2e-6 * i, 0, -1e-3});
  double largest_n = 0;
  for (int i = 1; i <= 3000; ++i) {
    const Space force_n = on.at({4e-3, 2e-6 * i, -1e-3});
    if (i < 1500) continue;  // 10 times kPathLine_m
    const double s = 4e-3 + 2e-6 * i - std::numbers::ln2 * double{core::kPathLine_m};
    // Half a tick's way, 1 um, in the place of the turn.
    EXPECT_NEAR(force_n[1], -sine(s - kSample_m), kTurn * 1e-3 * 0.2) << i;
    EXPECT_NEAR(force_n[0], 0, 1e-4) << i;
    largest_n = std::max(largest_n, std::abs(force_n[1]));
  }
  EXPECT_GT(largest_n, 0.19);
}

// A hand on closed curves, with and without contact: what it takes from the texture is at most the range of
// the integral of its force, however long the way is.
TEST(PieceTextureTest, ATextureGivesNoMoreThanItsRange) {
  // The mean is subtracted.
  ArmOnPieces on({textured_floor(recording("noise", 0.02, [](double x) { return 0.3 + noise_n(x); }))});
  double integral = 0, least = 0, most = 0;
  for (double x = 0; x < 0.02; x += kSample_m) {
    integral += noise_n(x) * kSample_m;
    least = std::min(least, integral), most = std::max(most, integral);
  }
  const double range_j = most - least;
  Space last = {}, last_n = {};
  double work_j = 0, absolute_j = 0, t = 0;
  for (int i = 0; i < 100'000; ++i) {
    // It stands still while it is lifted off and lowered, and goes on above the floor in between.
    const int of_turn = i % 5000;
    if (of_turn > 200 || (of_turn > 50 && of_turn < 150)) t += 1e-3;
    const Space place = {6e-3 * std::cos(2 * t) + 2e-3 * std::sin(5.3 * t), 6e-3 * std::sin(1.7 * t),
                         of_turn < 200 ? 1e-3 : -1e-3};
    const Space force_n = on.at(place);
    const double step_j = 0.5 * ((force_n[0] + last_n[0]) * (place[0] - last[0]) +
                                 (force_n[1] + last_n[1]) * (place[1] - last[1]));
    if (i > 0 && place[2] == last[2]) work_j += step_j, absolute_j += std::abs(step_j);
    last = place, last_n = force_n;
    // Ticks of up to 20 um: 2 % of a period of 0.31 mm by the trapezoidal rule, in places of both signs.
    EXPECT_LT(std::abs(work_j), 1.2 * range_j) << i;
  }
  EXPECT_GT(absolute_j, 500 * range_j);
  std::printf("[ measured ] work %.3g of %.3g uJ, range %.3g uJ\n", 1e6 * work_j, 1e6 * absolute_j,
              1e6 * range_j);
}

// 50 samples a period: the slope of the B-spline is that of the sine within 1e-5; the edges of the map, where
// it continues straight on, are 4 mm away. The steps of the ball's normal: see the reference below.
TEST(PieceTextureTest, ABumpIsTheSlopeTimesTheForceAlongTheNormal) {
  constexpr double kHeight_m = 2e-4, kPer_m = kTurn / 0.01, kRadius_m = 0.03;
  Piece floor = textured_floor(bump(
      "waves", [](double u, double v) { return kHeight_m * std::cos(kPer_m * u) * std::sin(kPer_m * v); }));
  floor.texture->axes = {{{0, 2, 0}, {-1, 3, 0}}};  // u along y, v against x
  floor.x_m = 1e-3;
  Piece ball = floor;
  ball.shape = schema::PieceShape::sphere, ball.radius_m = kRadius_m, ball.z_m = -kRadius_m;
  for (Piece piece : {floor, ball})
    for (const double gain : {1.0, -0.5}) {
      piece.texture_gain = gain;
      ArmOnPieces on({piece});
      on.at({0, 4e-3, 2e-3});
      for (int i = 0; i < 300; ++i) on.at({0, 4e-3, -3e-3});  // until its speed is forgotten
      const bool round = piece.shape == schema::PieceShape::sphere;
      double largest_n = 0;
      for (int i = 0; i < 2000; ++i) {
        const double t = 2e-3 * i;
        Space hand = {3e-3 * std::sin(2 * t), 4e-3 * std::cos(1.3 * t), -3e-3};
        for (double& along_m : hand) along_m = kCount_m * std::round(along_m / kCount_m);
        const Space force_n = on.at(hand);
        const Space arm = {hand[0] - piece.x_m, hand[1], hand[2] - piece.z_m};
        const double size = std::hypot(arm[0], arm[1], arm[2]);
        const Space normal = round ? Space{arm[0] / size, arm[1] / size, arm[2] / size} : Space{0, 0, 1};
        const double depth_m = round ? kRadius_m - size : -hand[2], normal_n = 1000 * depth_m;
        const double x = round ? kRadius_m * normal[0] : arm[0], y = round ? kRadius_m * normal[1] : arm[1];
        const double u = kPer_m * y, v = -kPer_m * x, scale = kHeight_m * kPer_m;
        const Space slope = {-scale * std::cos(u) * std::cos(v), -scale * std::sin(u) * std::sin(v), 0};
        const double out = slope[0] * normal[0] + slope[1] * normal[1];
        for (std::size_t j = 0; j < 3; ++j) {
          const double along_n = -gain * normal_n * (slope[j] - out * normal[j]);
          EXPECT_NEAR(force_n[j], normal_n * normal[j] + along_n, 2e-4 * normal_n * scale) << i;
          largest_n = std::max(largest_n, std::abs(along_n));
        }
      }
      EXPECT_GT(largest_n, 0.1);
    }
}

// On a closed path at a constant depth, on every shape. CHAI3D, whose force is no gradient on the surface: 3
// to 26 % (issue 32).
TEST(PieceTextureTest, ABumpDoesNoWorkOnAClosedPath) {
  Piece floor = textured_floor(bump("hills", [](double u, double v) {
    return 1e-4 * (std::sin(900 * u + 2) * std::cos(700 * v) + std::sin(1500 * u - 1100 * v));
  }));
  Piece ball = floor;
  ball.shape = schema::PieceShape::sphere, ball.radius_m = 0.02, ball.z_m = -0.02;
  for (const Piece& piece : {floor, ball}) {
    ArmOnPieces on({piece}, 1e-8);
    // Simpson's rule over the ticks of one turn, by the speed of the path.
    constexpr int kTicks = 24'000;
    double work_j = 0, absolute_j = 0;
    for (int i = -10; i < kTicks; ++i) {
      const double t = kTurn * i / kTicks, x = 5e-3 * std::cos(t),
                   y = 4e-3 * std::sin(t) + 1e-3 * std::sin(3 * t),
                   z = piece.shape == schema::PieceShape::sphere
                           ? std::sqrt(0.019 * 0.019 - x * x - y * y) - 0.02
                           : -1e-3;
      if (i == -10) on.at({x, y, 2e-3});
      const Space force_n = on.at({x, y, z});
      if (i < 0) continue;
      const double by_x = -5e-3 * std::sin(t), by_y = 4e-3 * std::cos(t) + 3e-3 * std::cos(3 * t),
                   by_z = piece.shape == schema::PieceShape::sphere ? -(x * by_x + y * by_y) / (z + 0.02) : 0;
      const double step_j = (force_n[0] * by_x + force_n[1] * by_y + force_n[2] * by_z) * kTurn / kTicks;
      work_j += step_j, absolute_j += std::abs(step_j);
    }
    std::printf("[ measured ] %s: work %.2g of %.3g uJ\n", std::string(to_string(piece.shape)).c_str(),
                1e6 * work_j, 1e6 * absolute_j);
    EXPECT_GT(absolute_j, 1e-5);
    EXPECT_LT(std::abs(work_j), 1e-6 * absolute_j);
  }
}

schema::PieceTexture sine(double amplitude_n, double p_m, double q_m) {
  schema::PieceTexture made;
  made.type = schema::PieceTextureType::sine;
  made.periods_m = {p_m, q_m}, made.amplitude_n = amplitude_n;
  return made;
}

TEST(PieceTextureTest, ASineIsAddedToTheForceAlongTheNormalAndNeverPulls) {
  constexpr double kAmplitude_n = 0.5, kP_m = 2e-3, kQ_m = 3e-3;
  for (const auto& contact : {schema::PieceContact::ghost, schema::PieceContact::add})
    for (const double gain : {1.0, -1.0}) {
      Piece floor = textured_floor(sine(kAmplitude_n, kP_m, kQ_m));
      floor.x_m = 4e-4, floor.texture_gain = gain;
      ArmOnPieces on({floor}, kCount_m, contact);
      on.at({0, 0, 1e-3});
      for (int i = 0; i < 3000; ++i) {
        const double t = 1e-3 * i;
        const Space hand = {2e-3 * std::sin(5 * t), 3e-3 * std::cos(4 * t),
                            -0.5e-3 + 0.7e-3 * std::cos(3 * t)};
        const Space force_n = on.at(hand);
        // The kernel knows the hand at whole counts.
        const double x = kCount_m * std::round(hand[0] / kCount_m) - floor.x_m,
                     y = kCount_m * std::round(hand[1] / kCount_m),
                     wall_n = std::max(0.0, -1000 * kCount_m * std::round(hand[2] / kCount_m));
        const double share = std::sin(kTurn * x / kP_m) * std::sin(kTurn * y / kQ_m);
        const double expected_n = wall_n + gain * std::min(kAmplitude_n, wall_n) * share;
        EXPECT_NEAR(force_n[2], expected_n, 1e-5) << i;
        EXPECT_GE(force_n[2], 0);
        EXPECT_LE(std::hypot(force_n[0], force_n[1]), 0) << "along the normal only";
      }
    }
}

// Places are in single precision from the origin of the piece: the bound says what was measured.
TEST(PieceTextureTest, TheKernelIsTheReference) {
  const auto hills = [](double u, double v) {
    return 1e-4 * (std::sin(900 * u + 2) * std::cos(700 * v) + std::sin(2500 * u - 1900 * v));
  };
  Piece floor = textured_floor(recording("rough", 0.02, noise_n)), ball = floor, pipe = floor, egg = floor;
  floor.direction = {1, 2, 8};
  ball.shape = schema::PieceShape::sphere, ball.radius_m = 0.02, ball.z_m = -0.02;
  pipe.shape = schema::PieceShape::cylinder, pipe.radius_m = 0.02, pipe.z_m = -0.02;
  pipe.direction = {0, 1, 0};
  egg.shape = schema::PieceShape::quadric, egg.z_m = -0.02;
  egg.coefficients = {1e3, 2e3, 2.5e3, 0, 0, 0, 0, 0, 0, -1};
  std::vector<Piece> pieces = {floor, ball, pipe, egg};
  for (std::size_t i = 0; i < 4; ++i) {
    pieces.push_back(pieces[i]);
    pieces.back().texture = bump("hilly", hills);
    pieces.push_back(pieces[i]);
    pieces.back().texture = sine(0.4, 1.7e-3, 2.3e-3);
  }
  for (Piece piece : pieces)
    for (const double by : {1.0, 8.0}) {
      piece.static_friction = piece.kinetic_friction = 0.3;
      ArmOnPieces on({piece});
      for (int i = 0; i < 4000; ++i) {
        const double t = 1e-3 * by * i;
        on.compare_at({4e-3 * std::sin(2 * t), 3e-3 * std::cos(3.1 * t), -1.5e-3 + 2e-3 * std::cos(0.9 * t)});
      }
      EXPECT_GT(on.largest_n, 0.5);
      EXPECT_LT(on.largest_error_n, 1e-4 * on.largest_n) << to_string(piece.shape) << by;
      std::printf("[ measured ] %s: %.2g of %.2g N\n", std::string(to_string(piece.shape)).c_str(),
                  on.largest_error_n, on.largest_n);
    }
}

}  // namespace
}  // namespace tacto::playback
