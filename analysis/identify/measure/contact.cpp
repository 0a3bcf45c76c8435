// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/measure/contact.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "data-schema/base/statistics.hpp"

namespace tacto::analysis {
namespace {

using Eigen::Index;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr std::size_t kLeastContacts = 10;
constexpr double kPulseEdge = 0.02;   // of the peak
constexpr double kDoublePulse = 1.6;  // of the median duration
// What a column varies by itself, re its variation, and its variation re its size. Below it are only the last
// of the six or seven digits of a table.
constexpr double kLeastVariation = 1e-4;

struct ContactInput {
  const char* column;
  const char* term;
  const char* word;
  double sign;  // of the column in the model
};
constexpr ContactInput kInputs[] = {{"velocity_mps", "impact coefficient, N s/m", "velocity", -1},
                                    {"acceleration_mps2", "effective mass, kg", "acceleration", -1},
                                    {"grip_n", "grip coefficient, N/N", "grip", 1}};

std::optional<std::size_t> column_of(const NumberTable& table, const std::string& name) {
  const auto found = std::ranges::find(table.names, name);
  if (found == table.names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - table.names.begin());
}

Eigen::VectorXd values_of(const NumberTable& table, std::size_t column) {
  Eigen::VectorXd values(static_cast<Index>(table.rows()));
  for (std::size_t row = 0; row < table.rows(); ++row)
    values[static_cast<Index>(row)] = table.at(row, column);
  return values;
}

// Why the last of `columns`, the constant first, cannot be fitted together with those before it; empty: it
// can.
std::string why_not_fitted(const Eigen::MatrixXd& columns) {
  const Index last = columns.cols() - 1;
  const Eigen::VectorXd column = columns.col(last);
  const double spread = (column.array() - column.mean()).matrix().norm();
  if (!(spread > kLeastVariation * column.norm())) return "is constant";
  const double own = std::abs(Eigen::HouseholderQR<Eigen::MatrixXd>(columns).matrixQR()(last, last));
  if (own > kLeastVariation * spread) return {};
  return fmt::format("is a linear function of the columns before it, within {:.2g} of its spread",
                     kLeastVariation);
}

// `columns`: the constant first.
ContactFit fit_columns(const Eigen::MatrixXd& columns, const Eigen::VectorXd& peak,
                       std::span<const ContactInput> inputs) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  const Index terms = columns.cols(), taps = columns.rows();
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(taps, terms);
  const Eigen::MatrixXd r = qr.matrixQR().topRows(terms).triangularView<Eigen::Upper>();
  const Eigen::VectorXd value = qr.solve(peak);
  const Eigen::VectorXd residual = peak - columns * value;
  const double freedom = static_cast<double>(taps - terms);
  const Eigen::MatrixXd inverse =
      r.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(terms, terms));
  const double reach = schema::student_t(freedom, schema::kTwoSided95) * residual.norm() / std::sqrt(freedom);
  ContactFit fit;
  for (Index k = 0; k < terms; ++k) {
    const double half = reach * inverse.row(k).norm();
    fit.terms.push_back({k == 0 ? "constant, N" : inputs[static_cast<std::size_t>(k - 1)].term, value[k],
                         value[k] - half, value[k] + half});
  }
  for (const ContactInput& input : inputs)
    fit.inputs += (fit.inputs.empty() ? "" : ", ") + std::string(input.word);
  const Eigen::ArrayXd kept = 1 - q.rowwise().squaredNorm().array();
  const double count = static_cast<double>(taps);
  fit.rms_n = residual.norm() / std::sqrt(count);
  fit.left_out_n = (residual.array() / kept).matrix().norm() / std::sqrt(count);
  return fit;
}

// The sample where the force last was at most `edge` before the peak, or first is after it, interpolated.
std::optional<double> crossing(const std::vector<double>& force, std::size_t peak, double edge, int step) {
  for (auto i = static_cast<std::ptrdiff_t>(peak); i >= 0 && i < std::ssize(force); i += step) {
    const auto at = static_cast<std::size_t>(i);
    if (force[at] > edge) continue;
    const double inner = force[static_cast<std::size_t>(i - step)];
    return static_cast<double>(i) - step * (edge - force[at]) / (inner - force[at]);
  }
  return std::nullopt;
}

