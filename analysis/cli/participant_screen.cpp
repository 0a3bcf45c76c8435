// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/cli/participant_screen.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
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

ParticipantScreen::ParticipantScreen(const schema::Protocol& protocol, schema::ProtocolTexts texts,
                                     const std::function<bool()>& stop_asked)
    : protocol_(protocol), texts_(std::move(texts)), stop_asked_(stop_asked) {}

Result<void> ParticipantScreen::check_terminal() const {
  if (isatty(STDIN_FILENO) == 1) return {};
  return schema::fail(ErrorKind::usage, "stdin is no terminal, from which keys could be read", "experiment",
                      "run it in a terminal, or give --observer or --answers");
}

Participant ParticipantScreen::participant() {
  const auto go_ahead = [this](int interval) {
    welcome();
    show(texts_.begin);
    if (wait_for(protocol_.begin_key) == 0) return false;
    guided_.clear();
    show(adjusts(interval) ? texts_.question : texts_.interval);
    return true;
  };
  const auto answer = [this](std::size_t /*number*/) -> Result<std::optional<GivenAnswer>> {
    show(texts_.question);
    const ScreenClock::time_point asked = ScreenClock::now();
    if (protocol_.task == schema::Task::ordering) {
      auto order = wait_for_order();
      if (order.empty()) return std::nullopt;
      const std::chrono::duration<double> after = ScreenClock::now() - asked;
      return GivenAnswer{0, after.count(), std::move(order)};
    }
    const std::string keys = choice_keys();
    const char key = wait_for(keys);
    if (key == 0) return std::nullopt;
    const std::chrono::duration<double> after = ScreenClock::now() - asked;
    return GivenAnswer{static_cast<int>(keys.find(key)) + 1, after.count()};
  };
  const auto place = [this](const std::string& label, std::size_t /*number*/) {
    return wait_for_label(label);
  };
  const auto explore = [this](const std::vector<int>& left) { return wait_for_texture(left); };
  const auto turn = [this](bool wait) { return next_turn(wait); };
  const auto too_early = [this] { show(texts_.too_early); };
  const auto rest = [this] {
    show(texts_.rest);
    return wait_for({}) != 0;
  };
  const auto guide_interval = [this](const Guidance& now) { guide(now); };
  const auto practise = [this] {
    welcome();
    show(texts_.practice);
  };
  return {place, go_ahead, answer, explore, turn, too_early, {}, rest, practise, guide_interval};
}

// One line, which is written again where it changes: the mark along its bar, the time to the beginning, and
// the words about the force.
void ParticipantScreen::guide(const Guidance& now) {
  constexpr int kBarColumns = 41;
  const std::string* const words[] = {&texts_.force_below, &texts_.force_within, &texts_.force_above};
  std::string line;
  if (now.cued_part) {
    line = fmt::format("|{:{}}|", "", kBarColumns);
    line[1 + static_cast<std::size_t>(std::lround(*now.cued_part * (kBarColumns - 1)))] = 'O';
    line += now.begins_in_s > 0 ? fmt::format(" {:3.1f} s ", now.begins_in_s) : std::string(7, ' ');
  }
  if (now.pressed) line += *words[static_cast<int>(*now.pressed)];
  if (std::exchange(guided_, line) != line) fmt::print(stderr, "\r{}\x1b[K", line);
}

void ParticipantScreen::welcome() {
  if (!std::exchange(welcomed_, true)) show(texts_.welcome);
}

bool ParticipantScreen::adjusts(int interval) const {
  return protocol_.task == schema::Task::adjustment &&
         interval == (protocol_.goal == schema::Goal::match ? 2 : 1);
}

// The number of a texture, or 0 for the order, once each was explored; none: the run ends.
std::optional<int> ParticipantScreen::wait_for_texture(const std::vector<int>& left) {
  welcome();
  show(texts_.begin);
  std::string keys = choice_keys();
  if (left.empty()) keys += protocol_.begin_key;
  std::vector<std::string> to_feel;
  for (const int number : left)
    to_feel.push_back(protocol_.choices[static_cast<std::size_t>(number) - 1].word);
  if (!left.empty()) show(fmt::format("{}: {}", texts_.left, fmt::join(to_feel, " ")));
  const char key = wait_for(keys);
  if (key == 0) return std::nullopt;
  const auto number = keys.find(key) + 1;
  if (number > protocol_.choices.size()) return 0;
  guided_.clear();
  show(texts_.interval);
  return static_cast<int>(number);
}

