// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/fit/response_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numeric>
#include <optional>
#include <span>

#include "analysis/identify/fit/model_choice.hpp"
#include "analysis/identify/fit/response_fitter.hpp"
#include "analysis/identify/fit/shared_errors.hpp"
#include "analysis/identify/fit/starting_values.hpp"
#include "analysis/identify/fit/three_poles.hpp"
#include "analysis/identify/measure/angles.hpp"
#include "analysis/identify/measure/hold.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/base/statistics.hpp"

namespace tacto::analysis {
namespace {

constexpr std::size_t kFewest = 16, kShortest = 4;  // frequencies
constexpr std::size_t kFractions[] = {8, 6, 4, 3, 2};
constexpr double kMostUneven = 22;

// Sums for a part of the band; a frequency has two values.
struct PartSize {
  double values = 0, squares = 0;
  double variance() const { return squares / values; }
  double logarithms() const { return values * std::log(variance()); }
};

double bartlett(const PartSize& part, const PartSize& rest) {
  const PartSize whole{part.values + rest.values, part.squares + rest.squares};
  const double apart = whole.logarithms() - part.logarithms() - rest.logarithms();
  return apart / (1 + (1 / part.values + 1 / rest.values - 1 / whole.values) / 3);
}

// Cumulative sums of the squares: before each frequency, and of all.
std::vector<double> sums_of_squares(std::span<const std::complex<double>> residuals) {
  std::vector<double> sums = {0};
  for (const auto& r : residuals) sums.push_back(sums.back() + std::norm(r));
  return sums;
}

struct ModelComparison {
  double statistic = 0, times = 1;
};

ModelComparison part_and_rest(std::span<const double> sums, std::size_t begin, std::size_t length) {
  const double values = 2 * static_cast<double>(length), all = 2 * static_cast<double>(sums.size() - 1),
               squares = sums[begin + length] - sums[begin];
  const PartSize part{values, squares}, rest{all - values, sums.back() - squares};
  if (!(part.squares > 0 && rest.squares > 0)) return {};
  return {bartlett(part, rest), std::sqrt(part.variance() / rest.variance())};
}

using Complex = std::complex<double>;

constexpr int kCurvePoints = 101;
constexpr int kNoiseRounds = 2;  // fit, then noise; a third round changes no value by a tenth of its error
constexpr double kMostOfWhatIsLeft = 0.5;  // ratio of the residuals' squares
constexpr std::size_t kMostStarts = 5;     // a second mode has five kinds
constexpr double kSuspect = 0.2;           // part of the residuals in one value that starts a search
constexpr double kSame = 1e-6;  // relative, of residual and logarithm of the pole: the same minimum

double r_squared_of(const BodeData& data, std::span<const Complex> modelled) {
  const Complex mean = std::accumulate(data.response.begin(), data.response.end(), Complex()) /
                       static_cast<double>(data.size());
  double left = 0, whole = 0;
  for (std::size_t i = 0; i < data.size(); ++i) {
    left += std::norm(data.response[i] - modelled[i]);
    whole += std::norm(data.response[i] - mean);
  }
  return 1 - left / whole;
}

void put_curve(const ResponseFitter& fitter, const ResponseModel& model, ResponseFit& fit) {
  const double low_hz = fit.data.frequency_hz.front(), high_hz = fit.data.frequency_hz.back();
  for (int i = 0; i < kCurvePoints; ++i) {
    const double hz = low_hz * std::pow(high_hz / low_hz, i / (kCurvePoints - 1.0));
    fit.curve_hz.push_back(hz);
    fit.curve.push_back(model.at(fitter.values(), hz));
    if (fit.claims_intervals()) fit.band.push_back(fitter.times_95() * fitter.spread(hz));
  }
}

void note_overdamped(const ResponseModel& model, std::span<const double> values, ResponseFit& fit) {
  if (model.choice().finger || model.choice().second_mode) return;
  const auto splits = other_splits(model.choice().direction, values);
  if (splits.empty()) return;
  fit.notes.push_back(
      fmt::format("the mode is overdamped: of three real poles at {:.4g}, {:.4g} and {:.4g} Hz, no response "
                  "determines which is the electrical one; pole_hz is the one nearest '{}'",
                  splits[0][kPole], splits[1][kPole], values[kPole], model.base().name));
}

void put_parameters(const ResponseFitter& fitter, const ResponseModel& model, ResponseFit& fit) {
  for (std::size_t i = 0; i < fitter.values().size(); ++i) {
    const ModelParameter& p = model.parameters()[i];
    FittedParameter fitted{p.name, fitter.values()[i], fitter.values()[i], fitter.values()[i],
                           fitter.held(i)};
    if (!fitter.held(i) && fit.claims_intervals()) {
      const double c = p.coordinate(fitted.value), half = fitter.times_95() * fitter.standard_error(i);
      fitted.low = p.value(c - half);
      fitted.high = p.value(c + half);
    }
    if (fitter.held(i))
      fit.notes.push_back(fmt::format("{} is not separately identifiable in this band: held at {:.4g}",
                                      p.name, fitted.value));
    fit.parameters.push_back(std::move(fitted));
  }
  note_overdamped(model, fitter.values(), fit);
  put_curve(fitter, model, fit);
}

// Bartlett's test (1937) of a part of the band against the rest, with a mean of 0, for every part of an
// eighth, a sixth, a quarter, a third and a half of the frequencies. The threshold for the largest statistic
// is 22: for white Gaussian residuals of 16 to 1,000 frequencies, 5 in 10,000 exceed 18.4 to 22.6 (40,000
// draws each). Fewer than 16 frequencies, and parts without residuals, are not tested. Precondition: equal
// numbers of residuals and frequencies.
NoiseEvenness evenness_of(std::span<const std::complex<double>> residuals,
                          std::span<const double> frequency_hz) {
  const std::size_t n = residuals.size();
  if (n < kFewest) return {};
  const std::vector<double> sums = sums_of_squares(residuals);
  NoiseEvenness found;
  double most = kMostUneven;
  for (const std::size_t fraction : kFractions) {
    const std::size_t length = std::max(n / fraction, kShortest);
    for (std::size_t begin = 0; begin + length <= n; ++begin) {
      const ModelComparison compared = part_and_rest(sums, begin, length);
      if (compared.statistic <= most) continue;
      most = compared.statistic;
      found = {true, frequency_hz[begin], frequency_hz[begin + length - 1], compared.times};
    }
  }
  return found;
}

// The complete fit from one starting point, without suggestions.
ResponseFit fitted_from(const BodeData& data, const ResponseModel& model, std::vector<double> start) {
  ResponseFit fit;
  fit.choice = model.choice();
  fit.data = data;
  ResponseFitter fitter(fit.data, model, std::move(start));
  fitter.run();
  fit.modelled = fitter.modelled();
  fit.converged = fitter.solution().converged;
  fit.ended = fitter.ended();
  fit.iterations = fitter.solution().iterations;
  fit.condition = fitter.solution().condition;
  fit.r_squared = r_squared_of(data, fit.modelled);
  const auto residuals = turned_residuals(data, fit.modelled);
  fit.misfit = misfit_of(residuals, fitter.free_count(), data.noise_is_measured());
  // The noise is an upper bound, so correlated residuals below it are no misfit.
  if (data.noise_is_a_bound && fit.misfit.reduced_chi_squared <= fit.misfit.chi_squared_limit)
    fit.misfit.found = false, fit.misfit.words.clear();
  if (data.noise_from_residuals) fit.evenness = evenness_of(residuals, data.frequency_hz);
  if (fit.evenness.uneven) fitter.take_uneven_noise();
  fit.transducer = model.transducer(fitter.values());
  put_parameters(fitter, model, fit);
  return fit;
}

// The residuals of a fit: the sum of the whitened residuals' squares, and whether they look like noise.
struct RestOfFit {
  double left = 0;
  bool is_noise = false;
  bool is_even = false;  // the same size over the whole band
};
struct Outlier {
  std::size_t index = 0;  // of the frequencies, from 0
  double left = 1;        // ratio of the residuals' squares without it to those with it
  RestOfFit rest;         // of that fit
};

using LeftByFit = std::function<RestOfFit(const BodeData&)>;

constexpr double kTakes = 0.1;
constexpr double kNeverNoise = 1e-9;   // of tables
constexpr double kParameters = 4;      // longer models have more; then the test is a little too strict
constexpr std::size_t kTried = 3;      // of each kind of suspect
constexpr std::ptrdiff_t kBeside = 2;  // neighbours to each side

// Logarithmic distance of each amplitude from the median of its neighbours and itself.
std::vector<double> off_neighbours(const BodeData& data) {
  std::vector<double> off, sizes;
  for (const auto& value : data.response) sizes.push_back(std::abs(value));
  const auto count = static_cast<std::ptrdiff_t>(sizes.size());
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const auto from = std::clamp<std::ptrdiff_t>(i - kBeside, 0, count - 2 * kBeside - 1);
    std::vector<double> near(sizes.begin() + from, sizes.begin() + from + 2 * kBeside + 1);
    off.push_back(
        std::abs(std::log(sizes[static_cast<std::size_t>(i)] / schema::upper_median(std::span(near)))));
  }
  return off;
}

void add_largest(std::span<const double> values, std::vector<std::size_t>& list) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::partial_sort(order, order.begin() + kTried, std::greater{},
                            [&](std::size_t i) { return values[i]; });
  list.insert(list.end(), order.begin(), order.begin() + kTried);
}

