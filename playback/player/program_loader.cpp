// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/player/program_loader.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <new>
#include <utility>

namespace tacto::playback {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

Result<AnyProgram> made_within_memory(const ProgramLoader::Make& make) try {
  return make();
} catch (const std::bad_alloc&) {
  return fail(ErrorKind::unsuitable, "needs more memory than is available", "load", "play a shorter part");
}

// Lowers the thread's priority to about a third of the process's, so that a load still ends on a busy
// machine.
void step_back(pid_t thread) {
  constexpr int kNicer = 5;
  const int of_process = getpriority(PRIO_PROCESS, static_cast<id_t>(getpid()));
  setpriority(PRIO_PROCESS, static_cast<id_t>(thread), of_process + kNicer);
}

}  // namespace

ProgramLoader::~ProgramLoader() {
  if (works())
    thread_.detach();
  else
    forget();
}

void ProgramLoader::begin(Make make, Beside beside) {
  next_ = {std::move(make), beside};
  target_ = true;
  given_up_ = false;
  start_next();
}

void ProgramLoader::start_next() {
  if (!next_ || works()) return;
  forget();
  work_ = std::make_shared<Work>();
  thread_ = std::thread([work = work_, next = *std::exchange(next_, std::nullopt)] {
    const auto& [make, beside] = next;
    work->thread.store(gettid());
    if (beside == Beside::playing) step_back(gettid());
    work->result = made_within_memory(make);
    work->done.store(true);
  });
}

void ProgramLoader::forget() {
  if (thread_.joinable()) thread_.join();
  work_.reset();
}

bool ProgramLoader::busy() const {
  return next_ || works();
}

bool ProgramLoader::works() const {
  return work_ != nullptr && !work_->done.load();
}

void ProgramLoader::give_up() {
  given_up_ = target_;
  if (given_up_ && works() && work_->thread.load() != 0) step_back(work_->thread.load());
}

std::optional<Result<AnyProgram>> ProgramLoader::take() {
  start_next();
  if (!target_ || (busy() && !given_up_)) return std::nullopt;
  target_ = false;
  next_.reset();
  if (given_up_)
    return fail(ErrorKind::usage, "the load was cancelled by stop or disarm", "load", "load again");
  std::optional<Result<AnyProgram>> result = std::move(work_->result);
  forget();
  return result;
}

}  // namespace tacto::playback
