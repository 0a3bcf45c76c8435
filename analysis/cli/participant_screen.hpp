// SPDX-License-Identifier: GPL-3.0-or-later
// What the participant of an experiment sees and presses; or a file of answers.
#pragma once

#include <functional>
#include <string>

#include "analysis/experiment/study_run.hpp"
#include "data-schema/command/terminal_keys.hpp"

namespace tacto::analysis {

/// Shows the protocol's texts in one language and its pacing cue on stderr, and reads its keys from the
/// terminal, each without Enter. Neither a stimulus nor a score is shown. Both references must outlive this.
class ParticipantScreen {
 public:
  ParticipantScreen(const schema::Protocol& protocol, schema::ProtocolTexts texts,
                    const std::function<bool()>& stop_asked);

  /// Errors: usage, if stdin is no terminal.
  schema::Result<void> check_terminal() const;
  Participant participant();
  void show_end() const;

 private:
  void guide(const Guidance& now);
  void drain_keys();
  char wait_for(std::string_view keys);
  schema::Result<bool> wait_for_label(const std::string& label);
  void welcome();
  bool adjusts(int interval) const;
  std::optional<int> wait_for_texture(const std::vector<int>& left);
  std::vector<int> wait_for_order();
  std::optional<schema::Turn> next_turn(bool wait);
  std::string choice_keys() const;

  const schema::Protocol& protocol_;
  const schema::ProtocolTexts texts_;
  const std::function<bool()>& stop_asked_;
  cli::TerminalKeys keys_;
  bool welcomed_ = false;
  std::string guided_;  // the line of guide() that is shown
};

/// The answers of a file, one on each line: a word or a key of the protocol; of ordering all of them, from
/// least to most; of adjustment the ratio that is set. The operator's labels of real samples (K3) are lines
/// between them; answers and labels are counted separately. After the last one the run ends. Errors:
/// not_found; malformed, with the line.
schema::Result<Participant> answers_from(const std::string& file, const schema::Protocol& protocol);

}  // namespace tacto::analysis
