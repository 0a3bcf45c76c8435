// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/model/chain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tacto::playback {
namespace {

using Complex = std::complex<double>;

// Written out from Table I and equations (5), (6) of Wiertlewski 2011, scaled to 20 um/V at 0 Hz as the
// preset is.
Complex actuator(double f) {
  const Complex s(0, 2 * std::numbers::pi * f);
  const double stiffness = 76.47e3 + 4.05e3;
  return 20e-6 * stiffness / ((1.0 + 2 * 680 * 818e-9 * s) * (6.8e-3 * s * s + 4.49 * s + stiffness));
}

// The usual factored form; the filter has a real gain of 1 at 0 Hz and the denominator (1 + s) (1 + s + s^2).
Complex butterworth(double f) {
  const Complex s(0, f / 600);
  return 1.0 / ((1.0 + s) * (1.0 + s + s * s));
}

// Mean of exp(-s t) over one period of the hold, by Simpson's rule.
Complex held(double f, double rate_hz) {
  const auto at = [&](double t) { return std::polar(1.0, -2 * std::numbers::pi * f * t); };
  Complex sum = 0;
  for (int i = 0; i < 100; ++i)
    sum +=
        (at(i / 100. / rate_hz) + 4. * at((i + .5) / 100. / rate_hz) + at((i + 1) / 100. / rate_hz)) / 600.;
  return sum;
}

Chain full_chain() {
  auto transducer = schema::read_transducer("wiertlewski2011");
  EXPECT_TRUE(transducer);
  return {*transducer, Reconstruction::butterworth3, 600, Hold::zero_order, 2000};
}

void expect_close(Complex actual, Complex expected, double tolerance) {
  EXPECT_LT(std::abs(actual - expected), tolerance * std::abs(expected)) << actual << " " << expected;
}

// 1e-4: the preset keeps its scale with a few digits.
TEST(Chain, IsActuatorTimesFilterTimesHold) {
  Chain chain = full_chain();
  for (const double f : {0.0, 15.0, 143.0, 300.0, 500.0, 700.0}) {
    expect_close(chain_response(chain, f), actuator(f) * butterworth(f) * held(f, 2000), 1e-4);
  }
  chain.reconstruction = Reconstruction::none;
  chain.hold = Hold::none;
  expect_close(chain_response(chain, 300), actuator(300), 1e-4);
}

// A filter in the transducer's file is part of the chain; a named one replaces it.
TEST(Chain, ATransducersFilterIsInIt) {
  const Complex without = chain_response(full_chain(), 300) / butterworth(300);
  Chain chain = full_chain();
  chain.transducer.reconstruction_cutoff_hz = 250;
  expect_close(chain_response(chain, 300), without * butterworth(300), 1e-12);
  chain.reconstruction = Reconstruction::none;
  expect_close(chain_response(chain, 300), without * schema::butterworth3_response(250, 300), 1e-12);
}

TEST(Chain, FullInverseUndoesAllOfIt) {
  const Chain chain = full_chain();
  for (const double f : {15.0, 143.0, 500.0})
    expect_close(chain_response(chain, f) * inverse_response(chain, Inverse::full, f), 1, 1e-12);
}

TEST(Chain, LesserInversesLeavePhaseOrAll) {
  const Chain chain = full_chain();
  const Complex left = chain_response(chain, 300) * inverse_response(chain, Inverse::magnitude, 300);
  EXPECT_NEAR(std::abs(left), 1, 1e-12);
  EXPECT_NEAR(std::arg(left), std::arg(chain_response(chain, 300)), 1e-12);
  expect_close(inverse_response(chain, Inverse::gain, 300), 1 / 20e-6, 1e-4);
}

}  // namespace
}  // namespace tacto::playback
