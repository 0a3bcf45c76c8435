// SPDX-License-Identifier: GPL-3.0-or-later
// One participant's run on a device, from the first trial or from where it was interrupted.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "analysis/experiment/observer.hpp"
#include "analysis/experiment/proof.hpp"

namespace tacto::analysis {

/// An answer: its number among the protocol's choices, from 1, and the time from the question.
struct GivenAnswer {
  int choice = 0;
  double answer_s = 0;
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
};

struct RunRequest {
  std::string device_uri;
  std::optional<Observer> observer;  ///< answers in place of the participant
  Participant participant;
  std::function<bool()> stop_asked;
  std::function<void(double)> tell;  ///< the part of the trials that are done
};

/// Begins a run and returns it as it ended. The order of its blocks is the row that the fewest complete
/// runs of the study have, the first of these rows. Errors: those of read_study and of check_on_device;
/// usage: no code of a participant, one that has begun; those of playback: the run can be resumed.
schema::Result<Run> begin_run(const std::string& study, const std::string& participant,
                              const RunRequest& request);

/// Continues: an attempt without an answer is over, its trial comes again. Without a device in the request it
/// is that of the journal; its observer is always that of the journal. Errors: those of read_run; usage: the
/// run is complete; as above.
schema::Result<Run> resume_run(const std::string& run, RunRequest request);

}  // namespace tacto::analysis
