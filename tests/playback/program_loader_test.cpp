// SPDX-License-Identifier: GPL-3.0-or-later
// One program is loaded at a time; a cancelled load blocks no client.
#include "playback/player/program_loader.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <future>

namespace tacto::playback {
namespace {

using schema::ErrorKind;
using schema::Result;

// The loader returns an error with a name, because a program would need a texture.
ProgramLoader::Make fails_with(const std::string& name) {
  return [name]() -> Result<Program> { return schema::fail(ErrorKind::not_found, name, "here"); };
}

ProgramLoader::Make waits_for(std::shared_future<void> end) {
  return [end]() -> Result<Program> {
    end.wait();
    return schema::fail(ErrorKind::not_found, "first", "here");
  };
}

std::string taken_in_the_end(ProgramLoader& loader) {
  for (;;) {
    if (const auto program = loader.take()) return program->error().what;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

TEST(ProgramLoading, WhatIsBegunAfterOneThatWasGivenUpIsMade) {
  std::promise<void> end;
  ProgramLoader loader;
  loader.begin(waits_for(end.get_future().share()), ProgramLoader::Beside::nothing);
  EXPECT_FALSE(loader.take());
  EXPECT_TRUE(loader.target());
  loader.give_up();
  const auto given_up = loader.take();
  ASSERT_TRUE(given_up);
  EXPECT_NE(given_up->error().what.find("cancelled"), std::string::npos);
  EXPECT_FALSE(loader.target());
  EXPECT_TRUE(loader.busy()) << "its thread can't be interrupted";
  loader.begin(fails_with("second"), ProgramLoader::Beside::nothing);
  EXPECT_TRUE(loader.target());
  EXPECT_FALSE(loader.take()) << "the first one's thread still holds its memory";
  end.set_value();
  EXPECT_EQ(taken_in_the_end(loader), "second");
  EXPECT_FALSE(loader.busy());
}

// After cancelling a load, a client may arm and play at once.
TEST(ProgramLoading, AThreadThatWasGivenUpStepsBack) {
  std::promise<void> begun, end;
  std::promise<int> nice;
  ProgramLoader loader;
  loader.begin(
      [&]() -> Result<Program> {
        begun.set_value();
        end.get_future().wait();
        nice.set_value(getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())));
        return schema::fail(ErrorKind::not_found, "first", "here");
      },
      ProgramLoader::Beside::nothing);
  begun.get_future().wait();
  const int before = getpriority(PRIO_PROCESS, static_cast<id_t>(gettid()));
  loader.give_up();
  end.set_value();
  EXPECT_GT(nice.get_future().get(), before);
  while (loader.busy()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST(ProgramLoading, WhatWaitsForAThreadCanBeGivenUpToo) {
  std::promise<void> end;
  ProgramLoader loader;
  loader.begin(waits_for(end.get_future().share()), ProgramLoader::Beside::nothing);
  loader.give_up();
  ASSERT_TRUE(loader.take());
  loader.begin(fails_with("second"), ProgramLoader::Beside::nothing);
  loader.give_up();
  const auto given_up = loader.take();
  ASSERT_TRUE(given_up);
  EXPECT_NE(given_up->error().what.find("cancelled"), std::string::npos);
  end.set_value();
  loader.begin(fails_with("third"), ProgramLoader::Beside::nothing);
  EXPECT_EQ(taken_in_the_end(loader), "third");
}

}  // namespace
}  // namespace tacto::playback