// With two values fewer, left^((2 n - p - 2) / 2) is the probability of the F test.
bool is_never_noise(const BodeData& data, const RestOfFit& rest, double part_left) {
  const double n = static_cast<double>(data.size()), freedom = 2 * n - kParameters - 2;
  return data.noise_from_residuals && rest.is_noise && n * std::pow(part_left, freedom / 2) < kNeverNoise;
}

BodeData without_value(const BodeData& data, std::size_t index) {
  std::vector<std::size_t> kept(data.size());
  std::iota(kept.begin(), kept.end(), std::size_t{0});
  std::erase(kept, index);
  return part_of(data, kept);
}

// The value without which a fit's sum of squares is less than a tenth of that of all values. Fits are made
// without each of the values farthest from the median of five neighbours, and without each of the largest
// residuals by `shares`. From 16 values on, noise alone causes this in fewer than 1 of 10,000. If the noise
// is estimated from the residuals, also a value that removes more than Gaussian noise does once in 1e9
// tables (F test, two values of 2 n - p), if the rest is noise. Precondition: as many shares as values.
std::optional<Outlier> outlier_of(const BodeData& data, std::span<const double> shares, double left_by_all,
                                  const LeftByFit& left_by_fit) {
  if (data.size() < 2 * kLeastFrequencies) return std::nullopt;
  std::vector<std::size_t> suspects;
  add_largest(shares, suspects);
  add_largest(off_neighbours(data), suspects);
  std::ranges::sort(suspects);
  const auto same = std::ranges::unique(suspects);
  suspects.erase(same.begin(), same.end());
  std::optional<Outlier> found;
  for (const std::size_t index : suspects) {
    const RestOfFit rest = left_by_fit(without_value(data, index));
    const double left = rest.left / left_by_all;
    const bool takes = left < kTakes || is_never_noise(data, rest, left);
    if (takes && (!found || left < found->left)) found = Outlier{index, left, rest};
  }
  return found;
}

