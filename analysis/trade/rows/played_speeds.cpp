// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/rows/played_speeds.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace tacto::analysis {
namespace {

// With less of the texture in the band, the displacement is mainly leakage from outside of the band.
constexpr double kLeastTargetShare = 0.05;

}  // namespace

schema::Result<PlayedSpeeds> PlayedSpeeds::of(const schema::Texture& texture,
                                              const schema::Transducer& transducer, PlayedCase played,
                                              std::span<const double> speeds_mps) {
  PlayedSpeeds all;
  for (const double speed_mps : speeds_mps) {
    played.way.speed_mps = speed_mps;
    auto outcome = play_case(texture, transducer, played);
    TACTO_TRY(outcome);
    all.speeds_mps_.push_back(speed_mps);
    all.outcomes_.push_back(std::move(*outcome));
  }
  return all;
}

std::vector<ErrorAtSpeed> PlayedSpeeds::errors(double PlayedOutcome::*kind) const {
  std::vector<ErrorAtSpeed> errors;
  for (std::size_t i = 0; i < outcomes_.size(); ++i) {
    const bool played = outcomes_[i].target_part >= kLeastTargetShare;
    errors.push_back({speeds_mps_[i], played ? outcomes_[i].*kind : kNotMeasured});
  }
  return errors;
}

double worst_of(std::span<const ErrorAtSpeed> errors) {
  double worst = kNotMeasured;
  for (const ErrorAtSpeed& each : errors) worst = std::fmax(worst, each.error);
  return worst;
}

std::string speed_words(std::span<const ErrorAtSpeed> errors) {
  std::string words;
  for (const ErrorAtSpeed& each : errors)
    words += fmt::format("{}{:g}", words.empty() ? "" : ", ", 1e3 * each.speed_mps);
  return words + " mm/s";
}

}  // namespace tacto::analysis
