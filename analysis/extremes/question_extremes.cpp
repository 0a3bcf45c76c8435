// SPDX-License-Identifier: GPL-3.0-or-later
// Extremes of identify and compare.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/compare/compare.hpp"
#include "analysis/extremes/extreme.hpp"
#include "analysis/extremes/rough_signals.hpp"
#include "analysis/identify/fit/response_fit.hpp"
#include "data-schema/base/decibels.hpp"

namespace tacto::analysis {
namespace {

schema::Transducer damped(double ratio) {
  schema::Transducer t = *schema::read_transducer("wiertlewski2011");
  const double stiffness = t.flexure_stiffness_n_per_m + t.bender_stiffness_n_per_m;
  t.damping_n_s_per_m = 2 * ratio * std::sqrt(stiffness * t.mass_kg);
  return t;
}

ResponseFit fit_of(const schema::Transducer& truth) {
  constexpr int kFrequencies = 60;
  BodeData data;
  for (int i = 0; i < kFrequencies; ++i) {
    data.frequency_hz.push_back(10 * std::pow(100.0, i / (kFrequencies - 1.0)));
    data.response.push_back(schema::actuator_response(truth, data.frequency_hz.back()));
  }
  return fit_response(data, {}, *schema::read_transducer("wiertlewski2011"));
}

// The larger relative error of resonance and damping.
double parameter_error(const schema::Transducer& truth, const ResponseFit& fit) {
  const double resonance = fit.find("resonance_hz")->value / schema::resonance_hz(truth),
               damping = fit.find("damping_ratio")->value / schema::damping_ratio(truth);
  return std::max(std::abs(resonance - 1), std::abs(damping - 1));
}

// With three real poles no response determines which two are the tray's, so the response itself is compared.
double response_error(const schema::Transducer& truth, const ResponseFit& fit) {
  double error = 0;
  for (double hz = 10; hz <= 1000; hz *= 1.1) {
    const auto exact = schema::actuator_response(truth, hz);
    error =
        std::max(error, std::abs(schema::actuator_response(fit.transducer, hz) - exact) / std::abs(exact));
  }
  return error;
}

double level_error(double times) {
  schema::Texture a, b;
  a.signal.pitch_m = b.signal.pitch_m = 50e-6;
  a.signal.values = rough_values(8192);
  b.signal.values = rough_values(8192, times);
  CompareOptions options;
  options.formants = false;
  const auto comparison = compare(a, b, options);
  return comparison ? std::abs(comparison->power_level_db - schema::amplitude_db(times)) : INFINITY;
}

}  // namespace

std::vector<Extreme> identify_compare_extremes() {
  const schema::Transducer sharp = damped(1e-3), blunt = damped(5);
  std::vector<Extreme> rows{{"analysis",
                             "identify: a damping ratio of 0.001, no frequency within its resonance",
                             "the closed form's resonance and damping",
                             parameter_error(sharp, fit_of(sharp)),
                             1e-9,
                             {}},
                            {"analysis", "identify: a damping ratio of 5", "the closed form's response",
                             response_error(blunt, fit_of(blunt)), 1e-9,
                             "three real poles: no response determines which two are those of the tray"}};
  for (const double times : {1e-12, 1e12})
    rows.push_back({"analysis",
                    fmt::format("compare: a texture with itself {:g} times", times),
                    "20 log10 of it; in dB",
                    level_error(times),
                    1e-9,
                    {}});
  return rows;
}

}  // namespace tacto::analysis
