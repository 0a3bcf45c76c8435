// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/files/process_mark.hpp"

#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "data-schema/files/files.hpp"

namespace tacto::schema {
namespace {

constexpr std::size_t kMarkDigits = 8;
constexpr std::string_view kNoMark = "00000000";

// Reads a file of /proc or /etc, which are short; empty if there is none.
std::string small_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The name space of process numbers; containers have their own. Empty without /proc.
std::string process_number_space() {
  std::error_code unknown;
  return std::filesystem::read_symlink("/proc/self/ns/pid", unknown).string();
}

std::string machine_digits() {
  const std::string space = process_number_space();
  utsname names{};
  if (space.empty() || uname(&names) != 0) return std::string(kNoMark);
  const std::string all = std::string(names.nodename) + '\n' + small_file("/etc/machine-id") + '\n' + space;
  return sha256_of(all).substr(0, kMarkDigits);
}

std::string boot_digits() {
  const std::string id = small_file("/proc/sys/kernel/random/boot_id");
  return id.size() < kMarkDigits ? std::string(kNoMark) : id.substr(0, kMarkDigits);
}

struct ProcessState {
  char letter = 0;
  unsigned long long start = 0;
};

// proc(5): after the name in brackets, which may hold anything, the state is the 1st field and the start
// time the 20th.
std::optional<ProcessState> state_of(pid_t pid) {
  constexpr int kFieldsBetween = 19;
  const std::string line = small_file(fmt::format("/proc/{}/stat", pid));
  const auto bracket = line.rfind(')');
  if (bracket == std::string::npos || bracket + 2 >= line.size()) return std::nullopt;
  std::size_t at = bracket + 2;
  ProcessState state{line[at], 0};
  for (int field = 0; field < kFieldsBetween && at != std::string::npos; ++field) at = line.find(' ', at + 1);
  if (at == std::string::npos) return std::nullopt;
  std::from_chars(line.data() + at + 1, line.data() + line.size(), state.start);
  return state;
}

std::time_t boot_time() {
  timespec since_boot{};
  clock_gettime(CLOCK_BOOTTIME, &since_boot);
  return std::time(nullptr) - since_boot.tv_sec;
}

bool is_mark(std::string_view digits) {
  return digits.size() == kMarkDigits &&
         digits.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

// The next part up to a hyphen; `text` keeps what follows.
std::string_view take_part(std::string_view& text) {
  const std::string_view part = text.substr(0, text.find('-'));
  text.remove_prefix(std::min(text.size(), part.size() + 1));
  return part;
}

template <class Number>
bool read_whole(std::string_view text, Number& number) {
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stop == end && !text.empty();
}

Liveness liveness_here(const ProcessMark& mark) {
  if (kill(mark.pid, 0) != 0 && errno == ESRCH) return Liveness::ended;
  const auto state = state_of(mark.pid);
  if (!state) return Liveness::unknown;  // processes of other users may be hidden
  const bool gone = state->letter == 'Z' || state->letter == 'X' || state->start != mark.start;
  return gone ? Liveness::ended : Liveness::runs;
}

}  // namespace

const ProcessMark& own_mark() {
  thread_local ProcessMark mark;
  if (mark.pid == getpid()) return mark;  // a child has another number after fork()
  mark = {machine_digits(), boot_digits(), getpid(), 0};
  if (const auto state = state_of(mark.pid)) mark.start = state->start;
  return mark;
}

std::string text_of(const ProcessMark& mark) {
  return fmt::format("{}-{}-{}-{}", mark.machine, mark.boot, mark.pid, mark.start);
}

std::optional<ProcessMark> parse_mark(std::string_view text) {
  ProcessMark mark;
  mark.machine = take_part(text);
  mark.boot = take_part(text);
  const bool numbers = read_whole(take_part(text), mark.pid) && read_whole(text, mark.start);
  if (!numbers || mark.pid <= 0 || !is_mark(mark.machine) || !is_mark(mark.boot)) return std::nullopt;
  return mark;
}

Liveness liveness_of(const ProcessMark& mark, std::time_t last_change) {
  const ProcessMark& own = own_mark();
  if (mark.machine != own.machine || own.machine == kNoMark || own.boot == kNoMark) return Liveness::unknown;
  if (mark.boot == own.boot) return liveness_here(mark);
  return last_change < boot_time() ? Liveness::ended : Liveness::unknown;
}

}  // namespace tacto::schema
