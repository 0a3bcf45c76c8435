// SPDX-License-Identifier: GPL-3.0-or-later
// The commands by which another program steers a recording: lines on stdin, answers as lines of JSON on
// stdout.
#pragma once

#include <string>
#include <vector>

#include "data-schema/recording/recording.hpp"

namespace tacto::capture {

/// Commands: "mark LABEL", "stop". The end of the input is "stop", too, so that a recording ends with the
/// program that steers it. A line that is no command is answered by an event "error" and changes nothing.
/// Answers never wait for their reader: if the pipe is full, they are dropped. One thread.
class CommandLines {
 public:
  /// Reads what has come, without waiting. Returns true from the command "stop" on, but not at the first
  /// call.
  bool stopped();
  /// The labels of the marks since the last call.
  std::vector<std::string> take_labels();
  /// Answers a mark. `time_s`: since the first frame, lost frames included.
  static void answer(const schema::Mark& mark, double time_s);

 private:
  void obey(const std::string& line);
  std::string input_;
  std::vector<std::string> labels_;
  bool begun_ = false, stopped_ = false, too_long_ = false;  // the rest of a line is passed over
};

}  // namespace tacto::capture
