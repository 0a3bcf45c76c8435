// SPDX-License-Identifier: GPL-3.0-or-later
// A simulated participant.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// Compares the periods that both sessions predict; it does not know which stimuli they are. The noise of the
/// difference is normal; it answers `larger` in 75 % of the trials where that differs from the standard by
/// the Weber fraction. Each random number depends on seed, participant and attempt only, so a resumed run
/// gets the same.
///
/// Of an identification: see TemplateObserver.
struct Observer {
  bool identifies = false;
  double weber = 0;                ///< just noticeable difference re the standard's period
  double lapse = 0;                ///< share of answers by chance
  double hurry = 0;                ///< share of trials with a finger of twice the speed
  std::optional<double> noise_db;  ///< of identifying; none: tuned, see TemplateObserver
  std::string seed = "1";
  std::string text;  ///< as it was given
};

/// "weber=25.3%,lapse=2%,hurry=5%,seed=1"; or "template,noise=12dB,hurry=5%,seed=1". Its first word, or
/// weber, is required. Errors: usage.
schema::Result<Observer> parse_observer(std::string_view text);

/// Which interval (1 or 2) has the smaller period. `place` names the attempt, as P01/17. Without a period the
/// answer is chance.
int smaller_period(const Observer& observer, const std::string& place,
                   const std::array<std::optional<double>, 2>& period_m, double standard_m);

/// Random numbers of the observer at a place: above 0 and below 1; standard normal.
double uniform_of(const Observer& observer, const std::string& place, const char* what);
double normal_of(const Observer& observer, const std::string& place);

/// Whether its finger hurries in this attempt.
bool hurries(const Observer& observer, const std::string& place);

}  // namespace tacto::analysis
