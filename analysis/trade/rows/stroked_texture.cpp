// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/rows/stroked_texture.hpp"

#include <cmath>
#include <numbers>

#include "data-schema/base/quantity.hpp"
#include "spatial/texture/space_filter.hpp"

namespace tacto::analysis {
namespace {

constexpr double kShortest_m = 12e-3, kLongest_m = 40e-3, kCoarsest_m = 50e-6;
constexpr double kWanderPeriod_s = 0.0937;

schema::Result<void> check_texture(const schema::Texture& texture) {
  using schema::ErrorKind;
  if (texture.signal.length_m() < kShortest_m)
    return schema::fail(ErrorKind::unsuitable,
                        "is " + schema::length_for_people(texture.signal.length_m()) + " long, and " +
                            schema::length_for_people(kShortest_m) + " are needed",
                        "the texture", "use a longer texture");
  if (texture.signal.pitch_m > kCoarsest_m)
    return schema::fail(ErrorKind::unsuitable,
                        "has samples " + schema::length_for_people(texture.signal.pitch_m) +
                            " apart, and finer than " + schema::length_for_people(kCoarsest_m) + " is needed",
                        "the texture", "use a finer texture");
  return {};
}

double way_at(double time_s) {
  const double turn = 2 * std::numbers::pi / kWanderPeriod_s;
  return StrokedTexture::kSpeed_mps * (time_s + StrokedTexture::kWander * std::sin(turn * time_s) / turn);
}

}  // namespace

schema::Result<StrokedTexture> StrokedTexture::of(const schema::Texture& texture) {
  TACTO_TRY(check_texture(texture));
  StrokedTexture made;
  made.banded = texture;
  schema::SpaceSignal& signal = made.banded.signal;
  signal.origin_m = 0;
  signal.values.resize(std::min(signal.values.size(), static_cast<std::size_t>(kLongest_m / signal.pitch_m)));
  spatial::SpaceFilter band;
  band.low_per_m = kContentLow_hz / (kSpeed_mps * (1 - kWander));
  band.high_per_m = std::min(kContentHigh_hz / (kSpeed_mps * (1 + kWander)), 0.2 / signal.pitch_m);
  auto values = spatial::filter_in_space(signal.values, signal.pitch_m, band);
  TACTO_TRY(values);
  signal.values = std::move(*values);
  for (std::size_t i = 0; way_at(static_cast<double>(i) / kRate_hz) < signal.length_m(); ++i) {
    made.path.sample.push_back(static_cast<double>(i));
    made.path.way_m.push_back(way_at(static_cast<double>(i) / kRate_hz));
    made.force.push_back(made.value(made.path.way_m.back()));
  }
  return made;
}

double StrokedTexture::value(double position_m) const {
  return sinc(banded.signal.values, position_m / banded.signal.pitch_m);
}

double relative_error(const std::vector<double>& a, const std::vector<double>& b, std::size_t left_out) {
  double off = 0, all = 0;
  for (std::size_t i = left_out; i + left_out < b.size(); ++i) {
    off += std::pow(a[i] - b[i], 2);
    all += b[i] * b[i];
  }
  return std::sqrt(off / all);
}

}  // namespace tacto::analysis
