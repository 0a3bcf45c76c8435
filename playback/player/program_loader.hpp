// SPDX-License-Identifier: GPL-3.0-or-later
// Makes a program beside whoever plays.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include "playback/player/program.hpp"

namespace tacto::playback {

/// One program at a time, on a thread of its own that nobody has to wait for: a long texture takes seconds,
/// and can't be interrupted. What is begun after one that was given up follows once that one's thread is
/// done, so that memory holds one at a time. One thread calls.
class ProgramLoader {
 public:
  using Make = std::function<schema::Result<Program>()>;

  ProgramLoader() = default;
  ProgramLoader(const ProgramLoader&) = delete;
  ProgramLoader& operator=(const ProgramLoader&) = delete;
  /// Leaves a thread that is still at work to itself: the process is to end without it (std::_Exit).
  ~ProgramLoader();

  /// Whether something plays meanwhile, that comes first.
  enum class Beside { nothing, playing };

  /// `make` owns all that it uses. Precondition: !wanted().
  void begin(Make make, Beside beside);
  /// Something is being made, be it for nobody any more.
  bool busy() const;
  /// Somebody waits for what take() is to give.
  bool target() const { return target_; }
  /// What is being made is nobody's any more: take() gives an error at once, and its thread steps back behind
  /// what may play from now on.
  void give_up();
  /// What came of it, once; none while it is being made, or where nothing was. Errors: of `make`; unsuitable:
  /// no memory for it; usage: it was given up.
  std::optional<schema::Result<Program>> take();

 private:
  struct Work {
    std::atomic<bool> done{false};
    std::atomic<pid_t> thread{0};
    std::optional<schema::Result<Program>> result;
  };
  struct Next {
    Make make;
    Beside beside;
  };
  bool works() const;
  void start_next();
  void forget();

  std::shared_ptr<Work> work_;
  std::optional<Next> next_;
  std::thread thread_;
  bool target_ = false, given_up_ = false;
};

}  // namespace tacto::playback
