// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/psychometrics/psychometric_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/psychometrics/deviance.hpp"
#include "analysis/psychometrics/posterior_grid.hpp"

namespace tacto::analysis {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

std::vector<LevelCount> merged(std::vector<LevelCount> levels) {
  std::ranges::sort(levels, {}, &LevelCount::level);
  std::vector<LevelCount> each;
  for (const LevelCount& one : levels) {
    if (each.empty() || each.back().level != one.level) each.push_back({one.level, 0, 0});
    each.back().yes += one.yes;
    each.back().trials += one.trials;
  }
  return each;
}

double total_of(const std::vector<LevelCount>& levels, double LevelCount::*member) {
  return std::accumulate(levels.begin(), levels.end(), 0.0,
                         [&](double sum, const LevelCount& each) { return sum + each.*member; });
}

// The covariance of level and answer, times the number of trials.
double rise_of(const std::vector<LevelCount>& levels) {
  const double trials = total_of(levels, &LevelCount::trials),
               share = total_of(levels, &LevelCount::yes) / trials;
  double sum = 0;
  for (const LevelCount& each : levels) sum += each.level * (each.yes - share * each.trials);
  return sum;
}

Result<void> check_answers(const std::vector<LevelCount>& levels, const PsychometricOptions& options) {
  if (levels.size() < 2)
    return fail(ErrorKind::unsuitable, "all answers are at one level", {},
                "a function needs answers at two levels or more, better at six");
  if (options.shape == Shape::weibull && levels.front().level <= 0)
    return fail(ErrorKind::unsuitable, fmt::format("the level {:g} is not above 0", levels.front().level), {},
                "a Weibull function needs levels above 0: use --function normal");
  const double yes = total_of(levels, &LevelCount::yes), trials = total_of(levels, &LevelCount::trials);
  constexpr const char* kRemedy = "a bound is no estimate: measure at levels where both answers occur";
  if (yes == 0)
    return fail(
        ErrorKind::unsuitable,
        fmt::format("all {:g} answers are 'no': the threshold is above {:g}", trials, levels.back().level),
        {}, kRemedy);
  if (yes == trials)
    return fail(
        ErrorKind::unsuitable,
        fmt::format("all {:g} answers are 'yes': the threshold is below {:g}", trials, levels.front().level),
        {}, kRemedy);
  if (!(rise_of(levels) > 0))
    return fail(ErrorKind::unsuitable, "the answers don't become more frequent as the level rises", {},
                "name the column of the other answer with --yes");
  return {};
}

LevelRange range_of(const std::vector<double>& x) {
  LevelRange range{x.front(), x.back(), (x.back() - x.front()) / 4};
  for (std::size_t i = 1; i < x.size(); ++i) range.spacing = std::min(range.spacing, x[i] - x[i - 1]);
  return range;
}

// Whether F is 0 or 1 at all levels: then any smaller spread fits as well.
bool is_step(const PsychometricLikelihood& likelihood, const PsychometricPeak& peak) {
  constexpr double kNone = 1e-3;
  const auto tails = likelihood.tails(peak.centre, std::exp(peak.log_spread));
  return std::ranges::all_of(tails,
                             [](const auto& each) { return std::min(each.first, each.second) < kNone; });
}

double width_of(const PsychometricOptions& options) {
  return standard_quantile(options.shape, 0.95) - standard_quantile(options.shape, 0.05);
}

// Answers that give only a bound: a step between two neighbours, or a peak outside the priors.
Result<void> check_peak(const std::vector<LevelCount>& levels, const PsychometricLikelihood& likelihood,
                        const LevelRange& range, const PsychometricPeak& peak) {
  const PsychometricOptions& options = likelihood.options();
  const double threshold = level_of(options.shape, peak.centre);
  if (is_step(likelihood, peak)) {
    auto above = std::ranges::upper_bound(levels, threshold, {}, &LevelCount::level);
    above = std::clamp(above, levels.begin() + 1, levels.end() - 1);
    return fail(
        ErrorKind::unsuitable,
        fmt::format("the answers change at once between {:g} and {:g}: this bounds the threshold and the "
                    "JND",
                    (above - 1)->level, above->level),
        {}, "a bound is no estimate: measure at levels between these two");
  }
  if (width_of(options) * std::exp(peak.log_spread) > 3 * range.range())
    return fail(ErrorKind::unsuitable, "the answers depend too little on the level to estimate a threshold",
                {}, "measure over a wider range of levels, or more often");
  if (const double half = range.range() / 2;
      peak.centre < range.least - half || peak.centre > range.most + half)
    return fail(ErrorKind::unsuitable,
                fmt::format("the threshold is far outside the measured levels, near {:.3g}", threshold), {},
                "measure at levels around it");
  return {};
}

void judge_fit(PsychometricFit& fit, const PsychometricOptions& options) {
  for (const LevelCount& each : fit.levels) {
    const double p = fit.function(each.level), no = each.trials - each.yes;
    fit.deviance += deviance_part(each.yes, each.trials, p) + deviance_part(no, each.trials, 1 - p);
  }
  const std::size_t parameters = options.lapse ? 2 : 3;
  fit.freedom = fit.levels.size() - std::min(fit.levels.size(), parameters);
  fit.p = chi_squared_p(fit.deviance, fit.freedom);
}

void note_limits(PsychometricFit& fit, const PsychometricOptions& options, const LevelRange& range,
                 const PosteriorIntervals& intervals) {
  const double width = width_of(options);
  const std::string name = options.shape == Shape::weibull ? "exponent" : options.guess ? "width" : "JND";
  if (intervals.centre.low < range.least || intervals.centre.high > range.most)
    fit.notes.push_back(
        "the interval of the threshold reaches beyond the measured levels: measure further out");
  if (width * intervals.spread.high > 1.5 * range.range())
    fit.notes.push_back(fmt::format(
        "the interval of the {} is limited by the range of the levels: measure further out", name));
  if (width * intervals.spread.low < 1.5 * range.spacing)
    fit.notes.push_back(fmt::format(
        "the interval of the {} is limited by the distance between levels: measure between them", name));
}

}  // namespace

