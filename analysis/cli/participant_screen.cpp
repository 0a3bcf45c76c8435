// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/cli/participant_screen.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
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

// From 1; 0: it is none.
int choice_number(std::string_view answer, const schema::Protocol& protocol) {
  const auto found = std::ranges::find_if(protocol.choices, [&](const schema::AnswerWord& each) {
    return answer == each.word || answer == each.key;
  });
  return found == protocol.choices.end() ? 0 : static_cast<int>(found - protocol.choices.begin()) + 1;
}

tl::unexpected<schema::Error> wrong_label(const std::string& typed, const std::string& label,
                                          const std::string& where) {
  return schema::fail(ErrorKind::malformed, fmt::format("'{}' is not the sample {}", typed, label), where,
                      fmt::format("place sample {}", label));
}

std::string without_spaces(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

// A key of the label that is being typed, and its echo. Backspace removes the last character; other control
// characters are ignored.
void take_typed(char key, std::string& typed) {
  constexpr char kBackspace = '\b', kDelete = '\x7f';
  if (key == kBackspace || key == kDelete) {
    if (typed.empty()) return;
    typed.pop_back();
    fmt::print(stderr, "\b \b");
  } else if (static_cast<unsigned char>(key) >= ' ') {
    typed += key;
    fmt::print(stderr, "{}", key);
  }
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
    std::string keys;
    for (const schema::AnswerWord& choice : protocol_.choices) keys += choice.key;
    const char key = wait_for(keys);
    if (key == 0) return std::nullopt;
    const std::chrono::duration<double> after = ScreenClock::now() - asked;
    return GivenAnswer{static_cast<int>(keys.find(key)) + 1, after.count()};
  };
  const auto place = [this](const std::string& label, std::size_t /*number*/) {
    return wait_for_label(label);
  };
  return {place, go_ahead, answer};
}

void ParticipantScreen::show_end() const {
  show(protocol_.texts.end);
}

// Keys that were pressed before the prompt are no answer to it.
void ParticipantScreen::drain_keys() {
  while (keys_.next() != 0) {
  }
}

// The next of these keys that is pressed from now on; 0: the run ends.
char ParticipantScreen::wait_for(std::string_view keys) {
  drain_keys();
  while (!stop_asked_()) {
    const char key = keys_.next();
    if (key != 0 && keys.find(key) != std::string_view::npos) return key;
    if (key == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return 0;
}

// Until the operator types this label and Enter; false: the run ends.
Result<bool> ParticipantScreen::wait_for_label(const std::string& label) {
  drain_keys();
  show(fmt::format("{} {}", protocol_.texts.place, label));
  std::string typed;
  while (!stop_asked_()) {
    const char key = keys_.next();
    if (key == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    } else if (key != '\n' && key != '\r') {
      take_typed(key, typed);
    } else if (without_spaces(typed) == label) {
      return true;
    } else {
      show(schema::message(wrong_label(without_spaces(typed), label, "").value()));
      typed.clear();
    }
  }
  return false;
}

Result<Participant> answers_from(const std::string& file, const schema::Protocol& protocol) {
  const auto text = schema::read_file(file);
  TACTO_TRY(text);
  std::vector<int> answers;
  std::vector<std::pair<std::string, std::string>> labels;  // with their places
  std::istringstream lines(*text);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.ends_with('\r')) line.pop_back();
    const std::string where = fmt::format("{}: line {}", file, ++number);
    if (const int choice = choice_number(line, protocol); choice != 0) {
      answers.push_back(choice);
    } else if (schema::is_label(line)) {
      labels.emplace_back(line, where);
    } else {
      std::vector<std::string> words;
      for (const schema::AnswerWord& each : protocol.choices) words.push_back(each.word);
      return schema::fail(ErrorKind::malformed, fmt::format("'{}' is not an answer", line), where,
                          fmt::format("give one of {}", fmt::join(words, ", ")));
    }
  }
  const auto place = [labels](const std::string& label, std::size_t at) -> Result<bool> {
    if (at >= labels.size()) return false;
    if (labels[at].first != label) return wrong_label(labels[at].first, label, labels[at].second);
    return true;
  };
  const auto answer = [answers](std::size_t at) -> Result<std::optional<GivenAnswer>> {
    if (at >= answers.size()) return std::nullopt;
    return GivenAnswer{answers[at], 0};
  };
  return Participant{place, [](int) { return true; }, answer};
}

}  // namespace tacto::analysis