// The sample of the peak of a parabola through the largest sample and its neighbours. The sample itself would
// be wrong by up to half a sample, which the decay multiplies by w^2.
double peak_place(const std::vector<double>& force, std::size_t largest) {
  const auto at = static_cast<double>(largest);
  if (largest == 0 || largest + 1 == force.size()) return at;
  const double before = force[largest - 1], after = force[largest + 1];
  const double bend = before - 2 * force[largest] + after;
  return bend < 0 ? at + (before - after) / (2 * bend) : at;
}

Result<ContactPulse> pulse_of(const Tap& tap, double rate_hz) {
  const auto broken = std::ranges::find_if_not(tap.value, [](double v) { return std::isfinite(v); });
  if (broken != tap.value.end())
    return fail(ErrorKind::unsuitable, "a value is not a number",
                fmt::format("tap {}, sample {}", tap.name, broken - tap.value.begin() + 1));
  // The baseline is the mean of the first four fifths of what comes before the largest distance from the
  // first sample.
  const double first = tap.value.front();
  const auto largest = static_cast<std::size_t>(
      std::ranges::max_element(tap.value, {}, [&](double v) { return std::abs(v - first); }) -
      tap.value.begin());
  const std::size_t silent = largest * 4 / 5;
  constexpr std::size_t kLeastSilence = 20;
  if (silent < kLeastSilence)
    return fail(ErrorKind::unsuitable, "there is no silence before it", "tap " + tap.name,
                "begin each tap 25 samples or more before the contact");
  double baseline = 0, noise = 0;
  for (std::size_t i = 0; i < silent; ++i) baseline += tap.value[i] / static_cast<double>(silent);
  for (std::size_t i = 0; i < silent; ++i) noise = std::max(noise, std::abs(tap.value[i] - baseline));
  const double sign = tap.value[largest] < baseline ? -1 : 1;
  std::vector<double> force;
  for (const double value : tap.value) force.push_back(sign * (value - baseline));
  ContactPulse pulse;
  pulse.name = tap.name;
  pulse.peak = force[largest];
  const double edge = kPulseEdge * pulse.peak;
  if (!(noise < edge))
    return fail(ErrorKind::unsuitable,
                fmt::format("the noise before it reaches {:.2g} % of its peak, the pulse is measured at 2 %",
                            100 * noise / pulse.peak),
                "tap " + tap.name, "tap harder, or omit it");
  const auto begin = crossing(force, largest, edge, -1), end = crossing(force, largest, edge, 1);
  if (!begin || !end)
    return fail(ErrorKind::unsuitable, "the force does not return to 2 % of its peak", "tap " + tap.name,
                "record until the surface is free again, or omit it");
  for (auto i = static_cast<std::size_t>(*begin) + 1; static_cast<double>(i) < *end; ++i)
    pulse.impulse += force[i] / rate_hz;
  pulse.duration_s = (*end - *begin) / rate_hz;
  const double turn = std::numbers::pi / pulse.duration_s;  // w, rad/s
  const double rise_s = (peak_place(force, largest) - *begin) / rate_hz;
  pulse.frequency_hz = turn / (2 * std::numbers::pi);
  pulse.decay_per_s = turn / std::tan(turn * rise_s);
  pulse.peak *= sign;
  pulse.impulse *= sign;
  return pulse;
}

std::string taps_words(const char* begin, std::size_t taps) {
  return fmt::format("{} {} {}", begin, taps, taps == 1 ? "tap" : "taps");
}

double mean_force(const ContactPulse& pulse) {
  return pulse.impulse / pulse.duration_s;
}

double middle(std::vector<double> values) {
  return schema::upper_median(std::span(values));
}

}  // namespace

