// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/report/bode_curves.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/identify/fit/shared_errors.hpp"
#include "analysis/identify/measure/angles.hpp"
#include "data-schema/base/decibels.hpp"

namespace tacto::analysis {
namespace {

double decibels(double part) {
  return schema::amplitude_db(part);
}

double reference_of(const ResponseFit& fit) {
  if (const FittedParameter* gain = fit.find("gain_m_per_v")) return gain->value;
  const auto largest = std::ranges::max_element(fit.curve, {}, [](auto h) { return std::abs(h); });
  return fit.data.direction == Direction::actuator ? std::abs(fit.curve.front()) : std::abs(*largest);
}

void put_model(const ResponseFit& fit, double reference, BodeCurves& c) {
  c.model_deg = carried_phase_deg(fit.curve);
  for (std::size_t i = 0; i < fit.curve.size(); ++i) {
    c.model_db.push_back(decibels(std::abs(fit.curve[i]) / reference));
    c.inverse_db.push_back(-c.model_db.back());
    c.inverse_deg.push_back(-c.model_deg[i]);
    if (fit.band.empty()) continue;
    c.low_db.push_back(c.model_db.back() - decibels(1 + fit.band[i]));
    c.high_db.push_back(c.model_db.back() + decibels(1 + fit.band[i]));
  }
}

void put_data(const ResponseFit& fit, double reference, BodeCurves& c) {
  const std::vector<double> model_deg = carried_phase_deg(fit.modelled);
  for (std::size_t i = 0; i < fit.data.size(); ++i) {
    const auto model = fit.modelled[i], measured = fit.data.response[i];
    c.data_db.push_back(decibels(std::abs(measured) / reference));
    c.data_deg.push_back(model_deg[i] + std::arg(measured / model) * kDegrees);
  }
  for (const auto& residual : turned_residuals(fit.data, fit.modelled)) {
    c.along.push_back(residual.real());
    c.across.push_back(residual.imag());
  }
}

}  // namespace

BodeCurves bode_curves(const ResponseFit& fit) {
  BodeCurves c;
  const double reference = reference_of(fit);
  put_model(fit, reference, c);
  put_data(fit, reference, c);
  return c;
}

}  // namespace tacto::analysis
