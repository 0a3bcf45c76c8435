// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/adjustment_answers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "analysis/experiment/live_setting.hpp"
#include "analysis/experiment/study_answers.hpp"
#include "analysis/psychometrics/over_people.hpp"
#include "data-schema/base/decibels.hpp"
#include "data-schema/base/quantity.hpp"
#include "playback/prepare/prepare.hpp"
#include "spatial/dsp/filter/fourier_filter.hpp"

namespace tacto::analysis {

using schema::Result;

namespace {

Result<double> unit_rms_m(const Study& study) {
  const auto& adjusted =
      *std::ranges::find(study.key.stimuli, study.protocol.standards.front(), &schema::CodedStimulus::name);
  const auto texture = schema::read_texture(study.stimulus(adjusted.code));
  TACTO_TRY(texture);
  const schema::ProtocolPace& pace = study.protocol.pace;
  const std::vector<double> in_band_n =
      spatial::fourier_filter(texture->signal.values, pace.speed_mps / texture->signal.pitch_m,
                              playback::PrepareOptions{}.band, spatial::Edges::treated);
  double squares = 0, count = 0;
  for (std::size_t i = 0; i < in_band_n.size(); ++i) {
    const double x = texture->signal.position_m(i);
    if (x < pace.from_m || x > pace.to_m) continue;
    squares += in_band_n[i] * in_band_n[i], ++count;
  }
  return study.protocol.gain_m_per_n * std::sqrt(squares / count);
}

std::string band_in_words(const schema::ProtocolPace& pace) {
  const spatial::Band band = playback::PrepareOptions{}.band;
  return fmt::format("{:g} to {:g} Hz at {}", band.low_hz, band.high_hz,
                     schema::for_people(pace.speed_mps, schema::Dimension::speed));
}

AdjustedPerson adjusted_person(const Run& run) {
  AdjustedPerson person;
  person.participant = run.journal.plan.participant;
  const schema::Protocol& protocol = run.study.protocol;
  for (const Attempt& attempt : run.queue.attempts())
    if (const auto ratio = accepted_ratio(attempt); ratio && attempt.counts()) {
      (attempt.trial.is_ascending() ? person.ascending : person.descending).push_back(*ratio);
      person.bounds += is_lowest(protocol, *ratio) || is_highest(protocol, *ratio) ? 1 : 0;
    }
  person.means = adjustment_means(person.ascending, person.descending);
  return person;
}

std::string interval_in_words(const Estimate& estimate) {
  return std::isfinite(estimate.high) ? fmt::format(" [{:.3f}, {:.3f}]", estimate.low, estimate.high) : "";
}

std::string ratio_in_words(const std::optional<Estimate>& ratio, double unit_rms_m) {
  if (!ratio) return "unknown: a series has no settings";
  return fmt::format("{:.3f}{}, {:.3g} um RMS", ratio->value, interval_in_words(*ratio),
                     1e6 * unit_rms_m * ratio->value);
}

std::string hysteresis_in_words(const std::optional<Estimate>& hysteresis_db) {
  if (!hysteresis_db) return "unknown";
  return fmt::format("{:.2f} dB{}", hysteresis_db->value, interval_in_words(*hysteresis_db));
}

std::string series_in_words(const std::optional<SeriesMean>& series) {
  if (!series) return "none";
  return fmt::format("{:.3f}{}, {}, {} settings", series->ratio.value, interval_in_words(series->ratio),
                     series->deviation_db ? fmt::format("deviation {:.2f} dB", *series->deviation_db)
                                          : std::string("deviation unknown"),
                     series->settings);
}

std::string bounds_in_words(const AdjustmentAnswers& all) {
  std::size_t bounds = 0, settings = 0;
  for (const AdjustedPerson& each : all.people) {
    bounds += each.bounds;
    settings += each.ascending.size() + each.descending.size();
  }
  if (bounds == 0) return "";
  return fmt::format(
      "{} of {} settings are at an end of the range: what was looked for may be beyond it, and "
      "a mean with them is a bound, too",
      bounds, settings);
}

schema::ResultPicture picture_of(const AdjustedPerson& person) {
  schema::ResultPicture picture{
      person.participant, "number of the setting in its series", "accepted ratio", false, {}};
  for (const auto& [name, ratios] :
       {std::pair<const char*, const std::vector<double>&>("ascending", person.ascending),
        {"descending", person.descending}}) {
    schema::ResultCurve& curve = picture.curves.emplace_back(schema::ResultCurve{name, {}, {}, false, true});
    for (const double ratio : ratios) {
      curve.x.push_back(static_cast<double>(curve.x.size() + 1));
      curve.y.push_back(ratio);
    }
  }
  return picture;
}

}  // namespace

Result<AdjustmentAnswers> adjustment_answers(const std::vector<Run>& runs) {
  AdjustmentAnswers all;
  all.goal = runs.front().study.protocol.goal;
  const auto unit = unit_rms_m(runs.front().study);
  TACTO_TRY(unit);
  all.unit_rms_m = *unit;
  all.band = band_in_words(runs.front().study.protocol.pace);
  std::vector<std::string> simulated;
  std::vector<double> ratios, hystereses;
  for (const Run& run : runs) {
    add_simulated(simulated, run);
    all.abandoned += run.queue.abandoned();
    const AdjustmentMeans& means = all.people.emplace_back(adjusted_person(run)).means;
    if (!means.middle) continue;
    ratios.push_back(means.middle->value);
    hystereses.push_back(schema::amplitude_of_db(means.hysteresis_db->value));
  }
  if (all.people.size() == 1) {
    all.ratio = all.people.front().means.middle;
    all.hysteresis_db = all.people.front().means.hysteresis_db;
  } else if (ratios.size() > 1) {
    all.ratio = geometric_mean(ratios);
    const Estimate factor = geometric_mean(hystereses);
    all.hysteresis_db = Estimate{schema::amplitude_db(factor.value), schema::amplitude_db(factor.low),
                                 schema::amplitude_db(factor.high)};
  }
  all.simulated = fmt::format("{}", fmt::join(simulated, "; "));
  return all;
}

Findings findings_of(const AdjustmentAnswers& all) {
  Findings findings;
  const std::string ratio = ratio_in_words(all.ratio, all.unit_rms_m);
  const bool one = all.people.size() == 1;
  const char* const of =
      one ? " (one person: middle of the two series, 95 % interval)" : " (mean over people, 95 % interval)";
  findings.figures.push_back({"verdict", fmt::format("{}: ratio {}", schema::word_of(all.goal), ratio)});
  findings.figures.push_back({"ratio to the protocol's gain", ratio + of});
  findings.figures.push_back(
      {"displacement",
       fmt::format("of the texture's force in the band that is played, {}, times the gain", all.band)});
  findings.figures.push_back({"descending minus ascending", hysteresis_in_words(all.hysteresis_db) + of});
  if (const std::string bounds = bounds_in_words(all); !bounds.empty())
    findings.figures.push_back({"bounds", bounds});
  if (all.abandoned > 0)
    findings.figures.push_back(
        {"abandoned",
         fmt::format("{} trials, after too many attempts that were not delivered", all.abandoned)});
  findings.groups = {{"participant", "ratio", "ascending", "descending", "descending minus ascending"}};
  for (const AdjustedPerson& each : all.people) {
    findings.groups.push_back({each.participant, ratio_in_words(each.means.middle, all.unit_rms_m),
                               series_in_words(each.means.ascending), series_in_words(each.means.descending),
                               hysteresis_in_words(each.means.hysteresis_db)});
    findings.pictures.push_back(picture_of(each));
  }
  findings.simulated = all.simulated;
  return findings;
}

}  // namespace tacto::analysis
