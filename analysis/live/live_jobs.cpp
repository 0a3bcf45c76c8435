// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/live/live_jobs.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <system_error>
#include <thread>

#include "data-schema/control/control.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/report/terminal.hpp"

namespace tacto::analysis {

using schema::ErrorKind;
using schema::fail;
using schema::LiveRequest;
using schema::LiveVerb;
using schema::Result;

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostJobs = 20;          // that are listed; the oldest ones that have ended leave
constexpr std::size_t kMostText = 256U << 10;  // bytes of what a job prints; more is not kept
constexpr std::size_t kMostPage = 64U << 20;   // bytes
constexpr double kEndsWithinS = 3;
constexpr const char* kEnding = ".html";

bool has_ended(std::string_view state) {
  return state != "waiting" && state != "running";
}

std::string id_of(const LiveRequest& request) {
  return request.id ? std::to_string(*request.id) : std::string();
}

// Both ends are closed in a program that is started; ours does not wait.
bool open_pipe(int (&ends)[2]) {
  return pipe2(ends, O_CLOEXEC) == 0 && fcntl(ends[0], F_SETFL, O_NONBLOCK) == 0;
}

// The signals act as usual in the new process, whatever this one does with them, and it has no descriptor but
// the three: else it would hold the server's port.
int spawn(pid_t& process, std::vector<std::string> words, int answer, int messages) {
  words.insert(words.begin(), "tactograph");
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&files);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&files, answer, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, messages, STDERR_FILENO);
  posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);
  sigset_t usual, none;
  sigfillset(&usual);
  sigemptyset(&none);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  const int failed = posix_spawn(&process, "/proc/self/exe", &files, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  return failed;
}

// A stem without the ending of its kind: "demo/C" of "demo/C.texture.json".
std::string stem_of_input(const std::string& file) {
  const bool texture = file.ends_with(".texture.json");
  return schema::stem_of(file, texture ? ".texture" : "");
}

}  // namespace

class LiveJobs::Page final : public WebConversation {
 public:
  explicit Page(LiveJobs& jobs) : jobs_(jobs) {}
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;
  ~Page() override { std::erase(jobs_.pages_, this); }

  std::string receive_text(std::string_view text) override {
    const auto request = schema::parse_live_request(text);
    const auto done = request ? obey(*request) : schema::forward_error(request);
    const std::string id = request ? id_of(*request) : std::string();
    return done ? schema::control_reply_line(id, *done) : schema::control_error_line(id, done.error());
  }
  std::string receive_bytes(std::span<const std::uint8_t>) override {
    return schema::control_error_line("", {ErrorKind::malformed, "a request is a text", "request", ""});
  }

 private:
  Result<schema::ControlFields> obey(const LiveRequest& request) {
    if (request.verb == LiveVerb::run) {
      const auto number = jobs_.add(request);
      TACTO_TRY(number);
      return schema::ControlFields{{"job", static_cast<std::int64_t>(*number)}};
    }
    if (request.verb == LiveVerb::cancel) {
      TACTO_TRY(jobs_.cancel(request.job));
      return schema::ControlFields{};
    }
    if (request.verb == LiveVerb::save) {
      const auto saved = jobs_.folder_.save(*request.texture);
      TACTO_TRY(saved);
      return schema::ControlFields{{"saved", *saved}};
    }
    return fail(ErrorKind::usage, "this connection is for jobs and saved textures", "request",
                "use another page");
  }
  LiveJobs& jobs_;
};

