// SPDX-License-Identifier: GPL-3.0-or-later
// Files are written completely or not at all.
#include "data-schema/files/files.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "data-schema/kinds/file_kind.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::schema {
namespace {

using tests::TemporaryFolder;

TEST(PendingFiles, AppearTogetherAtCommit) {
  const TemporaryFolder folder;
  PendingFiles pending;
  ASSERT_TRUE(pending.write(folder / "a", "one"));
  ASSERT_TRUE(pending.write(folder / "b", "two"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a"));
  ASSERT_TRUE(pending.commit());
  EXPECT_EQ(read_file(folder / "a").value(), "one");
  EXPECT_EQ(read_file(folder / "b").value(), "two");
  EXPECT_EQ(folder.files(), 2U);
}

TEST(PendingFiles, LeaveTheFolderAsItWasWhenDropped) {
  const TemporaryFolder folder;
  {
    PendingFiles first;
    ASSERT_TRUE(first.write(folder / "a", "old"));
    ASSERT_TRUE(first.commit());
  }
  {
    PendingFiles dropped;
    ASSERT_TRUE(dropped.write(folder / "a", "new"));
    ASSERT_TRUE(dropped.write(folder / "b", "new"));
  }
  EXPECT_EQ(read_file(folder / "a").value(), "old");
  EXPECT_EQ(folder.files(), 1U);
}

TEST(PendingFiles, LeaveNothingAfterAFailedCommit) {
  const TemporaryFolder folder;
  {
    PendingFiles pending;
    ASSERT_TRUE(pending.write(folder / "a", "content"));
    std::filesystem::create_directories(folder / "a" + "/inside");
    const auto committed = pending.commit();
    ASSERT_FALSE(committed);
    EXPECT_EQ(committed.error().kind, ErrorKind::cannot_write);
  }
  EXPECT_EQ(folder.files(), 1U);  // the folder with that name
}

TEST(PendingFiles, ThatAreToKeepWhatIsThereAppearAllOrNotAtAll) {
  const TemporaryFolder folder;
  PendingFiles first, second;
  for (PendingFiles* pending : {&first, &second})
    for (const char* name : {"b", "a"})
      ASSERT_TRUE(pending->write(folder / name, pending == &first ? "1" : "2"));
  ASSERT_TRUE(first.commit(Existing::keep));
  const auto late = second.commit(Existing::keep);
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().kind, ErrorKind::usage);
  EXPECT_EQ(read_file(folder / "a").value() + read_file(folder / "b").value(), "11");
  std::filesystem::remove(folder / "b");
  PendingFiles third;
  for (const char* name : {"b", "a"}) ASSERT_TRUE(third.write(folder / name, "3"));
  EXPECT_FALSE(third.commit(Existing::keep));
  EXPECT_FALSE(is_file(folder / "b"));
  EXPECT_EQ(read_file(folder / "a").value(), "1");
}

TEST(PendingFiles, AreRemovedWhereASignalEndsTheProcess) {
  const TemporaryFolder folder;
  PendingFiles pending;
  ASSERT_TRUE(pending.write(folder / "a", "content"));
  {
    PendingFiles done;
    ASSERT_TRUE(done.write(folder / "b", "content"));
    ASSERT_TRUE(done.commit());
  }
  EXPECT_EQ(folder.files(), 2U);
  remove_pending_files();
  EXPECT_EQ(folder.files(), 1U);
  EXPECT_TRUE(is_file(folder / "b"));
}

TEST(Files, ATableReplacesOnlyItsLike) {
  const TemporaryFolder folder;
  const auto ours = [](std::string_view line) { return line == "texture,mm"; };
  EXPECT_TRUE(check_table_free(folder / "a.csv", Existing::keep, ours));
  std::ofstream(folder / "a.csv") << "texture,mm\n1,2\n";
  EXPECT_TRUE(check_table_free(folder / "a.csv", Existing::replace, ours));
  const auto kept = check_table_free(folder / "a.csv", Existing::keep, ours);
  ASSERT_FALSE(kept);
  EXPECT_NE(message(kept.error()).find("--force"), std::string::npos) << message(kept.error());
  std::ofstream(folder / "a.csv") << "time,force\n1,2\n";
  const auto refused = check_table_free(folder / "a.csv", Existing::replace, ours);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::usage);
}

// With or without --force.
TEST(Files, ASoundFileNeverReplacesARecordingsData) {
  const TemporaryFolder folder;
  for (const char* beside : {"a.json", "b.events.jsonl"}) {
    std::ofstream(folder / beside) << "{}";
    const std::string wav = (folder / beside).substr(0, (folder / "a").size()) + ".wav";
    for (const Existing existing : {Existing::keep, Existing::replace})
      EXPECT_EQ(check_wav_free(wav, existing).error().kind, ErrorKind::usage) << wav;
  }
  EXPECT_TRUE(check_wav_free(folder / "c.wav", Existing::keep));
}

TEST(Files, OneFileHasManySpellings) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "x");
  std::filesystem::create_directory_symlink(folder / "x", folder / "link");
  EXPECT_TRUE(same_file(folder / "x/a.nc", folder / "x/./a.nc"));
  EXPECT_TRUE(same_file(folder / "x/a.nc", folder / "x/../x/a.nc"));
  EXPECT_TRUE(same_file(folder / "x/a.nc", folder / "link/a.nc"));
  EXPECT_TRUE(same_file(folder / "a.nc", folder / "link/../a.nc"))
      << "the link's target is a folder beside it";
  EXPECT_FALSE(same_file(folder / "x/a.nc", folder / "a.nc"));
  std::ofstream(folder / "x/a.nc") << "1";
  std::filesystem::create_symlink(folder / "x/a.nc", folder / "b.nc");
  EXPECT_TRUE(same_file(folder / "b.nc", folder / "link/a.nc"));
}

