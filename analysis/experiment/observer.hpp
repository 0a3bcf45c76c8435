// SPDX-License-Identifier: GPL-3.0-or-later
// A simulated participant.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "data-schema/base/error.hpp"
#include "data-schema/experiment/protocol.hpp"

namespace tacto::analysis {

/// Gets what the sessions predict; it does not know which stimuli they are. Each random number depends on
/// seed, participant and attempt only, so a resumed run gets the same.
///
/// Of two intervals: compares their periods, see smaller_period(). Of an identification: see
/// TemplateObserver. Of amplitude: see rated(). Of ordering: the order of perceived_level_db(). Of
/// adjustment: see criterion_of().
struct Observer {
  schema::Task task = schema::Task::two_interval;  ///< in which it can answer
  double weber = 0;                ///< just noticeable difference re the standard's period, or its amplitude
  double match = 0;                ///< of amplitude: the ratio that seems equal
  double threshold = 0;            ///< of adjustment: the ratio that it looks for
  double sd = 0, hysteresis = 0;   ///< of adjustment, see criterion_of()
  double lapse = 0;                ///< share of answers by chance
  double hurry = 0;                ///< share of attempts with a finger of twice the fastest accepted speed
  std::optional<double> noise_db;  ///< of identifying; none: tuned, see TemplateObserver. Of ordering
  std::string seed = "1";
  std::string text;  ///< as it was given
};

/// "weber=25.3%,lapse=2%,hurry=5%,seed=1", for amplitude with match=86%;
/// "template,noise=12dB,hurry=5%,seed=1"; "order,noise=1dB,hurry=5%,seed=1"; or
/// "threshold=20%,sd=10%,hysteresis=5%,seed=1". Template, order, threshold or weber is required. Errors:
/// usage.
schema::Result<Observer> parse_observer(std::string_view text);

/// Which interval (1 or 2) has the smaller period. The noise of the difference is normal; it answers `larger`
/// in 75 % of the trials where that differs from the standard by the Weber fraction. `place` names the
/// attempt, as P01/17. Without a period the answer is chance.
int smaller_period(const Observer& observer, const std::string& place,
                   const std::array<std::optional<double>, 2>& period_m, double standard_m);

/// The rating, from -3 to 3, of a displacement that is `ratio` times that of the real sample: the whole
/// number next to 3 (ratio - match + normal error); the just noticeable difference is 0.674 standard
/// deviations of the error. A lapse is each rating alike.
int rated(const Observer& observer, const std::string& place, double ratio);

/// A level, dB re 1 um RMS, with a normal error of deviation noise_db (default 1 dB).
double perceived_level_db(const Observer& observer, const std::string& place, double rms_m);

/// The ratio at which it accepts in this attempt: threshold times exp(sd x a standard normal number), in
/// descending series times sqrt(1 + hysteresis), in ascending ones divided by it.
double criterion_of(const Observer& observer, const std::string& place, bool ascending);

/// Random numbers of the observer at a place: above 0 and below 1; standard normal.
double uniform_of(const Observer& observer, const std::string& place, const char* what);
double normal_of(const Observer& observer, const std::string& place);

/// Whether its finger hurries in this attempt.
bool hurries(const Observer& observer, const std::string& place);

}  // namespace tacto::analysis
