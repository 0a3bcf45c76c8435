// SPDX-License-Identifier: GPL-3.0-or-later
// Results as a file: they read back as written; invalid results, and those that would overwrite files, are
// refused.
#include "data-schema/results/results.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "data-schema/check/check.hpp"
#include "data-schema/files/files.hpp"
#include "tests/data-schema/temporary_folder.hpp"
#include "tests/data-schema/texts.hpp"

namespace tacto::schema {
namespace {

Results results() {
  Results made;
  made.verb = "compare";
  made.inputs = {"oak", "pine & ash"};
  made.device = "sim:";
  made.simulated = "by a test";
  made.figures = {{"level", "+6.0 dB"}};
  made.pictures = {{"Bands", "1/mm", "dB", true, {{"level", {1, 2, 3}, {0.1, NAN, 0.3}, true}}}};
  made.details_json = R"({"level_db": 6.0206})";
  made.created = "2024-05-01T12:00:00Z";
  made.creator = "a test";
  return made;
}

TEST(Results, ReadBack) {
  const tests::TemporaryFolder folder;
  const auto text = results_json(results());
  ASSERT_TRUE(text) << message(text.error());
  write_text(folder / "a.results.json", *text);
  const auto read = read_results(folder / "a");
  ASSERT_TRUE(read) << message(read.error());
  EXPECT_EQ(read->inputs, results().inputs);
  EXPECT_EQ(read->simulated, "by a test");
  EXPECT_EQ(read->figures.at(0).value, "+6.0 dB");
  const ResultCurve& curve = read->pictures.at(0).curves.at(0);
  EXPECT_EQ(curve.x, (std::vector<double>{1, 3})) << "a point that is no number is left out";
  EXPECT_EQ(curve.y, (std::vector<double>{0.1, 0.3}));
  EXPECT_TRUE(curve.dashed && read->pictures.at(0).logarithmic_x);
  EXPECT_EQ(read->details_json, R"({"level_db":6.0206})");
  EXPECT_EQ(*results_json(*read), *text);
  EXPECT_TRUE(check_file({FileKind::results, folder / "a.results.json"})->findings.empty());
}

TEST(Results, RefusesWhatIsUnsound) {
  Results made = results();
  made.details_json = "[1]";
  EXPECT_EQ(results_json(made).error().kind, ErrorKind::unsuitable);
  made = results();
  made.verb.clear();
  EXPECT_EQ(results_json(made).error().kind, ErrorKind::unsuitable);
  const tests::TemporaryFolder folder;
  write_text(folder / "a.results.json", R"({"kind": "results", "version": "1.0", "verb": "compare"})");
  EXPECT_EQ(read_results(folder / "a").error().kind, ErrorKind::malformed);
  EXPECT_EQ(read_results(folder / "absent").error().kind, ErrorKind::not_found);
}

TEST(Results, RefusesACurveOfUnequalLengths) {
  const tests::TemporaryFolder folder;
  const std::string path = folder / "a.results.json";
  Results made = results();
  made.pictures.push_back({"More", "", "", false, {{"whole", {1, 2}, {3, 4}}, {"short", {5.5, 6}, {7, 8}}}});
  std::string text = results_json(made).value();
  const auto at = text.find("5.5,");
  ASSERT_NE(at, std::string::npos);
  write_text(path, text.erase(at, 4));
  const auto read = read_results(path);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().kind, ErrorKind::malformed);
  EXPECT_EQ(read.error().where, path + "#/pictures/1/curves/1");
  const auto checked = check_file({FileKind::results, path});
  ASSERT_EQ(checked->findings.size(), 1u);
  EXPECT_EQ(checked->findings.front().where, path + "#/pictures/1/curves/1");
}

TEST(Results, ReplacesOnlyItsLike) {
  const tests::TemporaryFolder folder;
  EXPECT_TRUE(check_results_free(folder / "absent.json", Existing::replace));
  write_text(folder / "a.json", *results_json(results()));
  EXPECT_TRUE(check_results_free(folder / "a.json", Existing::replace));
  write_text(folder / "b.json", R"({"kind": "recording"})");
  EXPECT_EQ(check_results_free(folder / "b.json", Existing::replace).error().kind, ErrorKind::usage);
  write_text(folder / "c.json", "{");
  EXPECT_EQ(check_results_free(folder / "c.json", Existing::replace).error().kind, ErrorKind::usage);
}

}  // namespace
}  // namespace tacto::schema
