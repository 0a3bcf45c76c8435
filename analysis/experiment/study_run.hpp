// SPDX-License-Identifier: GPL-3.0-or-later
// One participant's run on a device, from the first trial or from where it was interrupted.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/experiment/interval_guide.hpp"
#include "analysis/experiment/observer.hpp"
#include "analysis/experiment/proof.hpp"

namespace tacto::analysis {

/// An answer: its number among the protocol's choices, from 1, and the time from the question. Of ordering
/// the numbers of all choices, from least to most.
struct GivenAnswer {
  int choice = 0;
  double answer_s = 0;
  std::vector<int> order = {};
};

/// The person, or a file in its place.
struct Participant {
  /// Has the operator place the real sample `label` and type its label; false: the run ends. `number` is that
  /// of the sample in the run, from 0. Errors: malformed, if another label is in a file.
  std::function<schema::Result<bool>(const std::string& label, std::size_t number)> place;
  /// Waits for the go-ahead to an interval (1 or 2); false: the run ends.
  std::function<bool(int interval)> go_ahead;
  /// Asks the question; none: the run ends. `number` is that of the answer in the run, from 0.
  std::function<schema::Result<std::optional<GivenAnswer>>(std::size_t number)> answer;
  /// Of ordering: which texture is explored next, by its number among the choices; 0: the question may come,
  /// which is possible if `left`, the textures that have yet to be explored, is empty. None: the run ends.
  std::function<std::optional<int>(const std::vector<int>& left)> explore;
  /// Of adjustment, of a person: the next key; waits for it on request. None: no key, or the run ends.
  std::function<std::optional<schema::Turn>(bool wait)> turn;
  /// Of adjustment, of a person: says that a setting was accepted before the strokes of the pace.
  std::function<void()> too_early;
  /// Of adjustment, of a file: the ratio that is to be set. None: the run ends.
  std::function<std::optional<double>(std::size_t number)> wanted;
  /// Of a person: a break, until a key is pressed; false: the run ends.
  std::function<bool()> rest;
  /// Of a person: says that a practice trial comes.
  std::function<void()> practise = {};
  /// Of a person: shows how the finger is to move, at each message of ticks.
  IntervalGuide::Show guide = {};
};

struct RunRequest {
  std::string device_uri;
  std::optional<Observer> observer;  ///< answers in place of the participant
  Participant participant;
  std::string language = {};                    ///< of the screen; empty: none
  std::optional<double> masking_level_db = {};  ///< as the operator measured it
  std::function<bool()> stop_asked;
  std::function<void(double)> tell;  ///< the part of the trials that are done
};

/// Begins a run and returns it as it ended. The order of its blocks is the row that the fewest complete
/// runs of the study have, the first of these rows. Errors: those of read_study and of check_on_device;
/// usage: no code of a participant, one that has begun, a level of the masking noise that is not the
/// protocol's; those of playback: the run can be resumed.
schema::Result<Run> begin_run(const std::string& study, const std::string& participant,
                              const RunRequest& request);

/// Continues: an attempt without an answer is over, its trial comes again. Without a device in the request it
/// is that of the journal; its observer is always that of the journal. Errors: those of read_run; usage: the
/// run is complete; as above.
schema::Result<Run> resume_run(const std::string& run, RunRequest request);

}  // namespace tacto::analysis
