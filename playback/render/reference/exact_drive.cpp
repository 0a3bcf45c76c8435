// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/render/reference/exact_drive.hpp"

#include <algorithm>
#include <cmath>

#include "playback/model/hysteresis_inverse.hpp"

namespace tacto::playback {
namespace {

constexpr double kPointsPerPeriod = 16;
constexpr int kMostRounds = 20;

void round_to_float(std::vector<double>& values) {
  for (double& value : values) value = static_cast<float>(value);
}

PaddedSpectrum modelled(const PaddedSpectrum& drive, const Chain& chain) {
  return through(drive, [&](double frequency_hz) { return chain_response(chain, frequency_hz); });
}

// The model is linear, so it gets the drive behind the bender's hysteresis.
PaddedSpectrum linear_drive_spectrum(const PaddedSpectrum& drive, const std::vector<double>& drive_v,
                                     const Chain& chain) {
  const schema::Transducer& t = chain.transducer;
  if (!t.hysteresis) return drive;
  const auto linear_v =
      linear_drive_of(drive_v, *t.hysteresis, schema::actuator_pole_hz(t), chain.sample_rate_hz);
  return spectrum_of(linear_v, drive.rate_hz, drive.period);
}

std::vector<double> inverted(const PaddedSpectrum& target, const Chain& chain, Inverse inverse) {
  return signal_of(through(target, [&](double f) { return inverse_response(chain, inverse, f); }));
}

ExactDrive played(std::vector<double> drive_v, const PaddedSpectrum& target, const Chain& chain,
                  std::size_t oversampling) {
  round_to_float(drive_v);
  const auto drive = spectrum_of(drive_v, target.rate_hz, target.period);
  const auto displacement = modelled(linear_drive_spectrum(drive, drive_v, chain), chain);
  const auto fine_m = signal_of(displacement, oversampling);
  const auto fine_v = oversampling > 1 ? signal_of(drive, oversampling) : drive_v;
  const double fine_rate_hz = target.rate_hz * static_cast<double>(oversampling);
  return {std::move(drive_v), signal_of(displacement),
          peaks_of(fine_v, fine_m, fine_rate_hz, chain.transducer)};
}

PaddedSpectrum clipped(const PaddedSpectrum& target, const spatial::Band& band, double ceiling_m) {
  auto values = signal_of(target);
  for (double& value : values) value = std::clamp(value, -ceiling_m, ceiling_m);
  auto spectrum = spectrum_of(values, target.rate_hz, target.period);
  keep_band(spectrum, band);
  return spectrum;
}

}  // namespace

ExactDrive exact_drive(const PaddedSpectrum& target, const spatial::Band& band, const Chain& chain,
                       Inverse inverse) {
  const double oversampling = std::max(1.0, std::ceil(kPointsPerPeriod * band.high_hz / target.rate_hz));
  return played(inverted(target, chain, inverse), target, chain, static_cast<std::size_t>(oversampling));
}

ExactDrive modelled_from(std::vector<double> drive_v, const PaddedSpectrum& target, const Chain& chain) {
  return played(std::move(drive_v), target, chain, 1);
}

schema::Result<ExactDrive> clipped_drive(const PaddedSpectrum& target, const spatial::Band& band,
                                         const Chain& chain, Inverse inverse) {
  double ceiling_m = chain.transducer.displacement_limit_m;
  for (int round = 0; round < kMostRounds; ++round) {
    auto drive_v = inverted(clipped(target, band, ceiling_m), chain, inverse);
    clip_drive(drive_v, target.rate_hz, chain.transducer);
    auto drive = played(std::move(drive_v), target, chain, 1);
    if (drive.peaks.displacement_m.used() <= 1) return drive;
    ceiling_m *= 0.99 / drive.peaks.displacement_m.used();
  }
  return schema::fail(schema::ErrorKind::unsuitable,
                      "the displacement stays above its limit even where it is clipped", {},
                      "use a smaller --gain");
}

}  // namespace tacto::playback