// Share of the constant noise in the power, at frequencies where |H| equals its RMS.
constexpr double kConstantParts[] = {1, 0.9, 0.5, 0.1, 0.01, 1e-3, 0};
constexpr double kRoundingPart = 1e-15;  // rounding error of an exact response, relative

struct NoiseShape {
  std::vector<double> powers;  // powers of the noise before multiplication by `scale`
  double scale = 0;
  double unlikeliness = 0;  // -2 log likelihood, with the most likely scale
};

double modelled_power(std::span<const std::complex<double>> values) {
  double sum = 0;
  for (const auto& value : values) sum += std::norm(value);
  return sum / static_cast<double>(values.size());
}

NoiseShape noise_shape(const BodeData& data, std::span<const std::complex<double>> modelled,
                       double constant_part) {
  NoiseShape shape;
  const double whole = modelled_power(modelled);
  double squares = 0, logs = 0;
  for (std::size_t i = 0; i < data.size(); ++i) {
    shape.powers.push_back(constant_part * whole + (1 - constant_part) * std::norm(modelled[i]));
    squares += std::norm(data.response[i] - modelled[i]) / shape.powers[i];
    logs += 2 * std::log(shape.powers[i]);
  }
  const double values = 2 * static_cast<double>(data.size());
  shape.scale = std::max(squares / values, kRoundingPart * kRoundingPart);
  shape.unlikeliness = values * std::log(shape.scale) + logs;
  return shape;
}

