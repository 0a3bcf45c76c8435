// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "analysis/extremes/extreme.hpp"
#include "data-schema/base/decibels.hpp"
#include "playback/prepare/inverse_filter.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::analysis {
namespace {

using playback::Chain;
using schema::Transducer;

// The rate of the rows. Limits of a method are also given for the default rate of `play`.
constexpr double kInverseRateHz = 10e3, kPlayRateHz = 2e3, kInverseDelayS = 2e-3;
constexpr spatial::Band kInverseBand{15, 500};

Chain chain_of(const Transducer& t, double rate_hz = kInverseRateHz) {
  return {t, playback::Reconstruction::none, 600, playback::Hold::zero_order, rate_hz, 0};
}

playback::InverseFilter undone(const Transducer& t, double rate_hz = kInverseRateHz) {
  return playback::inverse_filter(chain_of(t, rate_hz), playback::Inverse::full, kInverseBand,
                                  {kInverseDelayS, 20, 2.5 * kInverseBand.high_hz});
}

// Residual of the stored (single-precision) taps, RMS over the band, at other frequencies than those of the
// design.
double left_by(const playback::InverseFilter& filter, const Transducer& t) {
  constexpr int kPlaces = 1999;
  double sum = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const double f = kInverseBand.low_hz +
                     (kInverseBand.high_hz - kInverseBand.low_hz) * (i + 1 / std::numbers::pi) / kPlaces;
    const double turn = -2 * std::numbers::pi * f / kInverseRateHz;
    std::complex<double> gain = 0;
    for (std::size_t n = 0; n < filter.taps.size(); ++n)
      gain += double{filter.taps[n]} * std::polar(1.0, turn * static_cast<double>(n));
    const auto target = std::polar(1.0, turn * kInverseRateHz * kInverseDelayS);
    sum += std::norm(gain * playback::chain_response(chain_of(t), f) - target);
  }
  return std::sqrt(sum / kPlaces);
}

Transducer with_damping(double ratio) {
  Transducer t = *schema::read_transducer("wiertlewski2011");
  const double stiffness = t.flexure_stiffness_n_per_m + t.bender_stiffness_n_per_m;
  t.damping_n_s_per_m = 2 * ratio * std::sqrt(stiffness * t.mass_kg);
  return t;
}

// The damping ratio does not change.
Transducer with_resonance(double frequency_hz) {
  Transducer t = *schema::read_transducer("wiertlewski2011");
  const double ratio = schema::damping_ratio(t), w = 2 * std::numbers::pi * frequency_hz;
  const double stiffness = t.flexure_stiffness_n_per_m + t.bender_stiffness_n_per_m;
  t.mass_kg = stiffness / (w * w);
  t.damping_n_s_per_m = 2 * ratio * std::sqrt(stiffness * t.mass_kg);
  return t;
}

Transducer with_pole(double frequency_hz) {
  Transducer t = *schema::read_transducer("wiertlewski2011");
  t.amplifier_resistance_ohm = 1 / (4 * std::numbers::pi * frequency_hz * t.capacitance_f);
  return t;
}

// The value at which the inverse's residual exceeds the limit for playback, by bisection between a value that
// works and one that fails.
template <class Make>
double breaks_at(Make make, double works, double fails, double rate_hz) {
  for (int i = 0; i < 12; ++i) {
    const double middle = std::sqrt(works * fails);
    const bool good = undone(make(middle), rate_hz).error_db <= playback::kMostInverseErrorDb;
    (good ? works : fails) = middle;
  }
  return works;
}

Extreme undone_row(std::string condition, const Transducer& t, double most, std::string note) {
  return {"playback", std::move(condition), "the chain's response in closed form", left_by(undone(t), t),
          most,       std::move(note)};
}

// Such a transducer is not played. The row checks that the design reports its residual correctly.
Extreme refused_row(std::string condition, const Transducer& t, std::string note) {
  const auto filter = undone(t);
  const bool said = filter.error_db > playback::kMostInverseErrorDb;
  const double stated = schema::amplitude_of_db(filter.error_db);
  return {"playback",
          std::move(condition) + ": refused",
          "the remaining error in closed form, against that of the design",
          said ? std::abs(left_by(filter, t) / stated - 1) : 1,
          0.02,
          std::move(note)};
}

}  // namespace

std::vector<Extreme> inverse_extremes() {
  const auto ends = [](const char* words, auto make, double works, double fails) {
    return fmt::format(
        "{} {:.3g} at {:g} Hz of ticks, {:.3g} at {:g} Hz: refused, it requires more than 20 dB", words,
        breaks_at(make, works, fails, kInverseRateHz), kInverseRateHz,
        breaks_at(make, works, fails, kPlayRateHz), kPlayRateHz);
  };
  return {undone_row("inverse of a damping ratio of 0.001", with_damping(0.001), 1e-2, {}),
          undone_row("inverse of a damping ratio of 1", with_damping(1), 1e-2, {}),
          refused_row("inverse of a damping ratio of 10", with_damping(10),
                      ends("a ratio above", with_damping, 0.1, 100)),
          refused_row("inverse of a resonance at 5 Hz", with_resonance(5),
                      ends("a resonance in Hz below", with_resonance, 547, 5)),
          undone_row("inverse of a resonance at 0.9 of half the rate", with_resonance(0.45 * kInverseRateHz),
                     1e-3, {}),
          undone_row("inverse of an electrical pole on the mechanical one",
                     with_pole(schema::resonance_hz(*schema::read_transducer("wiertlewski2011"))), 1e-3, {})};
}

}  // namespace tacto::analysis
