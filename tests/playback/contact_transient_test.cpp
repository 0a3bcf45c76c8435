// SPDX-License-Identifier: GPL-3.0-or-later
// The transient of a contact: its closed form against the equations of motion, the kernel's recurrence
// against the closed form and its peak, once a contact, without a step, what the limits of a device cut, and
// what is refused.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "firmware-host/core/scene/piece.hpp"
#include "playback/prepare/scene/contact_transient.hpp"
#include "playback/prepare/scene/piece_block.hpp"
#include "playback/prepare/scene/scene_device.hpp"

namespace tacto::playback {
namespace {

using schema::ContactTransient;
using schema::HandSurface;

constexpr double kTransientTick_s = 1e-3;
// Fiene and Kuchenbecker 2007, section 3; the decay is ours: 1 % after the 50 ms.
const ContactTransient kStudy = {32, 50, std::log(100) / 0.05};

schema::Piece piece_with(const ContactTransient& transient) {
  schema::Piece wall;
  wall.name = "wall";
  wall.stiffness_n_per_m = 900;
  wall.transient = transient;
  return wall;
}

schema::Piece piece_with(const HandSurface& model) {
  schema::Piece wall;
  wall.name = "wall";
  const SlowSurface slow = slow_surface(model);
  wall.stiffness_n_per_m = slow.stiffness_n_per_m;
  wall.damping_n_s_per_m = slow.damping_n_s_per_m;
  wall.hand_surface = model;
  return wall;
}

double peak_of(const ContactTransient& transient) {
  return transient_peak_n_s_per_m(*transient_of(piece_with(transient)));
}

struct Tapped {
  float numbers[core::kPieceNumbers] = {};
  core::PieceTable table;
  core::WallState state;