bool has_peaks(const std::vector<std::string>& names) {
  return std::ranges::find(names, "peak_n") != names.end();
}

Result<ContactFits> fit_contact(const NumberTable& table, const std::string& source) {
  const auto peak = column_of(table, "peak_n"), velocity = column_of(table, kInputs[0].column);
  if (!peak || !velocity)
    return fail(ErrorKind::malformed, fmt::format("it has no column {}", peak ? "velocity_mps" : "peak_n"),
                source, "name the columns velocity_mps, peak_n, and if known acceleration_mps2 and grip_n");
  if (table.rows() < kLeastContacts)
    return fail(ErrorKind::unsuitable, taps_words("it has", table.rows()), source,
                fmt::format("tap {} times or more", kLeastContacts));
  for (std::size_t row = 0; row < table.rows(); ++row)
    if (!(table.at(row, *velocity) < 0))
      return fail(ErrorKind::malformed, "the velocity before contact is not negative",
                  fmt::format("{}, line {}, column velocity_mps", source, table.lines[row]),
                  "velocity and acceleration are positive away from the surface: change the sign of both");
  Eigen::MatrixXd columns = Eigen::MatrixXd::Ones(static_cast<Index>(table.rows()), 1);
  std::vector<ContactInput> inputs;
  ContactFits found;
  for (const ContactInput& input : kInputs) {
    const auto column = column_of(table, input.column);
    if (!column) continue;
    inputs.push_back(input);
    columns.conservativeResize(Eigen::NoChange, columns.cols() + 1);
    columns.rightCols(1) = input.sign * values_of(table, *column);
    std::string why = why_not_fitted(columns);
    if (why.empty()) {
      found.fits.push_back(fit_columns(columns, values_of(table, *peak), inputs));
      continue;
    }
    if (inputs.size() == 1)
      return fail(ErrorKind::unsuitable, "the velocity is the same for all taps", source,
                  "tap at different velocities");
    inputs.pop_back();
    columns.conservativeResize(Eigen::NoChange, columns.cols() - 1);
    found.unused_columns.push_back({input.column, std::move(why)});
  }
  return found;
}

Result<ContactPulses> contact_pulses(const Taps& taps, std::size_t fitted) {
  if (taps.taps.size() < kLeastContacts)
    return fail(ErrorKind::unsuitable, taps_words("found", taps.taps.size()), "taps",
                fmt::format("tap {} times or more", kLeastContacts));
  ContactPulses found;
  std::vector<double> durations_s;
  for (const Tap& tap : taps.taps) {
    auto pulse = pulse_of(tap, taps.rate_hz);
    TACTO_TRY(pulse);
    durations_s.push_back(pulse->duration_s);
    found.pulses.push_back(std::move(*pulse));
  }
  const double usual_s = middle(durations_s);
  double product = 0, square = 0;
  for (std::size_t i = 0; i < found.pulses.size(); ++i) {
    ContactPulse& pulse = found.pulses[i];
    pulse.is_double = pulse.duration_s > kDoublePulse * usual_s;
    if (pulse.is_double || i >= fitted) continue;
    ++found.fitted;
    product += pulse.peak * mean_force(pulse);
    square += mean_force(pulse) * mean_force(pulse);
  }
  found.shape_factor = product / square;
  std::vector<double> errors;
  for (std::size_t i = fitted; i < found.pulses.size(); ++i)
    if (const ContactPulse& pulse = found.pulses[i]; !pulse.is_double)
      errors.push_back(std::abs(found.shape_factor * mean_force(pulse) / pulse.peak - 1));
  found.predicted = errors.size();
  if (found.fitted < 2 || found.predicted < 2)
    return fail(ErrorKind::unsuitable,
                fmt::format("{} single pulses are fitted and {} predicted: two of each are needed",
                            found.fitted, found.predicted),
                "taps", "change --fit-on, or tap so that the tool does not bounce");
  found.worst_error = std::ranges::max(errors);
  found.median_error = middle(std::move(errors));
  return found;
}

}  // namespace tacto::analysis