TEST(PendingFiles, RefuseFoldersThatCannotBeMadeOrAreInTheWay) {
  const TemporaryFolder folder;
  PendingFiles pending;
  std::ofstream(folder / "file") << "";
  for (const std::string& path :
       {folder / "file/a", folder / "file/b/a", folder / "", std::string("/proc/a")}) {
    const auto added = pending.add(path);
    ASSERT_FALSE(added) << path;
    EXPECT_EQ(added.error().kind, ErrorKind::cannot_write);
  }
  EXPECT_EQ(pending.add(folder / "file/b/a").error().where, folder / "file");
  EXPECT_EQ(folder.files(), 1U);
}

TEST(PendingFiles, MakeMissingFoldersAndLeaveNoneThatIsEmpty) {
  const TemporaryFolder folder;
  {
    PendingFiles pending;
    ASSERT_TRUE(pending.write(folder / "new/er/a", "1"));
    ASSERT_TRUE(pending.write(folder / "new/b", "1"));
  }
  EXPECT_EQ(folder.files(), 0U);
  {
    PendingFiles kept, failed;
    ASSERT_TRUE(failed.write(folder / "new/er/a", "1"));
    ASSERT_TRUE(kept.write(folder / "new/b", "2"));
    ASSERT_TRUE(kept.commit());
  }
  EXPECT_EQ(read_file(folder / "new/b").value(), "2");
  EXPECT_FALSE(std::filesystem::exists(folder / "new/er"));
  PendingFiles again;
  ASSERT_TRUE(again.write(folder / "new/x/y/../z", "3"));
  ASSERT_TRUE(again.commit());
  EXPECT_EQ(read_file(folder / "new/x/z").value(), "3");
}

TEST(PendingFiles, ASignalRemovesMadeFoldersThatAreEmpty) {
  const TemporaryFolder folder;
  PendingFiles pending, other;
  ASSERT_TRUE(pending.write(folder / "new/er/est/a", "1"));
  ASSERT_TRUE(other.write(folder / "kept/er/a", "1"));
  ASSERT_TRUE(other.write(folder / "kept/b", "1"));
  std::ofstream(folder / "kept/stays") << "";
  remove_pending_files();
  EXPECT_FALSE(std::filesystem::exists(folder / "new"));
  EXPECT_FALSE(std::filesystem::exists(folder / "kept/er"));
  EXPECT_TRUE(std::filesystem::exists(folder / "kept/stays"));
}