// Sets the noise with the largest likelihood among sigma^2 = a^2 (a vibrometer's), b^2 |H|^2 (a lock-in's
// range, a drifting gain) and mixes of both in steps of a factor 10 of power. H is the model; a and b come
// from the residuals, which are assumed to be Gaussian. Sets noise_from_residuals. Precondition: equal
// numbers of modelled and measured values.
BodeData with_noise_of_residuals(BodeData data, std::span<const std::complex<double>> modelled,
                                 std::size_t parameters) {
  NoiseShape best = noise_shape(data, modelled, kConstantParts[0]);
  for (const double part : kConstantParts) {
    NoiseShape shape = noise_shape(data, modelled, part);
    if (shape.unlikeliness < best.unlikeliness) best = std::move(shape);
  }
  const double values = 2 * static_cast<double>(data.size());
  const double scale = best.scale * values / (values - static_cast<double>(parameters));
  data.noise.clear();
  for (const double power : best.powers) data.noise.push_back(std::sqrt(scale * power));
  data.noise_from_residuals = true;
  return data;
}

}  // namespace

std::string evenness_words(const NoiseEvenness& evenness) {
  return fmt::format(
      "the noise is {:.2g} times as large from {:.4g} to {:.4g} Hz as elsewhere; intervals use the local "
      "residuals, a column of noise improves them",
      evenness.times, evenness.low_hz, evenness.high_hz);
}

double left_by(const ResponseFit& fit) {
  double sum = 0;
  for (const Complex& r : turned_residuals(fit.data, fit.modelled)) sum += std::norm(r);
  return sum;
}

std::vector<double> values_of(const ResponseFit& fit) {
  std::vector<double> values;
  for (const FittedParameter& p : fit.parameters) values.push_back(p.value);
  return values;
}

