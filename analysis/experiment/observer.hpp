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

/// Compares the periods that both sessions predict; it does not know which stimuli they are. The noise of the
/// difference is normal; it answers `larger` in 75 % of the trials where that differs from the standard by
/// the Weber fraction. Each random number depends on seed, participant and attempt only, so a resumed run
/// gets the same.
///
/// Of an identification: see TemplateObserver. Of amplitude: see rated().
struct Observer {
  bool identifies = false;
  double weber = 0;                ///< just noticeable difference re the standard's period, or its amplitude
  double match = 0;                ///< of amplitude: the ratio that seems equal; 0: no such observer
  double lapse = 0;                ///< share of answers by chance
  double hurry = 0;                ///< share of trials with a finger of twice the speed
  std::optional<double> noise_db;  ///< of identifying; none: tuned, see TemplateObserver
  std::string seed = "1";
  std::string text;  ///< as it was given

  schema::Task task() const {  ///< in which it can answer
    if (identifies) return schema::Task::identification;
    return match > 0 ? schema::Task::amplitude : schema::Task::two_interval;
  }
};

/// "weber=25.3%,lapse=2%,hurry=5%,seed=1", for amplitude with match=86%; or
/// "template,noise=12dB,hurry=5%,seed=1". Its first word, or weber, is required. Errors: usage.
schema::Result<Observer> parse_observer(std::string_view text);

/// Which interval (1 or 2) has the smaller period. `place` names the attempt, as P01/17. Without a period the
/// answer is chance.
int smaller_period(const Observer& observer, const std::string& place,
                   const std::array<std::optional<double>, 2>& period_m, double standard_m);

/// The rating, from -3 to 3, of a displacement that is `ratio` times that of the real sample: the whole
/// number next to 3 (ratio - match + normal error); the just noticeable difference is 0.674 standard
/// deviations of the error. A lapse is each rating alike.
int rated(const Observer& observer, const std::string& place, double ratio);

/// Random numbers of the observer at a place: above 0 and below 1; standard normal.
double uniform_of(const Observer& observer, const std::string& place, const char* what);
double normal_of(const Observer& observer, const std::string& place);

/// Whether its finger hurries in this attempt.
bool hurries(const Observer& observer, const std::string& place);

}  // namespace tacto::analysis
