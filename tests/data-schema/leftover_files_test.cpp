// SPDX-License-Identifier: GPL-3.0-or-later
// Files of a killed process are distinguished from those of a running process or of another machine.
#include "data-schema/files/leftover_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "data-schema/files/files.hpp"
#include "data-schema/files/process_mark.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::schema {
namespace {

namespace fs = std::filesystem;
using tests::TemporaryFolder;

// Another process. Its constructor returns after half of `path` is written; the process then waits.
class Writer {
 public:
  explicit Writer(const std::string& path) {
    std::array<int, 2> ready{};
    EXPECT_EQ(pipe(ready.data()), 0);
    pid_ = fork();
    if (pid_ == 0) write_and_wait(path, ready[1]);
    char byte = 0;
    EXPECT_EQ(read(ready[0], &byte, 1), 1);
    close(ready[0]);
    close(ready[1]);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() {
    if (pid_ > 0) end();
  }

  void end() {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    pid_ = 0;
  }

 private:
  [[noreturn]] static void write_and_wait(const std::string& path, int ready) {
    PendingFiles pending;
    if (pending.write(path, "half of it")) [[maybe_unused]]
      const auto said = ::write(ready, "x", 1);
    for (;;) pause();
  }
  pid_t pid_ = 0;
};

std::string only_file(const TemporaryFolder& folder) {
  EXPECT_EQ(folder.files(), 1U);
  return fs::directory_iterator(folder / "")->path().string();
}

void touch(const std::string& path, std::time_t when) {
  std::ofstream(path) << "content";
  const timespec times[] = {{when, 0}, {when, 0}};
  ASSERT_EQ(utimensat(AT_FDCWD, path.c_str(), times, 0), 0);
}

std::string temporary(const TemporaryFolder& folder, const std::string& target, const ProcessMark& mark) {
  return folder / fmt::format(".{}.{}-0.tmp", target, text_of(mark));
}

TEST(LeftoverFiles, AreOfProcessesThatWereKilledAlone) {
  const TemporaryFolder folder;
  Writer writer(folder / "oak.wav");
  EXPECT_TRUE(leftovers_in(folder / "").empty());
  writer.end();
  const auto found = leftovers_in(folder / "");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].target, "oak.wav");
  EXPECT_EQ(found[0].path, only_file(folder));
  EXPECT_EQ(found[0].bytes, 10U);
  EXPECT_TRUE(found[0].ended);
  EXPECT_EQ(remove_ended(found).size(), 1U);
  EXPECT_EQ(folder.files(), 0U);
}

TEST(LeftoverFiles, OwnFilesAreNone) {
  const TemporaryFolder folder;
  PendingFiles pending;
  ASSERT_TRUE(pending.write(folder / "oak.wav", "x"));
  EXPECT_TRUE(leftovers_in(folder / "").empty());
}

TEST(LeftoverFiles, TheNextRunOfThatNameRemovesThem) {
  const TemporaryFolder folder;
  {
    Writer oak(folder / "oak.wav"), elm(folder / "elm.wav");
    EXPECT_EQ(folder.files(), 2U);
  }
  PendingFiles next;
  ASSERT_TRUE(next.write(folder / "oak.wav", "whole"));
  ASSERT_TRUE(next.commit());
  const auto left = leftovers_in(folder / "");
  ASSERT_EQ(left.size(), 1U);
  EXPECT_EQ(left[0].target, "elm.wav");
  EXPECT_EQ(*read_file(folder / "oak.wav"), "whole");
}

TEST(LeftoverFiles, OfAProcessThatRunsStayAtTheNextRunOfThatName) {
  const TemporaryFolder folder;
  const Writer writer(folder / "oak.wav");
  const std::string its_file = only_file(folder);
  PendingFiles next;
  ASSERT_TRUE(next.write(folder / "oak.wav", "whole"));
  ASSERT_TRUE(next.commit());
  EXPECT_TRUE(is_file(its_file));
}

// A reused process number belongs to a process with another start time.
TEST(LeftoverFiles, AProcessIsKnownByWhenItBegan) {
  const TemporaryFolder folder;
  ProcessMark mark = own_mark();
  ++mark.start;
  touch(temporary(folder, "oak.wav", mark), std::time(nullptr));
  ASSERT_EQ(leftovers_in(folder / "").size(), 1U);
  EXPECT_TRUE(leftovers_in(folder / "")[0].ended);
}

