// SPDX-License-Identifier: GPL-3.0-or-later
// A bender with a hysteresis in its file: both engines judge with it, whether or not the drive inverts it.
#include <gtest/gtest.h>

#include "made_textures.hpp"
#include "playback/render/render.hpp"
#include "rayleigh_law.hpp"

namespace tacto::playback {
namespace {

constexpr double kRenderRateHz = 10e3;

// The tray by its equations, in steps of a hundredth of a tick: amplifier, play operators, and the mass on
// its spring (semi-implicit Euler).
std::vector<double> integrated(const schema::TimeSignal& drive_v, const schema::Transducer& t) {
  constexpr int kSteps = 100;
  const double dt = 1 / (kRenderRateHz * kSteps), pole = kTwoPi * schema::actuator_pole_hz(t);
  const double k = t.bender_stiffness_n_per_m + t.flexure_stiffness_n_per_m;
  const double rest_m_per_v = std::abs(schema::actuator_response(t, 0));
  std::vector<double> play_operators(t.hysteresis->weights.size()), all;
  double charge_v = 0, x = 0, v = 0;
  for (const double held_v : drive_v.values) {
    all.push_back(x);
    for (int step = 0; step < kSteps; ++step) {
      charge_v += dt * pole * (held_v - charge_v);
      double bent_v = 0;
      for (std::size_t i = 0; i < play_operators.size(); ++i) {
        const double r = t.hysteresis->thresholds_v[i];
        play_operators[i] = std::clamp(play_operators[i], charge_v - r, charge_v + r);
        bent_v += t.hysteresis->weights[i] * play_operators[i];
      }
      v += dt * (k * (rest_m_per_v * bent_v - x) - t.damping_n_s_per_m * v) / t.mass_kg;
      x += dt * v;
    }
  }
  return all;
}

double rms_of_middle(const std::vector<double>& values) {
  double sum = 0;
  for (std::size_t i = values.size() / 4; i < 3 * values.size() / 4; ++i) sum += values[i] * values[i];
  return std::sqrt(sum / (0.5 * static_cast<double>(values.size())));
}

class RenderHysteresis : public testing::Test {
 protected:
  RenderHysteresis() {
    bent_.hysteresis = rayleigh(0.16, bent_.drive_limit_v, 12);
    options_.hold = Hold::zero_order;
  }
  Rendering rendered(const schema::Transducer& transducer) const {
    auto rendering = render(texture_, path_, transducer, options_);
    EXPECT_TRUE(rendering) << message(rendering.error());
    return rendering ? std::move(*rendering) : Rendering{};
  }

  schema::Transducer straight_ = *schema::read_transducer("wiertlewski2011"), bent_ = straight_;
  schema::Texture texture_ = sine_texture(0.12, 3e3, 0.01);
  FingerPath path_ = steady_path(0.01, 0.04, 2);
  RenderOptions options_;
};

// Within 1 %: the play operators between two ticks, and Euler's steps.
TEST_F(RenderHysteresis, TheTrayIsTheIntegratedOne) {
  for (const Engine engine : {Engine::reference, Engine::kernel})
    for (const bool undo : {true, false}) {
      options_.engine = engine, options_.undo_hysteresis = undo;
      const Rendering rendering = rendered(bent_);
      std::vector<double> difference = integrated(rendering.drive_v, bent_);
      for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= rendering.modelled_m.values[i];
      EXPECT_LT(rms_of_middle(difference), 0.01 * rms_of_middle(rendering.modelled_m.values)) << undo;
    }
}

// The reference does not invert a hysteresis: its drive is the linear tray's, its error that of the tray with
// hysteresis, and equal to the kernel's without inversion.
TEST_F(RenderHysteresis, TheReferenceTellsWhatTheBenderDoes) {
  const Rendering linear = rendered(straight_), told = rendered(bent_);
  EXPECT_EQ(linear.drive_v.values, told.drive_v.values);
  EXPECT_LT(linear.error_db, -50);
  EXPECT_GT(told.error_db, -20);
  EXPECT_EQ(told.warnings.size(), 1U);
  options_.engine = Engine::kernel;
  EXPECT_LT(rendered(bent_).error_db, -20);  // includes the onset
  options_.undo_hysteresis = false;
  EXPECT_NEAR(rendered(bent_).error_db, told.error_db, 0.5);
}

TEST_F(RenderHysteresis, AReferenceHeldToAnErrorIsHeldToTheBenders) {
  options_.undo_hysteresis = false;  // otherwise a budget selects the kernel
  options_.budget.error.max_error = 0.01;
  const auto refused = render(texture_, path_, bent_, options_);
  ASSERT_FALSE(refused);
  EXPECT_NE(message(refused.error()).find("--keep-hysteresis"), std::string::npos)
      << message(refused.error());
}

}  // namespace
}  // namespace tacto::playback
