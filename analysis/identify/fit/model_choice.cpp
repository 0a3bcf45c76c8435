// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/fit/model_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "analysis/identify/fit/response_fitter.hpp"
#include "analysis/identify/fit/shared_errors.hpp"
#include "analysis/identify/measure/angles.hpp"

namespace tacto::analysis {
namespace {

constexpr double kStandardErrors = 2;
constexpr double kApart = 0.05;  // smallest logarithmic distance of two different resonances
constexpr double kMostDamping = std::numbers::sqrt2 / 2;  // from here on a mode's amplitude has no peak
constexpr double kNonlinear = 5e-3;                       // third harmonic; a 16-bit converter causes less

struct Candidate {
  ResponseFit fit;
  TriedModel tried;
  std::vector<double> deviances;  // one for each frequency, left out
  double chi_squared = 0;         // of the frequencies left out, reduced
  bool possible = false;
};

// Squares of the errors at frequencies left out of the fit: over the noise, one for each, and relative.
struct LeftOut {
  std::vector<double> squares;
  double absolute = 0;
};

LeftOut left_out_of(const ResponseFit& fit, const schema::Transducer& base) {
  const BodeData& data = fit.data;
  const ResponseModel model(fit.choice, base, data);
  LeftOut left{std::vector<double>(data.size()), 0};
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    std::vector<std::size_t> kept, out;
    for (std::size_t i = 0; i < data.size(); ++i) (i % kFolds == fold ? out : kept).push_back(i);
    const BodeData rest = part_of(data, kept), tested = part_of(data, out);
    ResponseFitter fitter(rest, model, values_of(fit));
    fitter.run();
    const auto modelled = modelled_by(model, tested, fitter.values());
    const auto errors = turned_residuals(tested, modelled);
    for (std::size_t i = 0; i < out.size(); ++i) {
      left.squares[out[i]] = std::norm(errors[i]);
      left.absolute += std::norm(tested.response[i] - modelled[i]);
    }
  }
  return left;
}

// Two resonances that are apart. A mode without a resonance, or one next to the other, follows another
// effect, as a hysteresis.
bool has_two_modes(const ResponseFit& fit) {
  if (!fit.choice.second_mode) return true;
  const auto value = [&](const char* name) { return fit.find(name)->value; };
  return std::abs(std::log(value("second_mode_hz") / value("resonance_hz"))) > kApart &&
         std::max(value("damping_ratio"), value("second_mode_damping_ratio")) < kMostDamping;
}

double sum_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

Candidate judged(ResponseFit fit, const schema::Transducer& base) {
  const double nan = std::nan("");
  Candidate made{std::move(fit), {}, {}, nan, false};
  made.tried = {name_of(made.fit.choice), made.fit.parameters.size(), nan, nan,
                made.fit.converged,       made.fit.misfit.found};
  if (!made.fit.converged) return made;
  const BodeData& data = made.fit.data;
  const LeftOut left = left_out_of(made.fit, base);
  double size = 0;
  for (const auto& value : data.response) size += std::norm(value);
  made.tried.left_out = std::sqrt(left.absolute / size);
  made.chi_squared = sum_of(left.squares) / (2 * static_cast<double>(data.size()));
  if (data.noise_is_measured()) made.tried.left_out_over_noise = std::sqrt(made.chi_squared);
  for (std::size_t i = 0; i < data.size(); ++i)
    made.deviances.push_back(left.squares[i] + 4 * std::log(data.noise[i]));
  made.possible = has_two_modes(made.fit);
  return made;
}

// The sum of the differences over its standard error.
double worse_by(const Candidate& one, const Candidate& than) {
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < one.deviances.size(); ++i) {
    const double difference = one.deviances[i] - than.deviances[i];
    sum += difference, squares += difference * difference;
  }
  return squares > 0 ? sum / std::sqrt(squares) : 0;
}

// The fewest parameters first.
std::vector<ModelChoice> choices_for(const BodeData& data) {
  std::vector<ModelChoice> list;
  const auto add = [&](std::initializer_list<bool ModelChoice::*> extensions) {
    ModelChoice choice{.direction = data.direction};
    for (const auto has : extensions) choice.*has = true;
    if (!choice.filter || data.direction == Direction::actuator) list.push_back(choice);
  };
  using M = ModelChoice;
  add({&M::delay});
  add({&M::filter});
  if (!data.loops_measured) add({&M::lag});
  add({&M::delay, &M::filter});
  add({&M::second_mode});
  add({&M::second_mode, &M::delay});
  add({&M::second_mode, &M::filter});
  add({&M::second_mode, &M::delay, &M::filter});
  return list;
}