namespace {

// If fits are equal, as with three real poles, the one whose pole is nearest the base's is better.
bool is_better(const ResponseFit& fit, const ResponseFit& than, const ResponseModel& model) {
  const double left = left_by(fit), other = left_by(than);
  if (std::abs(left - other) > kSame * other) return left < other;
  const auto off = [&](const ResponseFit& of) {
    return std::abs(std::log(of.parameters[kPole].value / model.parameters()[kPole].base));
  };
  return off(fit) < off(than) - kSame;
}

// A complex pair can only be the mode's. If the fit would have to combine the pole with one of the mode's
// poles to such a pair, it stops at a bound; it continues after their roles are swapped.
ResponseFit with_roles_swapped(const BodeData& data, const ResponseModel& model, ResponseFit fit) {
  for (auto& values : other_splits(data.direction, values_of(fit))) {
    ResponseFit other = fitted_from(data, model, std::move(values));
    if (is_better(other, fit, model)) fit = std::move(other);
  }
  return fit;
}

ResponseFit best_of_one_mode(const BodeData& data, const ResponseModel& model) {
  std::optional<ResponseFit> best;
  for (auto& start : one_mode_starts(model, data)) {
    ResponseFit fit = fitted_from(data, model, std::move(start));
    if (!best || left_by(fit) < (1 - kSame) * left_by(*best)) best = std::move(fit);
  }
  return model.choice().finger ? *best : with_roles_swapped(data, model, std::move(*best));
}

ResponseFit best_fit(const BodeData& data, const ResponseModel& model, KnownValues& known);

// The best starting points from all models with one extension less, or earlier values of this model.
std::vector<Start> starts_by_smaller(const BodeData& data, const ResponseModel& model, KnownValues& known) {
  if (const auto own = known.find(name_of(model.choice())); own != known.end()) return {{own->second, 0}};
  std::vector<Start> starts;
  for (const Extension& added : kExtensions) {
    if (!(model.choice().*added.has)) continue;
    ModelChoice less = model.choice();
    less.*added.has = false;
    const ResponseModel smaller(less, model.base(), data);
    if (!known.contains(name_of(less))) known[name_of(less)] = values_of(best_fit(data, smaller, known));
    std::ranges::move(extended_starts(model, data, added, smaller, known[name_of(less)]),
                      std::back_inserter(starts));
  }
  std::ranges::sort(starts, {}, &Start::left);
  starts.resize(std::min(starts.size(), kMostStarts));
  return starts;
}

// The fit with the smallest residual of several starts.
ResponseFit best_fit(const BodeData& data, const ResponseModel& model, KnownValues& known) {
  if (model.choice().finger || name_of(model.choice()) == name_of({})) return best_of_one_mode(data, model);
  std::optional<ResponseFit> best;
  for (Start& start : starts_by_smaller(data, model, known)) {
    ResponseFit fit = fitted_from(data, model, std::move(start.values));
    if (!best || left_by(fit) < left_by(*best)) best = std::move(fit);
  }
  return *best;
}

// The product of two resonances does not determine their order; the first is the lower one.
std::vector<double> in_order(std::vector<double> values, const ModelChoice& choice) {
  if (!choice.second_mode || choice.finger || values[kSecondMode] > values[kResonance]) return values;
  std::swap(values[kSecondMode], values[kResonance]);
  std::swap(values[kSecondMode + 1], values[kDamping]);
  return values;
}

// Removes the intervals of a fit that turned out to be a misfit.
void claim_nothing(ResponseFit& fit) {
  fit.band.clear();
  for (FittedParameter& p : fit.parameters) p.low = p.high = p.value;
}

}  // namespace

// The hold is removed with the model of the first fit, whose error causes 2e-4 of itself in the result.
ResponseFit fit_once(const BodeData& data, const ModelChoice& choice, const schema::Transducer& base,
                     KnownValues& known) {
  const ResponseModel model(choice, base, data);
  const BodeData near = without_hold(data, [&](double hz) { return schema::actuator_response(base, hz); });
  ResponseFit fit = best_fit(near, model, known);
  const std::vector<double> values = in_order(values_of(fit), choice);
  known[name_of(choice)] = values;
  if (!(data.held_rate_hz > 0) && values == values_of(fit)) return fit;
  const BodeData nearer = without_hold(data, [&](double hz) { return model.at(values, hz); });
  return fitted_from(nearer, model, values);
}

const FittedParameter* ResponseFit::find(std::string_view name) const {
  const auto found = std::ranges::find(parameters, name, &FittedParameter::name);
  return found == parameters.end() ? nullptr : &*found;
}

