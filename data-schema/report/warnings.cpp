// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/report/warnings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <map>
#include <mutex>

#include "data-schema/report/terminal.hpp"
#include "data-schema/report/text_table.hpp"

namespace tacto::cli {
namespace {

// Verbs warn from several threads.
struct Kept {
  std::mutex mutex;
  std::vector<std::string> warnings;
};

Kept& kept() {
  static Kept all;
  return all;
}

void keep(const std::string& text) {
  const std::lock_guard lock(kept().mutex);
  kept().warnings.push_back(text);
}

// On a terminal it wraps, with further lines indented. A file or pipe gets one line for each warning.
void print_wrapped(const std::string& text) {
  constexpr std::size_t kIndent = 4;
  winsize size{};
  const bool wraps =
      isatty(STDERR_FILENO) == 1 && ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 2 * kIndent;
  const auto lines = wrapped_text("tactograph: warning: " + on_one_line(text),
                                  wraps ? size.ws_col - kIndent : std::numeric_limits<std::size_t>::max());
  write_message(fmt::format("{}\n", fmt::join(lines, "\n" + std::string(kIndent, ' '))));
}

struct Group {
  const Warning* shown = nullptr;
  std::size_t count = 0;
  bool sized = false;  // their sizes differ: the worst is shown
};

std::string line_of(const Group& group) {
  if (group.count == 1) return sentence(*group.shown);
  return fmt::format("{} ({} of {} similar ones; --json lists all)", sentence(*group.shown),
                     group.sized ? "the worst" : "the first", group.count);
}

std::vector<Group> groups_of(std::span<const Warning> warnings) {
  std::vector<Group> groups;
  std::map<std::string, std::size_t> places;
  for (const Warning& warning : warnings) {
    const auto [place, is_new] = places.try_emplace(warning.kind, groups.size());
    if (is_new || warning.kind.empty()) {
      groups.push_back({&warning, 1, false});
      continue;
    }
    Group& group = groups[place->second];
    ++group.count;
    if (warning.size != group.shown->size) group.sized = true;
    if (warning.size > group.shown->size) group.shown = &warning;
  }
  return groups;
}

// Replaces numbers, with letters that may follow them in a name, by one character.
std::string without_numbers(const std::string& text) {
  std::string kind;
  for (const char c : text) {
    const bool digit = std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.';
    if (!digit || kind.empty() || kind.back() != '#') kind += digit ? '#' : c;
  }
  return kind;
}

// One line for each kind, in the order of first appearance: the worst, and the number of warnings.
std::vector<std::string> grouped(std::span<const Warning> warnings) {
  std::vector<std::string> lines;
  for (const Group& group : groups_of(warnings)) lines.push_back(line_of(group));
  return lines;
}

}  // namespace

std::string sentence(const Warning& warning) {
  return warning.about.empty() ? warning.text : warning.about + ": " + warning.text;
}

void warn_grouped(std::span<const Warning> warnings) {
  for (const Warning& warning : warnings) keep(sentence(warning));
  for (const std::string& line : grouped(warnings)) print_wrapped(line);
}

void warn_grouped(std::span<const std::string> sentences) {
  std::vector<Warning> warnings;
  for (const std::string& each : sentences) warnings.push_back({"", each, without_numbers(each)});
  warn_grouped(warnings);
}

std::vector<schema::Error> by_cause(std::span<const schema::Error> errors) {
  constexpr std::size_t kPlacesShown = 5;
  struct Cause {
    schema::Error first;
    std::vector<std::string> places;
  };
  std::vector<Cause> causes;
  std::map<std::string, std::size_t> known;
  for (const schema::Error& error : errors) {
    const auto [place, is_new] =
        known.try_emplace(without_numbers(error.what + "\n" + error.remedy), causes.size());
    if (is_new) causes.push_back({error, {}});
    causes[place->second].places.push_back(error.where);
  }
  std::vector<schema::Error> all;
  for (Cause& cause : causes) {
    const std::size_t count = cause.places.size(), shown = std::min(count, kPlacesShown);
    const std::string more = count > shown ? fmt::format(" and {} more", count - shown) : "";
    if (count > 1)
      cause.first.where =
          fmt::format("{} files ({}{})", count, fmt::join(std::span(cause.places).first(shown), ", "), more);
    all.push_back(std::move(cause.first));
  }
  return all;
}

std::vector<std::string> all_warnings() {
  const std::lock_guard lock(kept().mutex);
  return kept().warnings;
}

void print_warning(const std::string& text) {
  keep(text);
  print_wrapped(text);
}

}  // namespace tacto::cli
