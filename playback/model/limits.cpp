// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/model/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data-schema/base/gain.hpp"

namespace tacto::playback {
namespace {

void raise(Peak& peak, double value, double time_s) {
  if (std::abs(value) <= peak.value) return;
  peak.value = std::abs(value);
  peak.time_s = time_s;
}

// The gain at which the tightest peak just fits if all peaks are proportional to it: gain / used, rounded
// down in the fourth digit.
double proportional_fit(const Peaks& peaks, double gain_m_per_n) {
  return schema::rounded_down(gain_m_per_n / peaks.tightest().used());
}

}  // namespace

const Peak& Peaks::tightest() const {
  const Peak& electric = drive_v.used() >= slew_v_per_s.used() ? drive_v : slew_v_per_s;
  return electric.used() >= displacement_m.used() ? electric : displacement_m;
}

Peaks peaks_of(std::span<const double> drive_v, std::span<const double> displacement_m, double rate_hz,
               const schema::Transducer& transducer, AfterDrive after) {
  Peaks peaks{{"drive", "V", 0, 0, transducer.drive_limit_v},
              {"slew", "V/s", 0, 0, transducer.slew_limit_v_per_s},
              {"displacement", "m", 0, 0, transducer.displacement_limit_m}};
  double before_v = 0;
  for (std::size_t i = 0; i < drive_v.size(); ++i) {
    const double time_s = static_cast<double>(i) / rate_hz;
    raise(peaks.drive_v, drive_v[i], time_s);
    raise(peaks.slew_v_per_s, (drive_v[i] - before_v) * rate_hz, time_s);
    before_v = drive_v[i];
  }
  if (after == AfterDrive::rest)
    raise(peaks.slew_v_per_s, before_v * rate_hz, static_cast<double>(drive_v.size()) / rate_hz);
  for (std::size_t i = 0; i < displacement_m.size(); ++i)
    raise(peaks.displacement_m, displacement_m[i], static_cast<double>(i) / rate_hz);
  return peaks;
}

double fitting_gain(double gain_m_per_n, Peaks peaks, const std::function<Peaks(double gain_m_per_n)>& at) {
  constexpr int kMostGains = 30;
  for (int tries = 0; tries < kMostGains && gain_m_per_n != 0; ++tries) {
    gain_m_per_n = proportional_fit(peaks, gain_m_per_n);
    peaks = at(gain_m_per_n);
    if (peaks.fit()) return gain_m_per_n;
  }
  return 0;
}

tl::unexpected<schema::Error> limit_passed(const Peak& peak, double fitting_m_per_n,
                                           double default_gain_m_per_n, bool may_clip) {
  const std::string fits =
      fitting_m_per_n > 0
          ? "the largest gain that fits is " + schema::gain_in_words(fitting_m_per_n, default_gain_m_per_n)
          : "use a smaller --gain";
  return schema::fail(schema::ErrorKind::unsuitable,
                      fmt::format("the {} reaches {:.4g} {}, its limit is {:.4g} {}", peak.name, peak.value,
                                  peak.unit, peak.limit, peak.unit),
                      fmt::format("drive, {:.4f} s after its start", peak.time_s),
                      fits + (may_clip ? "; --over-limit clip plays it clipped" : ""));
}

schema::Result<void> check_limits(const Peaks& peaks, double gain_m_per_n, double default_gain_m_per_n) {
  if (peaks.fit()) return {};
  return limit_passed(peaks.tightest(), proportional_fit(peaks, gain_m_per_n), default_gain_m_per_n, true);
}

std::size_t clip_drive(std::vector<double>& drive_v, double rate_hz, const schema::Transducer& transducer) {
  const double step_v = transducer.slew_limit_v_per_s / rate_hz;
  std::size_t changed = 0;
  double before_v = 0;
  for (double& value : drive_v) {
    const double unlimited = value;
    value = std::clamp(value, -transducer.drive_limit_v, transducer.drive_limit_v);
    value = std::clamp(value, before_v - step_v, before_v + step_v);
    changed += value != unlimited;
    before_v = value;
  }
  return changed;
}

}  // namespace tacto::playback