namespace {

std::vector<double> shares_of(const ResponseFit& fit) {
  std::vector<double> shares;
  for (const Complex& r : turned_residuals(fit.data, fit.modelled)) shares.push_back(std::norm(r));
  return shares;
}

// Finds one value with most of the residual, whether or not the residual looks like noise.
std::optional<Outlier> found_outlier(const BodeData& data, const ModelChoice& choice,
                                     const schema::Transducer& base, const ResponseFit& fit) {
  const std::vector<double> shares = shares_of(fit);
  const double left = left_by(fit);
  const double suspect = data.noise_from_residuals ? kSuspect : kMostOfWhatIsLeft;
  if (!fit.misfit.found && *std::ranges::max_element(shares) < suspect * left) return std::nullopt;
  return outlier_of(data, shares, left, [&](const BodeData& rest) {
    KnownValues none;
    const ResponseFit other = fit_once(rest, choice, base, none);
    return RestOfFit{left_by(other), other.claims_intervals(), !other.evenness.uneven};
  });
}

void put_outlier(const Outlier& found, ResponseFit& fit) {
  fit.misfit.found = true;
  fit.misfit.words =
      fmt::format("frequency {} ({:.4g} Hz) is off: without it {:.3g} % of the residuals are left",
                  found.index + 1, fit.data.frequency_hz[found.index], 100 * found.left);
  fit.suggestion = "measure it again, or remove its line";
}

BodeData without_noise(BodeData data) {
  data.noise.clear();
  data.noise_freedom = 0;
  return data;
}

// Values that are far too large have small relative residuals; R^2 detects them.
void check_r_squared(ResponseFit& fit) {
  if (fit.misfit.found || fit.data.noise_is_measured() || fit.r_squared > kMostOfWhatIsLeft) return;
  fit.misfit.found = true;
  fit.misfit.words = fmt::format("R^2 is {:.3g}: some values are far from the rest", fit.r_squared);
}

// One model, without a search for outliers.
ResponseFit fit_alone(const BodeData& measured, const ModelChoice& choice, const schema::Transducer& base) {
  KnownValues known;
  return fit_once(with_noise_known(measured, choice, base, known), choice, base, known);
}

// A larger model can follow one wrong value: the value is the reason of a misfit, and `off` stays, if the
// rest needs no larger model.
ResponseFit chosen_fit(const BodeData& measured, ResponseFit fit, const schema::Transducer& base,
                       std::optional<Outlier>& off) {
  if (off && !(off->rest.is_noise && off->rest.is_even)) {
    const BodeData rest = without_value(measured, off->index);
    if (best_model(rest, fit_alone(rest, fit.choice, base), base).choice != fit.choice) off.reset();
  }
  return off ? fit : best_model(measured, std::move(fit), base);
}

}  // namespace

BodeData with_noise_known(BodeData data, const ModelChoice& choice, const schema::Transducer& base,
                          KnownValues& known) {
  if (data.has_noise()) return data;
  for (int round = 0; round < kNoiseRounds; ++round) {
    const ResponseFit fit = fit_once(data, choice, base, known);
    data = with_noise_of_residuals(std::move(data), fit.modelled, fit.parameters.size());
  }
  return data;
}

ResponseFit fit_response(const BodeData& measured, const ModelChoice& choice,
                         const schema::Transducer& base) {
  ModelChoice closed = choice;
  closed.open = false;
  ResponseFit fit = fit_alone(measured, closed, base);
  auto off = found_outlier(fit.data, closed, base, fit);
  if (choice.open) fit = chosen_fit(measured, std::move(fit), base, off);
  if (const double times = fit.misfit.noise_overstated; times > 0 && !measured.noise_is_a_bound) {
    fit = fit_response(without_noise(measured), choice, base);
    fit.noise_overstated = times;
    return fit;
  }
  const bool sound = fit.claims_intervals();
  if (!off) check_r_squared(fit);
  if (off) put_outlier(*off, fit);
  if (sound && fit.misfit.found) claim_nothing(fit);
  return fit;
}

std::vector<std::string> held_words(const ModelChoice& choice, const schema::Transducer& base) {
  if (choice.finger)
    return {fmt::format("all of '{}' is held: only stiffness, damping and mass are added to it", base.name)};
  const bool actuator = choice.direction == Direction::actuator;
  const char* const side = actuator ? "actuator" : "sensor";
  return {fmt::format("only the product of the bender's deflection per volt and the amplifier's gain is "
                      "determined: deflection {} at {} and the gain are held, the scale of the {} is fitted",
                      schema::for_people(base.deflection_m, schema::Dimension::length),
                      schema::for_people(base.max_voltage_v, schema::Dimension::voltage), side),
          fmt::format("of the stiffnesses of flexure and bender and the mass only (k_r + k_p) / m is "
                      "determined: k_r {:.4g} N/m and k_p {:.4g} N/m are held, the mass is fitted",
                      base.flexure_stiffness_n_per_m, base.bender_stiffness_n_per_m),
          fmt::format("only the product of the {}'s resistance and the bender's capacitance is determined: "
                      "the capacitance, {:.4g} F, is held",
                      actuator ? "amplifier" : "sensor", base.capacitance_f)};
}

}  // namespace tacto::analysis