// The numbers of all textures, as they are typed; empty: the run ends.
std::vector<int> ParticipantScreen::wait_for_order() {
  drain_keys();
  const std::string keys = choice_keys();
  std::string typed;
  while (!stop_asked_()) {
    const char key = keys_.next();
    if (key == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    if (key == '\b' || key == '\x7f') take_typed(key, typed);
    if (keys.find(key) != std::string::npos && typed.find(key) == std::string::npos) take_typed(key, typed);
    if (typed.size() < keys.size() || key != protocol_.begin_key.front()) continue;
    std::vector<int> order;
    for (const char each : typed) order.push_back(static_cast<int>(keys.find(each)) + 1);
    return order;
  }
  return {};
}

// The arrows up and down are keys, too.
std::optional<schema::Turn> ParticipantScreen::next_turn(bool wait) {
  while (!stop_asked_()) {
    char key = keys_.next();
    if (key == '\x1b' && keys_.next() == '[') {
      const char arrow = keys_.next();
      if (arrow == 'A') return schema::Turn::stronger;
      if (arrow == 'B') return schema::Turn::weaker;
    }
    const auto number = choice_keys().find(key);
    if (key != 0 && number != std::string::npos) return static_cast<schema::Turn>(number + 1);
    if (key == 0 && !wait) return std::nullopt;
    if (key == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return std::nullopt;
}

std::string ParticipantScreen::choice_keys() const {
  std::string keys;
  for (const schema::AnswerWord& choice : protocol_.choices) keys += choice.key;
  return keys;
}

void ParticipantScreen::show_end() const {
  show(texts_.end);
}

// Keys that were pressed before the prompt are no answer to it.
void ParticipantScreen::drain_keys() {
  while (keys_.next() != 0) {
  }
}

// The next of these keys (none: of all) that is pressed from now on; 0: the run ends.
char ParticipantScreen::wait_for(std::string_view keys) {
  drain_keys();
  while (!stop_asked_()) {
    const char key = keys_.next();
    if (key != 0 && (keys.empty() || keys.find(key) != std::string_view::npos)) return key;
    if (key == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return 0;
}

// Until the operator types this label and Enter; false: the run ends.
Result<bool> ParticipantScreen::wait_for_label(const std::string& label) {
  drain_keys();
  show(fmt::format("{} {}", texts_.place, label));
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

namespace {

tl::unexpected<schema::Error> no_answer(const std::string& line, const std::string& where,
                                        const std::string& remedy) {
  return schema::fail(ErrorKind::malformed, fmt::format("'{}' is not an answer", line), where, remedy);
}

std::string words_of(const schema::Protocol& protocol) {
  std::vector<std::string> words;
  for (const schema::AnswerWord& each : protocol.choices) words.push_back(each.word);
  return fmt::format("{}", fmt::join(words, ", "));
}

Result<GivenAnswer> read_order(const std::string& line, const std::string& where,
                               const schema::Protocol& protocol) {
  GivenAnswer answer;
  std::istringstream words(line);
  for (std::string word; words >> word;) answer.order.push_back(choice_number(word, protocol));
  std::vector<int> sorted = answer.order;
  std::ranges::sort(sorted);
  for (std::size_t i = 0; i < protocol.choices.size(); ++i)
    if (sorted.size() != protocol.choices.size() || sorted[i] != static_cast<int>(i) + 1)
      return no_answer(line, where,
                       fmt::format("give each of {} once, from least to most", words_of(protocol)));
  return answer;
}

Result<double> read_ratio(const std::string& line, const std::string& where,
                          const schema::Protocol& protocol) {
  double ratio = 0;
  const auto [end, failed] = std::from_chars(line.data(), line.data() + line.size(), ratio);
  const bool whole = failed == std::errc() && end == line.data() + line.size();
  if (whole && protocol.smallest_ratio <= ratio && ratio <= protocol.largest_ratio) return ratio;
  return no_answer(line, where,
                   fmt::format("give the ratio that is set, {:g} to {:g}", protocol.smallest_ratio,
                               protocol.largest_ratio));
}

// In the order of the file.
struct Answers {
  std::vector<GivenAnswer> given;
  std::vector<double> ratios;
  std::vector<std::pair<std::string, std::string>> labels;  // with their places
};

Result<void> take_line(const std::string& line, const std::string& where, const schema::Protocol& protocol,
                       Answers& answers) {
  if (protocol.task == schema::Task::adjustment) {
    const auto ratio = read_ratio(line, where, protocol);
    TACTO_TRY(ratio);
    answers.ratios.push_back(*ratio);
  } else if (protocol.task == schema::Task::ordering) {
    auto order = read_order(line, where, protocol);
    TACTO_TRY(order);
    answers.given.push_back(std::move(*order));
  } else if (const int choice = choice_number(line, protocol); choice != 0) {
    answers.given.push_back({choice, 0});
  } else if (schema::is_label(line)) {
    answers.labels.emplace_back(line, where);
  } else {
    return no_answer(line, where, fmt::format("give one of {}", words_of(protocol)));
  }
  return {};
}

}  // namespace

Result<Participant> answers_from(const std::string& file, const schema::Protocol& protocol) {
  const auto text = schema::read_file(file);
  TACTO_TRY(text);
  Answers answers;
  std::istringstream lines(*text);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.ends_with('\r')) line.pop_back();
    TACTO_TRY(take_line(line, fmt::format("{}: line {}", file, ++number), protocol, answers));
  }
  const auto place = [labels = answers.labels](const std::string& label, std::size_t at) -> Result<bool> {
    if (at >= labels.size()) return false;
    if (labels[at].first != label) return wrong_label(labels[at].first, label, labels[at].second);
    return true;
  };
  const auto answer = [given = answers.given](std::size_t at) -> Result<std::optional<GivenAnswer>> {
    if (at >= given.size()) return std::nullopt;
    return given[at];
  };
  const auto explore = [](const std::vector<int>& left) {
    return std::optional(left.empty() ? 0 : left.front());
  };
  const auto wanted = [ratios = answers.ratios](std::size_t at) {
    return at < ratios.size() ? std::optional(ratios[at]) : std::nullopt;
  };
  return Participant{place, [](int) { return true; }, answer, explore, {}, {}, wanted, {}, {}, {}};
}

}  // namespace tacto::analysis
