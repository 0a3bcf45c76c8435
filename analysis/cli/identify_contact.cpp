// SPDX-License-Identifier: GPL-3.0-or-later
// `identify --method contact`: peak force of taps against velocity, acceleration and grip, or their pulses.
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "analysis/cli/identify_options.hpp"
#include "analysis/identify/measure/contact.hpp"
#include "data-schema/command/verb.hpp"

namespace tacto::analysis {
namespace {

using cli::Report;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr double kPercent = 100;

// The last fit has all inputs that can be fitted.
bool has_input(const std::vector<ContactFit>& fits, std::string_view input) {
  return fits.back().inputs.find(input) != std::string::npos;
}

void warn_of_negative_mass(const ContactFit& fit) {
  for (const ContactTerm& term : fit.terms)
    if (term.name.starts_with("effective mass") && term.high < 0)
      cli::warn(
          fmt::format("with {} the effective mass is negative ({:.3g} kg, 95 %: {:.3g} to {:.3g} kg): "
                      "has the acceleration the sign of the velocity, positive away from the surface?",
                      fit.inputs, term.value, term.low, term.high));
}

Report fits_report(const ContactFits& found, std::size_t taps) {
  Report report;
  const std::vector<ContactFit>& fits = found.fits;
  const ContactFit& best =
      *std::ranges::min_element(fits, {}, [](const ContactFit& fit) { return fit.left_out_n; });
  report.add("best_inputs", best.inputs)
      .add("because",
           fmt::format("the peak of a tap that is left out of the fit is predicted within {:.3g} N "
                       "(RMS, {} taps){}",
                       best.left_out_n, taps,
                       fits.size() == 1 ? "" : fmt::format(", the smallest error of {} fits", fits.size())));
  std::vector<std::string> unused;
  for (const UnusedColumn& column : found.unused_columns) {
    cli::warn(fmt::format("column {} {}: no fit has it", column.name, column.why));
    unused.push_back(column.name);
  }
  if (!unused.empty()) report.add("columns_not_fitted", unused);
  std::vector<Report> rows;
  for (const ContactFit& fit : fits) warn_of_negative_mass(fit);
  for (const ContactFit& fit : fits)
    for (const ContactTerm& term : fit.terms) {
      Report row;
      row.add("inputs", fit.inputs).add("coefficient", term.name).add("value", term.value);
      row.add("low_of_95", term.low).add("high_of_95", term.high);
      row.add("rms_n", fit.rms_n).add("left_out_rms_n", fit.left_out_n);
      rows.push_back(std::move(row));
    }
  std::string model = "peak = constant - impact coefficient x velocity";
  if (has_input(fits, "acceleration")) model += " - effective mass x acceleration";
  if (has_input(fits, "grip")) model += " + grip coefficient x grip force";
  report.add("model", model + "; velocity and acceleration before contact, positive away from the surface");
  report.add("fits", std::move(rows));
  if (has_input(fits, "acceleration"))
    report.add("mass",
               "the coefficient of the acceleration is not the mass that moves: in the paper's model of hand "
               "and surface it depends on grip and surface (0.31 to 0.54 kg where the paper's fit is 0.335 "
               "kg)");
  report.add(
      "paper",
      "Fiene and Kuchenbecker 2007, 300 taps that are not public: RMS error 0.205 N on velocity, 0.148 "
      "N with acceleration, 0.081 N with grip force");
  return report;
}

Report pulses_report(const ContactPulses& found) {
  Report report;
  std::string doubles;
  for (const ContactPulse& pulse : found.pulses)
    if (pulse.is_double) doubles += (doubles.empty() ? "" : ", ") + pulse.name;
  report.add("taps", found.pulses.size()).add("double_taps", doubles.empty() ? "none" : doubles);
  report.add("shape_factor", found.shape_factor)
      .add("because",
           fmt::format("peak = shape factor x impulse / duration (half a sine: 1.57), fitted on {} "
                       "single pulses; it predicts the peaks of {} others within {:.2g} % (median "
                       "{:.2g} %)",
                       found.fitted, found.predicted, kPercent * found.worst_error,
                       kPercent * found.median_error));
  report.add("predicted_peak_worst_percent", kPercent * found.worst_error)
      .add("predicted_peak_median_percent", kPercent * found.median_error);
  report.add("pulse",
             "from where the force leaves 2 % of its peak to where it returns there; a decaying "
             "sinusoid of the same duration and time of the peak has this frequency and decay. Peak: in the "
             "unit of the file; impulse: in that unit times seconds");
  std::vector<Report> rows;
  for (const ContactPulse& pulse : found.pulses) {
    Report row;
    row.add("tap", pulse.name).add("peak", pulse.peak).add("impulse", pulse.impulse);
    row.add("duration_s", pulse.duration_s).add("frequency_hz", pulse.frequency_hz);
    row.add("decay_per_s", pulse.decay_per_s).add("double", pulse.is_double);
    rows.push_back(std::move(row));
  }
  report.add("pulses", std::move(rows));
  return report;
}

}  // namespace

Result<Report> identify_contact(const IdentifyOptions& o) {
  if (o.file.empty() || !o.device_uri.empty())
    return fail(ErrorKind::usage, "taps come from a table", "--method contact",
                "identify taps.csv --method contact");
  const auto table = read_numbers(o.file);
  TACTO_TRY(table);
  if (has_peaks(table->names)) {
    if (o.rate_hz || o.taps_fitted > 0)
      return fail(ErrorKind::usage, "a table with a row for each tap has neither a rate nor taps to predict",
                  o.rate_hz ? "--rate" : "--fit-on", "omit it; every tap is predicted from the others");
    const auto fits = fit_contact(*table, o.file);
    TACTO_TRY(fits);
    return fits_report(*fits, table->rows());
  }
  if (!o.rate_hz)
    return fail(ErrorKind::usage, "the force of each tap over time needs its sample rate", "--method contact",
                "add --rate 100kHz, or give a table with one row for each tap and a column peak_n");
  const auto taps = read_taps(o.file, *o.rate_hz);
  TACTO_TRY(taps);
  const auto found = contact_pulses(*taps, o.taps_fitted > 0 ? o.taps_fitted : taps->taps.size() / 2);
  TACTO_TRY(found);
  return pulses_report(*found);
}

}  // namespace tacto::analysis
