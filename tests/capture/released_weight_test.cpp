// SPDX-License-Identifier: GPL-3.0-or-later
// A pull that is released, integrated here from the transducer's equations of motion (Wiertlewski 2011, (1)
// to (3)).
#include "capture/calibrate/released_weight.hpp"

#include <gtest/gtest.h>

#include <random>

#include "capture/record/record_header.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "tests/capture/sim_take.hpp"

namespace tacto::capture {
namespace {

using schema::ErrorKind;

constexpr double kRate_hz = 10e3, kStep_s = 1e-6;

// Semi-implicit Euler with steps of 1 us: within 1e-3 of the exact motion below 100 Hz.
std::vector<double> volts_of_release(const schema::Transducer& t, double force_n, double gain, double noise_v,
                                     std::uint64_t seed) {
  const double k_n_per_m = t.flexure_stiffness_n_per_m + t.bender_stiffness_n_per_m;
  const double tau_s = 2 * t.sensor_resistance_ohm * t.capacitance_f;
  const double v_per_n =
      t.sensor_scale * t.sensor_gain * t.deflection_m / (2 * t.max_voltage_v) / t.capacitance_f;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1);
  double x = force_n / k_n_per_m, v = 0, u = t.bender_stiffness_n_per_m * x;
  std::vector<double> volts;
  for (long step = 0; step < 1'000'000; ++step) {
    const double pull_n = step < 500'000 ? force_n : 0;
    v += kStep_s * (pull_n - t.damping_n_s_per_m * v - k_n_per_m * x) / t.mass_kg;
    x += kStep_s * v;
    u += kStep_s * (t.bender_stiffness_n_per_m * x - u) / tau_s;
    if (step % 100 == 99)
      volts.push_back(-gain * v_per_n * (t.bender_stiffness_n_per_m * x - u) + noise_v * normal(random));
  }
  return volts;
}

Release release(double force_n, double gain, double noise_v, std::uint64_t seed) {
  Release made;
  const auto transducer = *schema::read_transducer("wiertlewski2011");
  schema::Channel volts;
  volts.name = volts.quantity = "tangential_force";
  volts.unit = "V";
  volts.scale = 10 / 0x1p31;
  volts.range_max = 9.999;
  volts.range_min = -9.999;
  made.take.header.sample_rate_hz = kRate_hz;
  made.take.header.transducer = transducer;
  made.take.header.channels = {sensor_in_newtons(volts, transducer)};
  made.take.codes.resize(1);
  for (const double v : volts_of_release(transducer, force_n, gain, noise_v, seed))
    made.take.codes[0].push_back(std::clamp(std::round(v / volts.scale), -0x1p31, 0x1p31 - 1));
  made.force_n = force_n;
  return made;
}

TEST(ReleasedWeight, FindsThePiezosGain) {
  const std::vector<Release> one = {release(0.1, 0.94, 0, 1)};
  const auto found = scale_by_releases(one, "tangential_force", 0);
  ASSERT_TRUE(found) << schema::message(found.error());
  EXPECT_NEAR(found->scale.value * 0.94 / one[0].take.header.channels[0].scale, 1, 2e-3);
}

TEST(ReleasedWeight, ItsUncertaintyHoldsTheTruth) {
  Coverage coverage;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    std::vector<Release> three;
    for (std::uint64_t k = 0; k < 3; ++k) three.push_back(release(0.1, 1.1, 0.046, 3 * seed + k));
    const auto found = scale_by_releases(three, "tangential_force", 2e-3);  // covers this test's integration
    ASSERT_TRUE(found) << schema::message(found.error());
    coverage.add(found->scale, three[0].take.header.channels[0].scale / 1.1);
    EXPECT_LT(std::abs(found->scale.uncertainty / found->scale.value), 0.02);
  }
  EXPECT_GE(coverage.inside(), 0.74);  // of 12: three sigma below 95 %
  coverage.print("released_weight.scale");
}

TEST(ReleasedWeight, WrongInputsAreNamed) {
  const std::vector<Release> loud = {release(1, 1, 0, 1)};
  EXPECT_NE(scale_by_releases(loud, "tangential_force", 0).error().what.find("clipped"), std::string::npos);
  std::vector<Release> late = {release(0.1, 1, 0, 1)};
  late[0].take.codes[0].resize(5500);
  EXPECT_NE(scale_by_releases(late, "tangential_force", 0).error().where.find("tangential_force"),
            std::string::npos);
  const std::vector<Release> quiet = {release(1e-5, 1, 0.046, 1)};
  EXPECT_EQ(scale_by_releases(quiet, "tangential_force", 0).error().kind, ErrorKind::unsuitable);
  EXPECT_EQ(scale_by_releases(quiet, "force", 0).error().kind, ErrorKind::usage);
  EXPECT_EQ(scale_by_releases({}, "tangential_force", 0).error().kind, ErrorKind::usage);
  const std::vector<Release> cell = {{sim_take("finger=up", 1), 1}};
  EXPECT_EQ(scale_by_releases(cell, "net_force", 0).error().kind, ErrorKind::unsuitable);
}

}  // namespace
}  // namespace tacto::capture