TEST(LeftoverFiles, OfAnotherMachineAreNeverRemoved) {
  const TemporaryFolder folder;
  ProcessMark mark = own_mark();
  mark.machine = mark.machine == "12345678" ? "12345679" : "12345678";
  mark.pid = 999999999;
  touch(temporary(folder, "oak.wav", mark), 0);
  const auto found = leftovers_in(folder / "");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_FALSE(found[0].ended);
  EXPECT_TRUE(remove_ended(found).empty());
  EXPECT_EQ(folder.files(), 1U);
}

// A machine after a restart; or a copy of it with the same names that runs at the same time.
TEST(LeftoverFiles, OfAnotherBootHaveEndedWhereTheyAreOlderThanThisOne) {
  const TemporaryFolder folder;
  ProcessMark mark = own_mark();
  mark.boot = mark.boot == "12345678" ? "12345679" : "12345678";
  touch(temporary(folder, "before", mark), 0);
  touch(temporary(folder, "since", mark), std::time(nullptr));
  const auto found = leftovers_in(folder / "");
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].target, "before");
  EXPECT_TRUE(found[0].ended);
  EXPECT_FALSE(found[1].ended);
}

TEST(LeftoverFiles, OfOlderVersionsAreListedAndStay) {
  const TemporaryFolder folder;
  touch(folder / ".oak.wav.999999999.0.tmp", 0);
  ASSERT_EQ(leftovers_in(folder / "").size(), 1U);
  EXPECT_FALSE(leftovers_in(folder / "")[0].ended);
}

TEST(LeftoverFiles, OthersFilesAreNone) {
  const TemporaryFolder folder;
  ProcessMark mark = own_mark();
  ++mark.start;
  const std::string text = text_of(mark);
  for (const std::string& name :
       {"oak.wav." + text + "-0.tmp", ".oak.wav." + text + "-0", "." + text + "-0.tmp",
        ".oak.wav." + text + "-.tmp", ".oak.wav." + text + "-x.tmp", std::string(".vim.tmp"),
        std::string(".oak.wav.G2345678-12345678-1-1-0.tmp"), std::string(".1.2.tmp")})
    touch(folder / name, 0);
  fs::create_directory(folder / ".oak.wav." + text + "-1.tmp");
  fs::create_symlink("oak.wav", folder / ".oak.wav." + text + "-2.tmp");
  EXPECT_TRUE(leftovers_in(folder / "").empty());
}

TEST(LeftoverFiles, OfAStemAreItsFilesAndItsStrokes) {
  const TemporaryFolder folder;
  ProcessMark mark = own_mark();
  ++mark.start;
  for (const char* target :
       {"oak.wav", "oak.json", "oak-01.texture.wav", "oak-table.wav", "oakwood.wav", "elm.wav"})
    touch(temporary(folder, target, mark), 0);
  std::vector<std::string> targets;
  for (const Leftover& one : leftovers_of(folder / "oak")) targets.push_back(one.target);
  EXPECT_EQ(targets, (std::vector<std::string>{"oak-01.texture.wav", "oak.json", "oak.wav"}));
}

TEST(LeftoverFiles, LongNamesAreCutToWhatAFileSystemTakes) {
  const TemporaryFolder folder;
  const std::string name(250, 'n');
  { const Writer writer(folder / name); }
  EXPECT_EQ(leftovers_in(folder / "").size(), 1U);
  PendingFiles next;
  ASSERT_TRUE(next.write(folder / name, "whole"));
  ASSERT_TRUE(next.commit());
  EXPECT_EQ(folder.files(), 1U);
}

TEST(LeftoverFiles, AFolderThatIsAbsentHasNone) {
  EXPECT_TRUE(leftovers_in("/no/such/folder").empty());
}

TEST(ProcessMark, IsReadAsItWasWritten) {
  const auto mark = parse_mark(text_of(own_mark()));
  ASSERT_TRUE(mark);
  EXPECT_EQ(mark->pid, getpid());
  EXPECT_EQ(mark->start, own_mark().start);
  EXPECT_EQ(liveness_of(*mark, std::time(nullptr)), Liveness::runs);
  for (const char* none : {"", "1", "12345678-12345678-1", "12345678-12345678-0-1", "12345678-12345678--1-1",
                           "1234567-12345678-1-1", "12345678-12345678-1-1-1", "12345678-12345678-1-x"})
    EXPECT_FALSE(parse_mark(none)) << none;
}

}  // namespace
}  // namespace tacto::schema
