// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/cli/participant_screen.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <sstream>
#include <thread>
#include <utility>
#include <vector>

#include "data-schema/files/files.hpp"

namespace tacto::analysis {

using schema::ErrorKind;
using schema::Result;

namespace {

using ScreenClock = std::chrono::steady_clock;

void show(const std::string& text) {
  fmt::print(stderr, "\n{}\n", text);
}

// 0: it is none.
int interval_of(std::string_view answer, const schema::Protocol& protocol) {
  if (answer == protocol.first.word || answer == protocol.first.key) return 1;
  return answer == protocol.second.word || answer == protocol.second.key ? 2 : 0;
}

}  // namespace

ParticipantScreen::ParticipantScreen(const schema::Protocol& protocol,
                                     const std::function<bool()>& stop_asked)
    : protocol_(protocol), stop_asked_(stop_asked) {}

Result<void> ParticipantScreen::check_terminal() const {
  if (isatty(STDIN_FILENO) == 1) return {};
  return schema::fail(ErrorKind::usage, "stdin is no terminal, from which keys could be read", "experiment",
                      "run it in a terminal, or give --observer or --answers");
}

Participant ParticipantScreen::participant() {
  const auto go_ahead = [this](int /*interval*/) {
    if (!std::exchange(welcomed_, true)) show(protocol_.texts.welcome);
    show(protocol_.texts.begin);
    if (wait_for(protocol_.begin_key) == 0) return false;
    show(protocol_.texts.interval);
    return true;
  };
  const auto answer = [this](std::size_t /*number*/) -> Result<std::optional<GivenAnswer>> {
    show(protocol_.texts.question);
    const ScreenClock::time_point asked = ScreenClock::now();
    const char key = wait_for(protocol_.first.key + protocol_.second.key);
    if (key == 0) return std::nullopt;
    const std::chrono::duration<double> after = ScreenClock::now() - asked;
    return GivenAnswer{key == protocol_.first.key.front() ? 1 : 2, after.count()};
  };
  return {go_ahead, answer};
}

void ParticipantScreen::show_end() const {
  show(protocol_.texts.end);
}

// The next of these keys that is pressed from now on; 0: the run ends.
char ParticipantScreen::wait_for(std::string_view keys) {
  while (keys_.next() != 0) {
  }
  while (!stop_asked_()) {
    const char key = keys_.next();
    if (key != 0 && keys.find(key) != std::string_view::npos) return key;
    if (key == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return 0;
}

Result<Participant> answers_from(const std::string& file, const schema::Protocol& protocol) {
  const auto text = schema::read_file(file);
  TACTO_TRY(text);
  std::vector<int> answers;
  std::istringstream lines(*text);
  for (std::string line; std::getline(lines, line);) {
    if (line.ends_with('\r')) line.pop_back();
    answers.push_back(interval_of(line, protocol));
    if (answers.back() == 0)
      return schema::fail(ErrorKind::malformed, fmt::format("'{}' is not an answer", line),
                          fmt::format("{}: line {}", file, answers.size()),
                          fmt::format("give {} or {}", protocol.first.word, protocol.second.word));
  }
  const auto answer = [answers](std::size_t number) -> Result<std::optional<GivenAnswer>> {
    if (number >= answers.size()) return std::nullopt;
    return GivenAnswer{answers[number], 0};
  };
  return Participant{[](int) { return true; }, answer};
}

}  // namespace tacto::analysis