LiveJobs::~LiveJobs() {
  for (Job& job : jobs_) {
    if (job.state != "running") continue;
    kill(job.process, SIGTERM);
    const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(kEndsWithinS);
    int status = 0;
    while (waitpid(job.process, &status, WNOHANG) == 0) {
      if (std::chrono::steady_clock::now() > until) kill(job.process, SIGKILL);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    close(job.answer);
    close(job.messages);
  }
}

std::unique_ptr<WebConversation> LiveJobs::converse() {
  auto page = std::make_unique<Page>(*this);
  pages_.push_back(page.get());
  page->to_say.push_back(event());
  return page;
}

Result<std::size_t> LiveJobs::add(const LiveRequest& request) {
  const std::size_t needed = request.job_verb == "report" ? 0 : request.job_verb == "compare" ? 2 : 1;
  if (request.files.size() != needed)
    return fail(ErrorKind::usage, fmt::format("{} needs {} files", request.job_verb, needed),
                "request#/files", "choose as many");
  if (std::ranges::count_if(jobs_, [](const Job& job) { return !has_ended(job.state); }) >=
      static_cast<std::ptrdiff_t>(kMostJobs))
    return fail(ErrorKind::unsuitable, fmt::format("{} jobs wait already", kMostJobs), "jobs",
                "wait, or cancel some");
  Job job;
  job.words = {request.job_verb, "--progress"};
  std::string name;
  for (const std::size_t index : request.files) {
    const auto file = folder_.named_file(index);
    TACTO_TRY(file);
    job.words.push_back(*file);
    name += (name.empty() ? "" : "-") + fs::path(stem_of_input(*file)).filename().string();
  }
  if (needed == 0) job.words.push_back(folder_.folder());
  const auto is_free = [this](const std::string& stem) {
    std::error_code ignored;
    return !fs::exists(stem + kEnding, ignored) &&
           std::ranges::find(jobs_, stem + kEnding, &Job::output) == jobs_.end();
  };
  const auto stem = folder_.free_stem(name + (needed == 0 ? "" : "-") + request.job_verb, is_free);
  TACTO_TRY(stem);
  job.output = *stem + kEnding;
  job.words.insert(job.words.end(), {"-o", job.output});
  job.number = next_++;
  jobs_.push_back(std::move(job));
  if (const auto ended = std::ranges::find_if(jobs_, [](const Job& one) { return has_ended(one.state); });
      jobs_.size() > kMostJobs && ended != jobs_.end())
    jobs_.erase(ended);
  changed_ = true;
  return next_ - 1;
}

// A verb that is interrupted twice ends at once, so the second request is one more signal.
Result<void> LiveJobs::cancel(std::size_t number) {
  const auto job = std::ranges::find(jobs_, number, &Job::number);
  if (job == jobs_.end() || has_ended(job->state))
    return fail(ErrorKind::not_found, "this job has ended", std::to_string(number));
  job->cancelled = true;
  if (job->state == "running")
    kill(job->process, SIGINT);
  else
    job->state = "cancelled";
  changed_ = true;
  return {};
}

void LiveJobs::start(Job& job) {
  changed_ = true;
  int answer[2] = {-1, -1}, messages[2] = {-1, -1};
  const bool opened = open_pipe(answer) && open_pipe(messages);
  const int failed = opened ? spawn(job.process, job.words, answer[1], messages[1]) : errno;
  for (const int end : {answer[1], messages[1]})
    if (end >= 0) close(end);
  job.answer = answer[0];
  job.messages = messages[0];
  job.state = failed == 0 ? "running" : "failed";
  if (failed == 0) return;
  job.said = fmt::format("the program can't be started: {}\n", std::generic_category().message(failed));
  for (const int end : {job.answer, job.messages})
    if (end >= 0) close(end);
}

void LiveJobs::step() {
  const auto running = std::ranges::find(jobs_, "running", &Job::state);
  if (running != jobs_.end()) {
    int status = 0;
    const bool ended = waitpid(running->process, &status, WNOHANG) == running->process;
    read_output(*running);
    if (ended) end(*running, status);
  } else if (const auto next = std::ranges::find(jobs_, "waiting", &Job::state); next != jobs_.end()) {
    start(*next);
  }
  if (changed_) tell_all();
}

void LiveJobs::read_output(Job& job) {
  const bool said = take(job.messages, job.said), printed = take(job.answer, job.printed);
  changed_ = changed_ || said || printed;
}

// Reads what is there. True if there was something.
bool LiveJobs::take(int descriptor, std::string& text) {
  char part[4096];
  bool some = false;
  for (ssize_t size = 0; (size = read(descriptor, part, sizeof part)) > 0; some = true)
    text.append(part, std::min(static_cast<std::size_t>(size), kMostText - std::min(kMostText, text.size())));
  return some;
}

void LiveJobs::end(Job& job, int status) {
  read_output(job);
  close(job.answer);
  close(job.messages);
  // A verb that has written its page has done its work, also if its exit code says that files are broken.
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
  const bool done = WIFEXITED(status) && (code == 0 || schema::is_file(job.output));
  if (code != 0) job.said += fmt::format("exit code {}\n", code);
  job.state = done ? "done" : job.cancelled ? "cancelled" : "failed";
  if (WIFSIGNALED(status) && !job.cancelled)
    job.said += fmt::format("ended by signal {}\n", WTERMSIG(status));
  changed_ = true;
}

void LiveJobs::tell_all() {
  changed_ = false;
  const std::string text = event();
  for (Page* const page : pages_) {
    std::erase(page->to_say, told_);  // the page has not read the one before
    page->to_say.push_back(text);
  }
  told_ = text;
}

std::string LiveJobs::event() const {
  std::vector<cli::Report> rows;
  for (const Job& job : jobs_) {
    cli::Report& row = rows.emplace_back();
    std::string command = "tactograph";
    for (const std::string& word : job.words)
      if (word != "--progress") command += " " + cli::shell_word(word);
    row.add("number", job.number).add("state", job.state).add("command", std::move(command));
    row.add("said", job.said).add("printed", job.printed).add("cancelled", job.cancelled);
    if (has_ended(job.state) && schema::is_file(job.output)) row.add("page", job.output);
  }
  return cli::Report().add("event", "jobs").add("jobs", std::move(rows)).json();
}

Result<std::string> LiveJobs::page(std::size_t number) const {
  const auto job = std::ranges::find(jobs_, number, &Job::number);
  std::error_code failed;
  if (job == jobs_.end() || !has_ended(job->state) || fs::file_size(job->output, failed) > kMostPage)
    return fail(ErrorKind::not_found, "this job has no page", std::to_string(number), "open its file");
  return schema::read_file(job->output);
}

}  // namespace tacto::analysis
