// SPDX-License-Identifier: GPL-3.0-or-later
// Prepares a program in parallel to a playback.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <variant>

#include "playback/player/force_program.hpp"
#include "playback/player/program.hpp"

namespace tacto::playback {

/// A program for a tray, or the forces of a scene.
using AnyProgram = std::variant<Program, ForceProgram>;

/// Prepares one program at a time, on a thread of its own for which no caller has to wait: a long texture
/// takes seconds, and cannot be interrupted. A program requested after one that was cancelled follows when
/// that thread has ended, so that only one is in memory. For one calling thread.
class ProgramLoader {
 public:
  using Make = std::function<schema::Result<AnyProgram>()>;

  ProgramLoader() = default;
  ProgramLoader(const ProgramLoader&) = delete;
  ProgramLoader& operator=(const ProgramLoader&) = delete;
  /// Detaches a thread that still works: the process has to end without it (std::_Exit).
  ~ProgramLoader();

  /// Whether there is a playback meanwhile, which has priority.
  enum class Beside { nothing, playing };

  /// `make` owns all data that it uses. Precondition: !target().
  void begin(Make make, Beside beside);
  /// Whether a program is being made, even if it was cancelled.
  bool busy() const;
  /// Whether a caller waits for the result of take().
  bool target() const { return target_; }
  /// Cancels: take() returns an error at once, and the thread gets a lower priority than a later playback.
  void give_up();
  /// The result, once; none while the program is being made, or if there was none. Errors: of `make`;
  /// unsuitable: not enough memory for it; usage: it was cancelled.
  std::optional<schema::Result<AnyProgram>> take();

 private:
  struct Work {
    std::atomic<bool> done{false};
    std::atomic<pid_t> thread{0};
    std::optional<schema::Result<AnyProgram>> result;
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
