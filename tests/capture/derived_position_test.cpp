// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/derived_position.hpp"

#include <gtest/gtest.h>

namespace tacto::capture {
namespace {

schema::RecordingHeader header(std::uint64_t frames, double rate_hz) {
  schema::RecordingHeader made;
  made.frames = frames;
  made.sample_rate_hz = rate_hz;
  return made;
}

std::vector<double> positions(DerivedPosition derived, const schema::RecordingHeader& header,
                              const std::vector<double>& stored) {
  std::vector<double> made;
  for (const double value : stored) made.push_back(derived.next(header, value));
  return made;
}

TEST(DerivedPosition, NominalIsSpeedTimesTimeWithGapsCounted) {
  auto made = header(4, 10);
  made.gaps = {{2, 2, 5}};
  const auto derived = DerivedPosition::nominal(-0.04);
  const auto values = positions(derived, made, std::vector<double>(4));
  const double target[] = {0, -0.004, -0.028, -0.032};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(values[i], target[i], 1e-17) << i;
  EXPECT_EQ(derived.channel().derivation, "nominal: -40 mm/s");
  EXPECT_EQ(derived.channel().unit, "m");
}

// The trapezoid rule is exact for a linearly increasing speed: x = a t^2 / 2, to rounding.
TEST(DerivedPosition, EvenAccelerationIsIntegratedExactly) {
  schema::Channel speed;
  speed.name = "speed";
  speed.scale = 1e-3;
  std::vector<double> stored(1000);
  for (std::size_t i = 0; i < stored.size(); ++i)
    stored[i] = 2.0 * static_cast<double>(i);  // mm/s at 1 kHz: 2 m/s^2
  const auto derived = DerivedPosition::integrated(speed);
  const auto values = positions(derived, header(1000, 1000), stored);
  for (std::size_t i = 0; i < stored.size(); ++i) {
    const double t_s = static_cast<double>(i) / 1000;
    EXPECT_NEAR(values[i], t_s * t_s, 1e-12) << i;
  }
  EXPECT_EQ(derived.channel().derivation, "integrated from speed (trapezoid rule)");
}

TEST(DerivedPosition, OffsetsCountAndGapsTakeTheirTime) {
  schema::Channel speed;
  speed.offset = 1;
  auto made = header(3, 1);
  made.gaps = {{2, 2, 3}};
  const std::vector<double> stored = {0, 0, 2};
  EXPECT_EQ(positions(DerivedPosition::integrated(speed), made, stored),
            (std::vector<double>{0, 1, 1 + 2 * 4}));
}

}  // namespace
}  // namespace tacto::capture