TEST(Files, SayWhyTheyCantBeRead) {
  const TemporaryFolder folder;
  EXPECT_EQ(read_file(folder / "absent").error().what, "there is no such file");
  EXPECT_EQ(read_file(folder / "").error().what, "is a folder, not a file");
  EXPECT_EQ(check_readable(folder / "absent").error().kind, ErrorKind::not_found);
  EXPECT_EQ(sha256_of_file(folder / "absent").error().kind, ErrorKind::not_found);
}

// Root may read every folder, so the test becomes another user for it.
TEST(Files, AFolderThatCannotBeReadIsNamedAndHidesNoOtherFile) {
  const TemporaryFolder folder;
  for (const char* name : {"a", "closed", "z", ".hidden"}) {
    std::filesystem::create_directory(folder / name);
    std::ofstream(folder / name + "/file") << "text";
  }
  std::filesystem::create_directory_symlink(folder / "a", folder / "link");
  std::filesystem::permissions(folder / "", std::filesystem::perms(0755));
  std::filesystem::permissions(folder / "closed", std::filesystem::perms::none);
  const uid_t me = ::geteuid();
  if (me == 0 && ::seteuid(65534) != 0) GTEST_SKIP() << "root cannot become another user here";
  const auto below = files_below(folder / "");
  const auto closed = files_below(folder / "closed");
  const auto stored = stored_files(folder / "closed/oak");
  ASSERT_EQ(::seteuid(me), 0);
  std::filesystem::permissions(folder / "closed", std::filesystem::perms::owner_all);
  ASSERT_TRUE(below);
  EXPECT_EQ(below->files, (std::vector<std::string>{folder / "a/file", folder / "z/file"}));
  ASSERT_EQ(below->unreadable.size(), 1U);
  EXPECT_EQ(below->unreadable[0].where, folder / "closed");
  ASSERT_FALSE(closed);
  EXPECT_EQ(closed.error().kind, ErrorKind::not_found);
  ASSERT_FALSE(stored);
  EXPECT_NE(stored.error().what, "there is no such file");
  EXPECT_FALSE(files_below(folder / "absent"));
}

// The pipe has no writer, so opening it would block.
TEST(Files, APipeIsNotWaitedFor) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "oak.texture.json").c_str(), 0600), 0);
  for (const std::string& path : {folder / "oak.texture.json", std::string("/dev/zero")}) {
    const auto read = read_file(path);
    ASSERT_FALSE(read) << path;
    EXPECT_EQ(read.error().kind, ErrorKind::not_found);
    EXPECT_FALSE(check_readable(path));
    EXPECT_FALSE(sha256_of_file(path));
  }
}

// The vectors of FIPS 180-4's examples: "", "abc" and a million times "a".
TEST(Sha256, MatchesTheStandard) {
  EXPECT_EQ(sha256_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  const TemporaryFolder folder;
  PendingFiles pending;
  ASSERT_TRUE(pending.write(folder / "a", std::string(1000000, 'a')));
  ASSERT_TRUE(pending.commit());
  EXPECT_EQ(sha256_of_file(folder / "a").value(),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Files, StemIsTheNameWithoutWhatOursAdd) {
  for (const char* name : {"d/oak", "d/oak.texture.json", "d/oak.texture.wav", "d/oak.texture"})
    EXPECT_EQ(stem_of(name, ".texture"), "d/oak");
  for (const char* name : {"oak.1", "oak.1.json", "oak.1.wav"}) EXPECT_EQ(stem_of(name, ""), "oak.1");
  EXPECT_EQ(stem_of("oak.csv", ""), "oak.csv");
}

}  // namespace
}  // namespace tacto::schema
