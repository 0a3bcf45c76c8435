// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/cli/command_lines.hpp"

#include <poll.h>
#include <unistd.h>

#include <tuple>
#include <utility>

#include "capture/table/text_encoding.hpp"
#include "data-schema/report/report_text.hpp"

namespace tacto::capture {
namespace {

constexpr std::size_t kLongestLine = 1000;  // a pipe takes lines of up to 4096 bytes whole

bool ready(int file, short events) {
  pollfd waiting{file, events, 0};
  return poll(&waiting, 1, 0) == 1;
}

void print(const cli::Report& event) {
  const std::string line = cli::json_line(event);
  if (ready(STDOUT_FILENO, POLLOUT)) std::ignore = ::write(STDOUT_FILENO, line.data(), line.size());
}

void refuse(const char* why) {
  print(cli::Report().add("event", "error").add("what", why).add("remedy", "write 'mark LABEL' or 'stop'"));
}

}  // namespace

void CommandLines::obey(const std::string& line) {
  if (line == "stop") {
    stopped_ = true;
  } else if (!line.starts_with("mark ") || line.size() == 5) {
    refuse("this line is no command");
  } else if (!is_utf8(line)) {
    refuse("the label is not UTF-8");
  } else {
    labels_.push_back(line.substr(5));
  }
}

bool CommandLines::stopped() {
  if (!std::exchange(begun_, true)) {  // also a program that stops at once gets a recording, of one block
    print(cli::Report().add("event", "recording"));
    return false;
  }
  char bytes[4096];
  while (!stopped_ && ready(STDIN_FILENO, POLLIN)) {
    const auto got = ::read(STDIN_FILENO, bytes, sizeof bytes);
    if (got <= 0) return stopped_ = true;
    input_.append(bytes, static_cast<std::size_t>(got));
    for (auto end = input_.find('\n'); end != input_.npos && !stopped_; end = input_.find('\n')) {
      const std::string line = input_.substr(0, end);
      input_.erase(0, end + 1);
      if (std::exchange(too_long_, false)) continue;
      obey(line.ends_with('\r') ? line.substr(0, line.size() - 1) : line);
    }
    if (input_.size() <= kLongestLine) continue;
    if (!std::exchange(too_long_, true)) refuse("this line is longer than 1000 bytes");
    input_.clear();
  }
  return stopped_;
}

std::vector<std::string> CommandLines::take_labels() {
  return std::exchange(labels_, {});
}

void CommandLines::answer(const schema::Mark& mark, double time_s) {
  print(cli::Report()
            .add("event", "mark")
            .add("frame", mark.frame)
            .add("time_s", time_s)
            .add("label", mark.label));
}

}  // namespace tacto::capture