Result<PsychometricFunction> most_probable_function(std::vector<LevelCount> counts,
                                                    const PsychometricOptions& options) {
  const std::vector<LevelCount> levels = merged(std::move(counts));
  TACTO_TRY(check_answers(levels, options));
  const PsychometricLikelihood likelihood(levels, options);
  const PsychometricPeak peak = peak_of(likelihood);
  TACTO_TRY(check_peak(levels, likelihood, range_of(likelihood.scaled_levels()), peak));
  return PsychometricFunction{options.shape, peak.centre, std::exp(peak.log_spread), peak.lapse,
                              options.guess};
}

Result<PsychometricFit> fit_psychometric(std::vector<LevelCount> counts, const PsychometricOptions& options) {
  PsychometricFit fit;
  fit.levels = merged(std::move(counts));
  TACTO_TRY(check_answers(fit.levels, options));
  const PsychometricLikelihood likelihood(fit.levels, options);
  const LevelRange range = range_of(likelihood.scaled_levels());
  const PsychometricPeak peak = peak_of(likelihood);
  const double spread = std::exp(peak.log_spread);
  TACTO_TRY(check_peak(fit.levels, likelihood, range, peak));
  const PosteriorIntervals intervals = posterior_intervals(likelihood, range, peak);
  fit.function = {options.shape, peak.centre, spread, peak.lapse, options.guess};
  fit.threshold = {level_of(options.shape, peak.centre), level_of(options.shape, intervals.centre.low),
                   level_of(options.shape, intervals.centre.high)};
  fit.spread = {spread, intervals.spread.low, intervals.spread.high};
  fit.lapse_high = intervals.lapse_high;
  fit.overdispersion = peak.eta;
  fit.overdispersion_high = intervals.eta_high;
  judge_fit(fit, options);
  note_limits(fit, options, range, intervals);
  return fit;
}

}  // namespace tacto::analysis