  explicit Tapped(const schema::Piece& piece) {
    table.transient = *transient_table(piece, 1 / kTransientTick_s, "s");
    numbers[core::kPieceStiffness] = static_cast<float>(piece.stiffness_n_per_m);
    numbers[core::kPieceDamping] = static_cast<float>(piece.damping_n_s_per_m);
  }
  double tick(double depth_m, double speed_mps) {
    const auto depth = static_cast<float>(depth_m);
    return double{
        core::wall_force(numbers, table, state,
                         {std::max(depth, 0.0F), std::max(-depth, 0.0F), static_cast<float>(speed_mps), 1000,
                          1e-5F, static_cast<float>(kTransientTick_s)})};
  }
};

double unit_draw(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

double closed_form(const ContactTransient& t, double speed_mps, double time_s) {
  return t.amplitude_n_s_per_m * speed_mps * std::sin(2 * std::numbers::pi * t.frequency_hz * time_s) *
         std::exp(-t.decay_per_s * time_s);
}

// Every other one near critical damping, where w is down to 1e-16 of a. The force rises as fast in all: the
// kernel ends what is below kTransientEnd_n.
std::vector<ContactTransient> random_transients() {
  std::mt19937_64 random(2007);
  std::vector<ContactTransient> all;
  for (int i = 0; i < 2000; ++i) {
    const double decay_per_s = 20 + 380 * unit_draw(random), amplitude = 100 * unit_draw(random) + 1;
    const double share = i % 2 == 0 ? std::pow(10, -1 - 15 * unit_draw(random)) : 1;
    const double low_hz = decay_per_s * share / (2 * std::numbers::pi);
    all.push_back({amplitude / share, i % 2 == 0 ? low_hz : 20 + 230 * unit_draw(random), decay_per_s});
  }
  return all;
}

TEST(ContactTransientTest, TheRecurrenceIsTheClosedForm) {
  constexpr double kSpeed_mps = 0.25;
  double worst = 0;
  for (const ContactTransient& transient : random_transients()) {
    Tapped wall(piece_with(transient));
    const double peak_n = kSpeed_mps * peak_of(transient);
    for (int i = 0; i < 300; ++i) {
      wall.tick(1e-3, -kSpeed_mps);
      const double error_n =
          double{wall.state.transient_n} - closed_form(transient, kSpeed_mps, i * kTransientTick_s);
      worst = std::max(worst, std::abs(error_n) / peak_n);
    }
  }
  EXPECT_LT(worst, 1e-5);  // the issue's bound; a prototype with the same rounding has 7e-7
  RecordProperty("of_the_peak", fmt::format("{:.2g}", worst));
}

// The hand at place x with the speed w, and u, the place to which its spring pulls it.
using Motion = std::array<double, 3>;

// One tick of the equations of motion of the model, by the Taylor series of their solution (they are linear).
Motion moved(const HandSurface& model, double speed_mps, const Motion& at) {
  constexpr int kParts = 16, kOrder = 14;
  constexpr double kPart_s = kTransientTick_s / kParts;
  Motion now = at;
  for (int part = 0; part < kParts; ++part) {
    Motion derivative = now;
    double pull_mps = speed_mps;  // of u, whose higher derivatives are 0
    double factor = 1;
    for (int order = 1; order <= kOrder; ++order) {
      const auto [x, w, u] = derivative;
      derivative = {w,
                    (model.hand_stiffness_n_per_m * (u - x) + model.hand_damping_n_s_per_m * (pull_mps - w) -
                     model.surface_stiffness_n_per_m * x - model.surface_damping_n_s_per_m * w) /
                        model.hand_mass_kg,
                    pull_mps};
      pull_mps = 0;
      factor *= kPart_s / order;
      for (std::size_t i = 0; i < now.size(); ++i) now[i] += factor * derivative[i];
    }
  }
  return now;
}

// Every other one near critical damping: by 0.1 to 1e-16 of it, on both sides.
std::vector<HandSurface> random_hands() {
  std::mt19937_64 random(12);
  std::vector<HandSurface> all;
  for (int i = 0; i < 2000; ++i) {
    HandSurface model{0.02 + unit_draw(random),
                      0,
                      2000 * unit_draw(random),
                      0,
                      std::pow(10, 2 + 2.5 * unit_draw(random)),
                      1};
    const double critical =
        2 * std::sqrt(model.hand_mass_kg * (model.hand_stiffness_n_per_m + model.surface_stiffness_n_per_m));
    const double side = random() % 2 == 0 ? -1 : 1;
    const double damping = critical * (i % 2 == 0 ? 1 + side * std::pow(10, -1 - 15 * unit_draw(random))
                                                  : 0.15 + 1.5 * unit_draw(random));
    const double share = unit_draw(random);
    model.hand_damping_n_s_per_m = share * damping;
    model.surface_damping_n_s_per_m = (1 - share) * damping;
    all.push_back(model);
  }
  return all;
}

// With the wall that the model is after its transient the whole force is that of the equations of motion: in
// double precision, and as the kernel computes it.
TEST(ContactTransientTest, AHandAndItsSurfaceAreThoseOfTheirEquationsOfMotion) {
  constexpr double kSpeed_mps = 0.25;
  double worst = 0, worst_of_kernel = 0;
  std::size_t played = 0;
  for (const HandSurface& model : random_hands()) {
    const schema::Piece piece = piece_with(model);
    const Transient transient = *transient_of(piece);
    const auto table = transient_table(piece, 1 / kTransientTick_s, "s");
    ASSERT_TRUE(table) << message(table.error());
    Tapped wall(piece);
    const double peak_n = kSpeed_mps * transient_peak_n_s_per_m(transient);
    Motion at{0, kSpeed_mps, 0};
    double most_n = 0;
    for (int i = 0; i < 60; ++i) {
      const double way_m = kSpeed_mps * kTransientTick_s * i;
      const double moving_n =
          model.surface_stiffness_n_per_m * at[0] + model.surface_damping_n_s_per_m * at[1];
      const double slow_n = piece.stiffness_n_per_m * way_m + piece.damping_n_s_per_m * kSpeed_mps;
      const double swing_n = kSpeed_mps * force_at(transient, i * kTransientTick_s);
      most_n = std::max(most_n, std::abs(moving_n));
      worst = std::max(worst, std::abs(slow_n + swing_n - moving_n) / std::max(peak_n, most_n));
      wall.tick(1e-3, -kSpeed_mps);
      worst_of_kernel =
          std::max(worst_of_kernel, std::abs(double{wall.state.transient_n} - swing_n) / peak_n);
      EXPECT_LE(std::abs(swing_n), peak_n * (1 + 1e-9));
      at = moved(model, kSpeed_mps, at);
    }
    played += wall.state.touched > 0;
  }
  EXPECT_EQ(played, 2000U);
  EXPECT_LT(worst, 1e-9);  // the issue's bounds
  EXPECT_LT(worst_of_kernel, 1e-5);
  RecordProperty("of_the_peak", fmt::format("{:.2g}, kernel {:.2g}", worst, worst_of_kernel));
}

TEST(ContactTransientTest, APeakOfTheModelIsReached) {
  for (const HandSurface& model : random_hands()) {
    const Transient transient = *transient_of(piece_with(model));
    const double last_s = 20 / transient.decay_per_s;
    double most = 0;
    for (int i = 0; i <= 4000; ++i) most = std::max(most, std::abs(force_at(transient, last_s * i / 4000)));
    // Second order of a step of 5e-3 / decay; the frequencies are up to 7 times the decay.
    EXPECT_NEAR(most / transient_peak_n_s_per_m(transient), 1, 1e-3);
  }
}

TEST(ContactTransientTest, ThePeakIsThatOfTheFormulaAndSamplesAreLittleBelowIt) {
  for (const ContactTransient& transient : random_transients()) {
    const double w = 2 * std::numbers::pi * transient.frequency_hz, a = transient.decay_per_s;
    const double peak = peak_of(transient);
    double at_formula = 0, sampled = 0;
    for (int i = 0; i < 300; ++i) {
      sampled = std::max(sampled, closed_form(transient, 1, i * kTransientTick_s));
      // Around the time of the peak, atan(w / a) / w, by 1e-4 of it.
      at_formula = std::max(at_formula, closed_form(transient, 1, std::atan(w / a) / w * (0.985 + 1e-4 * i)));
    }
    EXPECT_NEAR(at_formula / peak, 1, 1e-7);  // second order of 1e-4
    EXPECT_LE(sampled, peak * (1 + 1e-12));
    EXPECT_GE(sampled, peak * (1 - 1.6 * (a * a + w * w) * kTransientTick_s * kTransientTick_s / 8));
  }
}

TEST(ContactTransientTest, TheStudysBeginsAndEndsOnTheSpringWithoutAStep) {
  constexpr double kSpeed_mps = 0.2, kStiffness = 900;
  Tapped wall(piece_with(kStudy));
  double last_n = 0, largest_step_n = 0, most_n = 0;
  const double w = 2 * std::numbers::pi * kStudy.frequency_hz;
  for (int i = 0; i < 400; ++i) {
    const double t = i * kTransientTick_s;
    const double depth_m = 1e-6 + 0.002 * (1 - std::exp(-100 * t)), speed_mps = -0.2 * std::exp(-100 * t);
    const double force_n = wall.tick(depth_m, speed_mps);
    EXPECT_NEAR(force_n, std::max(0.0, kStiffness * depth_m + closed_form(kStudy, kSpeed_mps, t)), 1e-5) << i;
    largest_step_n = std::max(largest_step_n, std::abs(force_n - last_n));
    most_n = std::max(most_n, force_n);
    last_n = force_n;
    if (i >= 50) {
      EXPECT_LE(std::abs(force_n - kStiffness * depth_m), 0.01001 * 32 * kSpeed_mps) << i;
    }
  }
  // Nowhere steeper than the sine at its beginning and the spring.
  EXPECT_LT(largest_step_n, (32 * kSpeed_mps * w + kStiffness * kSpeed_mps) * kTransientTick_s);
  EXPECT_GT(most_n, kSpeed_mps * peak_of(kStudy));
  EXPECT_EQ(wall.state.transient_n, 0);  // below 1e-9 N since 1e-10 of 6.4 N, 250 ms
}

TEST(ContactTransientTest, ItStartsOnceAContact) {
  Tapped wall(piece_with(kStudy));
  wall.tick(1e-5, -0.2);
  for (int i = 1; i < 5; ++i) wall.tick(1e-4, -0.2);
  for (int i = 5; i < 8; ++i) EXPECT_EQ(wall.tick(-5e-5, 0.1), 0) << i;  // outside, but it has not let go
  for (int i = 8; i < 12; ++i) wall.tick(1e-4, -0.3);
  EXPECT_NEAR(double{wall.state.transient_n}, closed_form(kStudy, 0.2, 11e-3), 1e-5);
  wall.tick(-2e-4, 0.1);
  EXPECT_EQ(wall.state.transient_n, 0);
  wall.tick(1e-5, -0.3);
  EXPECT_EQ(wall.state.transient_n, 0);
  wall.tick(1e-4, -0.3);
  EXPECT_NEAR(double{wall.state.transient_n}, closed_form(kStudy, 0.3, 1e-3), 1e-5);
}

TEST(ContactTransientTest, AContactWithoutSpeedHasNone) {
  Tapped wall(piece_with(kStudy));
  wall.tick(1e-5, 0.2);  // outwards
  for (int i = 0; i < 20; ++i) {
    wall.tick(1e-4, -0.2);
    EXPECT_EQ(wall.state.transient_n, 0) << i;
  }
}

template <class Transient>
schema::Scene scene_with(const Transient& transient) {
  schema::Scene scene;
  scene.pieces = {piece_with(transient)};
  return scene;
}

// Arm: 10 N, 20 kN/s.
TEST(ContactTransientTest, WhatADeviceCutsIsSaid) {
  const schema::Device arm = *schema::read_device("arm");
  const auto whole_to = [&](const ContactTransient& t) {
    return transient_whole_to_mps(piece_with(t), arm, 1000);
  };
  // Without a wall the transient alone.
  const auto alone_to = [&](const ContactTransient& t) {
    schema::Piece piece = piece_with(t);
    piece.stiffness_n_per_m = 0;
    return transient_whole_to_mps(piece, arm, 1000);
  };
  EXPECT_NEAR(alone_to(kStudy) * peak_of(kStudy), 10, 1e-12);
  const ContactTransient steep = {20, 400, 400};
  EXPECT_NEAR(alone_to(steep) * 20 * 2 * std::numbers::pi * 400, 20'000, 1e-8);
  EXPECT_NEAR(whole_to(steep) * (20 * 2 * std::numbers::pi * 400 + 900), 20'000, 1e-8);
  for (const auto& [amplitude, notes] : {std::pair{64.0, 1U}, {32.0, 1U}, {16.0, 0U}}) {
    ContactTransient transient = kStudy;
    transient.amplitude_n_s_per_m = amplitude;
    EXPECT_EQ(whole_to(transient) < kFastTap_mps, notes == 1) << amplitude;
    const auto scene = prepare_scene(scene_with(transient), "s", arm, 1000);
    EXPECT_EQ(limits_of_pieces(*scene, arm, 1000, std::nullopt).size(), notes) << amplitude;
  }
}

TEST(ContactTransientTest, ItStopsItsMass) {
  // The impulse, by the sum over 1 us: the momentum of the mass.
  double impulse_ns = 0;
  for (int i = 0; i < 400'000; ++i) impulse_ns += 1e-6 * closed_form(kStudy, 1, i * 1e-6);
  EXPECT_NEAR(impulse_ns / transient_stops_kg(*transient_of(piece_with(kStudy))), 1, 1e-6);
}

TEST(ContactTransientTest, AFrequencyOfHalfTheRateIsRefused) {
  const schema::Device arm = *schema::read_device("arm");
  EXPECT_TRUE(prepare_scene(scene_with(ContactTransient{1, 499, 100}), "s", arm, 1000));
  const auto refused = prepare_scene(scene_with(ContactTransient{1, 500, 100}), "s", arm, 1000);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().where, "s#/pieces/0/transient/frequency_hz");
  const auto fast = prepare_scene(scene_with(HandSurface{0.001, 0.1, 0, 0, 1e5}), "s", arm, 1000);
  ASSERT_FALSE(fast);
  EXPECT_EQ(fast.error().where, "s#/pieces/0/hand_surface");
  const auto endless = prepare_scene(scene_with(HandSurface{0.1, 0.01, 0, 0, 1e3}), "s", arm, 1000);
  ASSERT_FALSE(endless);
  EXPECT_EQ(endless.error().where, "s#/pieces/0/hand_surface");
}

TEST(ContactTransientTest, ItIsReadWrittenAndCheckedAsJson) {
  const auto parsed = [](const std::string& transient, const char* member = "transient") {
    return schema::parse_scene(
        fmt::format(R"({{"kind": "scene", "version": "1.0", "pieces": [{{"name": "a", "shape": "plane",)"
                    R"( "place": {{"x_m": 0, "y_m": 0, "z_m": 0}}, "stiffness_n_per_m": 1, "{}": {}}}]}})",
                    member, transient),
        "s");
  };
  const auto scene = parsed(R"({"amplitude_n_s_per_m": 32, "frequency_hz": 50, "decay_per_s": 92})");
  ASSERT_TRUE(scene) << message(scene.error());
  const auto again = schema::parse_scene(*schema::scene_json(*scene, "s"), "s");
  ASSERT_TRUE(again) << message(again.error());
  const auto& transient = again->pieces.at(0).transient;
  ASSERT_TRUE(transient);
  EXPECT_EQ(transient->amplitude_n_s_per_m, 32);
  EXPECT_EQ(transient->frequency_hz, 50);
  EXPECT_EQ(transient->decay_per_s, 92);
  for (const char* wrong : {R"({"amplitude_n_s_per_m": 32, "frequency_hz": 50, "decay_per_s": -92})",
                            R"({"amplitude_n_s_per_m": 32, "frequency_hz": 50, "decay_per_s": 0})",
                            R"({"amplitude_n_s_per_m": -1, "frequency_hz": 50, "decay_per_s": 92})",
                            R"({"amplitude_n_s_per_m": 32, "frequency_hz": 0, "decay_per_s": 92})",
                            R"({"amplitude_n_s_per_m": 32, "decay_per_s": 92})",
                            R"({"amplitude_n_s_per_m": 1, "frequency_hz": 1, "decay_per_s": 1, "decy": 1})"})
    EXPECT_FALSE(parsed(wrong)) << wrong;
  const std::string hand =
      R"({"hand_mass_kg": 0.1, "hand_damping_n_s_per_m": 5, "hand_stiffness_n_per_m": 300,)"
      R"( "surface_stiffness_n_per_m": 2e4)";
  for (const auto& [more, amplitude] : {std::pair{"}", 0.86}, {R"(, "amplitude": 0.5})", 0.5}}) {
    const auto modelled = parsed(hand + more, "hand_surface");
    ASSERT_TRUE(modelled) << message(modelled.error());
    const auto twice = schema::parse_scene(*schema::scene_json(*modelled, "s"), "s");
    ASSERT_TRUE(twice) << message(twice.error());
    const auto& model = twice->pieces.at(0).hand_surface;
    ASSERT_TRUE(model);
    EXPECT_EQ(model->hand_stiffness_n_per_m, 300);
    EXPECT_EQ(model->surface_stiffness_n_per_m, 2e4);
    EXPECT_EQ(model->surface_damping_n_s_per_m, 0);
    EXPECT_EQ(model->amplitude, amplitude);
  }
  const auto both = parsed(
      R"({"amplitude_n_s_per_m": 1, "frequency_hz": 9, "decay_per_s": 9}, "hand_surface": )" + hand + "}");
  ASSERT_FALSE(both);
  EXPECT_EQ(both.error().where, "s#/pieces/0/hand_surface");
}

// Numbers with which the force would grow without an end.
TEST(ContactTransientTest, ABlockThatDoesNotDecayIsRefused) {
  const schema::Device arm = *schema::read_device("arm");
  PreparedScene scene = *prepare_scene(scene_with(kStudy), "s", arm, 1000);
  const auto fault_with = [&](const core::TransientTable& transient) {
    std::vector<std::uint32_t> words = scene.words;
    const auto bytes = static_cast<std::uint32_t>(words.size() * sizeof words[0]);
    auto* const at = reinterpret_cast<std::uint8_t*>(words.data());
    std::memcpy(at + bytes - sizeof(core::PieceTable) + offsetof(core::PieceTable, transient), &transient,
                sizeof transient);
    const std::uint32_t check = core::scene_check(at, bytes);
    std::memcpy(at + offsetof(core::SceneHeader, check), &check, sizeof check);
    core::SceneView view;
    return core::read_scene_block(at, bytes, view);
  };
  using enum core::SceneFault;
  for (const auto& [step, fault] : {std::pair{std::array{-0.1F, 0.3F, -0.3F, -0.1F}, none},
                                    {{-0.1F, 0, 0, -1}, none},
                                    {{-1.9F, 0, 0, -1}, none},
                                    {{0, 0, 0, 0}, value},
                                    {{0, 0, 0, -1}, value},
                                    {{0.1F, 0, 0, -1.5F}, value},
                                    {{-0.1F, 0.9F, -0.9F, -0.1F}, value},
                                    {{-2.1F, 0, 0, -1}, value},
                                    {{-2, 0, 0, -2}, value},
                                    {{std::nanf(""), 0, 0, -1}, value}})
    EXPECT_EQ(fault_with({{0, 32}, {step[0], step[1], step[2], step[3]}}), fault)
        << step[0] << ' ' << step[1];
  EXPECT_EQ(fault_with({{2e6F, 0}, {-1, 0, 0, -1}}), value);
  EXPECT_EQ(fault_with({{0, std::nanf("")}, {-1, 0, 0, -1}}), value);
}

}  // namespace
}  // namespace tacto::playback