std::vector<Candidate> candidates_of(const BodeData& measured, ResponseFit one_mode,
                                     const schema::Transducer& base) {
  KnownValues known{{name_of(one_mode.choice), values_of(one_mode)}};
  std::vector<Candidate> list;
  list.push_back(judged(std::move(one_mode), base));
  for (const ModelChoice& choice : choices_for(measured)) {
    const BodeData data = with_noise_known(measured, choice, base, known);
    list.push_back(judged(fit_once(data, choice, base, known), base));
  }
  return list;
}

// Errors within a bound of the noise say nothing about the model.
bool is_as_good(const Candidate& one, const Candidate& best) {
  const bool within_bound = one.fit.data.noise_is_a_bound && one.chi_squared <= 1;
  return within_bound || worse_by(one, best) <= kStandardErrors;
}

struct Choice {
  std::size_t chosen = 0, best = 0;
};

// Precondition: one is possible.
Choice choice_among(const std::vector<Candidate>& list) {
  std::size_t best = list.size();
  for (std::size_t i = 0; i < list.size(); ++i)
    if (list[i].possible && (best == list.size() || sum_of(list[i].deviances) < sum_of(list[best].deviances)))
      best = i;
  const auto chosen = std::ranges::find_if(list, [&](const Candidate& one) {
    const bool leaves_more = one.fit.misfit.found && !list[best].fit.misfit.found;
    return one.possible && !leaves_more && is_as_good(one, list[best]);
  });
  return {static_cast<std::size_t>(chosen - list.begin()), best};
}

std::string percent(double part) {
  return fmt::format("{:.3g} %", 100 * part);
}

std::string words_of(const Candidate& chosen, const Candidate& best) {
  if (chosen.tried.name == best.tried.name)
    return fmt::format(
        "{}: the smallest error on the frequencies left out of the fit ({}), and no model with "
        "fewer parameters is as good",
        chosen.tried.name, percent(chosen.tried.left_out));
  return fmt::format(
      "{}: the fewest parameters of the models whose error on the frequencies left out of the "
      "fit ({}) is not significantly above the smallest ({}, {})",
      chosen.tried.name, percent(chosen.tried.left_out), percent(best.tried.left_out), best.tried.name);
}

std::string misfit_words(const ResponseFit& fit) {
  std::string words =
      fit.choice_words.empty() ? "" : fmt::format("none of {} models leaves noise", fit.tried.size());
  if (fit.data.third_harmonic.value_or(0) > kNonlinear)
    words += fmt::format("{}the response has a third harmonic of {}: the device is not linear",
                         words.empty() ? "" : "; ", percent(*fit.data.third_harmonic));
  if (!fit.data.loops_measured) words += "; a hysteresis is fitted by --method joint, on a device";
  return words;
}

}  // namespace

ResponseFit best_model(const BodeData& measured, ResponseFit one_mode, const schema::Transducer& base) {
  if (measured.size() < 2 * kLeastFrequencies) {
    one_mode.choice_words =
        fmt::format("one mode: {} frequencies are too few to choose a model by", measured.size());
    return one_mode;
  }
  std::vector<Candidate> list = candidates_of(measured, std::move(one_mode), base);
  std::vector<TriedModel> tried;
  for (const Candidate& one : list) tried.push_back(one.tried);
  if (std::ranges::none_of(list, &Candidate::possible)) {
    ResponseFit fit = std::move(list.front().fit);
    fit.tried = std::move(tried);
    fit.choice_words = fmt::format("one mode: none of {} models converged", fit.tried.size());
    return fit;
  }
  const auto [chosen, best] = choice_among(list);
  ResponseFit fit = std::move(list[chosen].fit);
  fit.choice_words = words_of(list[chosen], list[best]);
  fit.tried = std::move(tried);
  if (fit.misfit.found || !fit.converged) fit.suggestion = misfit_words(fit);
  return fit;
}

std::string extension_words(const ResponseFit& fit) {
  std::vector<std::string> words;
  if (const auto* mode = fit.find("second_mode_hz"))
    words.push_back(fmt::format("a second mode at {:.4g} Hz", mode->value));
  if (const auto* filter = fit.find("reconstruction_cutoff_hz"))
    words.push_back(fmt::format("a reconstruction filter of {:.4g} Hz", filter->value));
  if (const auto* delay = fit.find("delay_ms"))
    words.push_back(fmt::format("a {} of {:.4g} us, which playback does not undo",
                                delay->value > 0 ? "delay" : "lead", 1e3 * std::abs(delay->value)));
  if (const auto* lag = fit.find("lag_rad"))
    words.push_back(
        fmt::format("a lag of {:.2g} degrees at all frequencies, which playback does not undo (on a "
                    "device --method joint fits the hysteresis that causes it)",
                    kDegrees * lag->value));
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace tacto::analysis
