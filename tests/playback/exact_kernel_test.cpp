// SPDX-License-Identifier: GPL-3.0-or-later
// The whole kernel in single precision against its reference in double precision: a finger with varying
// speed, reversals and rests.
#include "playback/render/reference/exact_kernel.hpp"

#include <gtest/gtest.h>

#include "made_textures.hpp"
#include "tests/measured.hpp"
#include "tests/playback/rayleigh_law.hpp"

namespace tacto::playback {
namespace {

struct Setting {
  friend std::ostream& operator<<(std::ostream& out, const Setting& setting) { return out << setting.name; }
  const char* name;
  double rate_hz;
  Ends ends;
  double energy_rms_v;
  double gain;
  bool hysteresis = false;
};

class ExactKernelSettings : public testing::TestWithParam<Setting> {};

// Over 3 s, re the drive's RMS. TickKernel states the bound; it grows with the number of predicted ticks, by
// which the rounding of the speed is multiplied.
TEST_P(ExactKernelSettings, TheKernelIsWithinItsStatedError) {
  const Setting& setting = GetParam();
  PrepareOptions options;
  options.rate_hz = setting.rate_hz;
  options.ends = setting.ends;
  options.energy_rms_v = setting.energy_rms_v;
  options.energy_window_s = 0.1;
  options.contact_on_n = 0.2, options.contact_off_n = 0.1;
  const auto texture = texture_of(0.06, [](double x) {
    return 0.02 * (std::sin(kTwoPi * 1.1e3 * x) + 0.6 * std::sin(kTwoPi * 4.3e3 * x) +
                   0.3 * std::sin(kTwoPi * 23e3 * x));
  });
  auto transducer = *schema::read_transducer("wiertlewski2011");
  if (setting.hysteresis) transducer.hysteresis = rayleigh(0.16, 5, 16);
  const auto prepared = prepare(texture, transducer, options);
  ASSERT_TRUE(prepared) << message(prepared.error());
  core::TickKernel kernel;
  kernel.set(prepared->setup());
  ExactKernel exact(*prepared);
  double error = 0, size = 0;
  const auto ticks = static_cast<int>(3 * setting.rate_hz);
  for (int i = 0; i < ticks; ++i) {
    const double t = i / setting.rate_hz;
    const double x = 0.03 + 0.025 * std::sin(kTwoPi * 0.7 * t) + 2e-3 * std::sin(kTwoPi * 3.1 * t);
    const auto count = static_cast<std::int32_t>(std::floor(x / 1e-6));
    const float gain = static_cast<float>(t < 1.5 ? setting.gain : 0.5 * setting.gain);
    const float force_n = t > 2 && t < 2.1 ? 0.0F : 0.3F;
    const bool raise = t < 2.9;
    const double drive_v = kernel.tick({count, gain, raise, force_n}).drive_v;
    const double exact_v = exact.tick({count, gain, raise, force_n});
    error += (drive_v - exact_v) * (drive_v - exact_v);
    size += exact_v * exact_v;
  }
  EXPECT_GT(std::sqrt(size / ticks), 0.05) << "a drive of nothing proves nothing";
  std::printf("%s: %.1f dB of %.2f V\n", setting.name, 10 * std::log10(error / size),
              std::sqrt(size / ticks));
  measured("exact_kernel." + key_part(setting.name) + "_db", 10 * std::log10(error / size));
  EXPECT_LT(10 * std::log10(error / size), -105);
}

INSTANTIATE_TEST_SUITE_P(Settings, ExactKernelSettings,
                         testing::Values(Setting{"2 kHz, loop", 2e3, Ends::loop, 0, 2e-3},
                                         Setting{"2 kHz, stop, energy", 2e3, Ends::stop, 0.3, 2e-3},
                                         Setting{"10 kHz, mirror", 10e3, Ends::mirror, 0, 2e-3},
                                         Setting{"20 kHz, loop, energy", 20e3, Ends::loop, 0.5, 2e-3},
                                         Setting{"20 kHz, at the limits", 20e3, Ends::loop, 0, 20e-3},
                                         Setting{"2 kHz, hysteresis", 2e3, Ends::loop, 0, 2e-3, true},
                                         Setting{"20 kHz, hysteresis", 20e3, Ends::loop, 0, 2e-3, true}));

}  // namespace
}  // namespace tacto::playback
