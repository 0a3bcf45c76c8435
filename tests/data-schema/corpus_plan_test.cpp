// SPDX-License-Identifier: GPL-3.0-or-later
// The plan of a corpus as a file.
#include "data-schema/corpus/corpus_plan.hpp"

#include <gtest/gtest.h>

#include "data-schema/check/check.hpp"
#include "data-schema/kinds/file_kind.hpp"
#include "tests/data-schema/temporary_folder.hpp"
#include "tests/data-schema/texts.hpp"

namespace tacto::schema {
namespace {

CorpusPlan plan() {
  CorpusPlan made;
  made.steps = {{"spatial", "--band 20Hz..400Hz"}, {"describe", ""}};
  made.recordings = {{"../raw/oak.json", std::string(64, 'a')}, {"/data/pine.json", std::string(64, 'b')}};
  made.created = "2024-05-01T12:00:00Z";
  made.creator = "a test";
  return made;
}

TEST(CorpusPlan, ReadsBack) {
  const tests::TemporaryFolder folder;
  const auto text = corpus_plan_json(plan());
  ASSERT_TRUE(text) << message(text.error());
  write_text(folder / "a.corpus.json", *text);
  const auto read = read_corpus_plan(folder / "a.corpus.json");
  ASSERT_TRUE(read) << message(read.error());
  EXPECT_EQ(*corpus_plan_json(*read), *text);
  EXPECT_EQ(read->recordings[1].path, "/data/pine.json");
  EXPECT_EQ(stored_files(folder / "a")->front().kind, FileKind::corpus);
  EXPECT_TRUE(check_file({FileKind::corpus, folder / "a.corpus.json"})->findings.empty());
}

TEST(CorpusPlan, RefusesOtherStepsAndChecksums) {
  CorpusPlan made = plan();
  std::swap(made.steps[0], made.steps[1]);
  EXPECT_FALSE(corpus_plan_json(made));
  made = plan();
  made.steps[1].step = "certify";
  EXPECT_FALSE(corpus_plan_json(made));
  made = plan();
  made.recordings[0].sha256 = "abc";
  EXPECT_EQ(corpus_plan_json(made).error().kind, ErrorKind::unsuitable);
  made = plan();
  made.recordings.clear();
  EXPECT_EQ(corpus_plan_json(made).error().kind, ErrorKind::unsuitable);
}

TEST(CorpusPlan, RefusesUnknownMembers) {
  const tests::TemporaryFolder folder;
  std::string text = *corpus_plan_json(plan());
  text.insert(text.find("\"steps\""), "\"shards\": 3, ");
  write_text(folder / "a.corpus.json", text);
  const auto read = read_corpus_plan(folder / "a.corpus.json");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().kind, ErrorKind::malformed);
  EXPECT_NE(read.error().where.find("#/shards"), std::string::npos) << read.error().where;
}

}  // namespace
}  // namespace tacto::schema
