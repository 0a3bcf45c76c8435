// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/render/at_speed.hpp"

#include <cmath>

#include "spatial/features/band_kept.hpp"

namespace tacto::playback {

bool AtSpeed::can_be_played() const {
  return fits_limits() && power_kept_percent >= kLeastPowerPercent;
}

schema::Result<AtSpeed> at_speed(const schema::Texture& texture, const schema::Transducer& transducer,
                                 const RenderOptions& options, double speed_mps) {
  // The reference is linear in the gain: with a small one no limit changes the drive.
  constexpr double kSmall = 1e-6;
  RenderOptions free = options;
  free.engine = Engine::reference;
  free.gain_m_per_n *= kSmall;
  const double length_m = texture.signal.length_m();
  const FingerPath path{{0, length_m / speed_mps}, {0, length_m}};
  const auto rendered = render(texture, path, transducer, free);
  TACTO_TRY(rendered);
  AtSpeed answer{speed_mps, rendered->peaks.tightest(), 0};
  answer.tightest.value /= kSmall;
  answer.power_kept_percent = spatial::band_kept_percent(texture, speed_mps, options.band);
  return answer;
}

std::optional<double> largest_speed_mps(const schema::Texture& texture, const schema::Transducer& transducer,
                                        const RenderOptions& options) {
  constexpr double kFrom = 1e-3, kTo = 2, kExact = 1.01;
  const double step = std::exp2(0.25);
  const auto can = [&](double speed_mps) {
    const auto answer = at_speed(texture, transducer, options, speed_mps);
    return answer && answer->can_be_played();
  };
  double yes = kTo;
  while (yes >= kFrom && !can(yes)) yes /= step;
  if (yes < kFrom) return std::nullopt;
  if (yes == kTo) return yes;
  for (double no = yes * step; no / yes > kExact;) {
    const double between = std::sqrt(yes * no);
    (can(between) ? yes : no) = between;
  }
  return yes;
}

}  // namespace tacto::playback
