// SPDX-License-Identifier: GPL-3.0-or-later
// The table of measured choices as a file, and how a machine finds its own.
#include "data-schema/results/trade_table.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "data-schema/check/check.hpp"
#include "data-schema/files/files.hpp"
#include "tests/data-schema/temporary_folder.hpp"
#include "tests/data-schema/texts.hpp"

namespace tacto::schema {
namespace {

TradeTable table() {
  TradeTable made;
  made.machine = "a test's";
  made.created = "2024-05-01T12:00:00Z";
  made.choices = {{"resampling", "linear", "sample", 2, 0, {{4, 0.3}, {10, 0.03}, {20, 0.009}}},
                  {"inverse", "tap", "tap", 0.5, 4, {}}};
  return made;
}

class TradeTableFile : public testing::Test {
 protected:
  TradeTableFile() { setenv("XDG_CONFIG_HOME", (folder_ / "config").c_str(), 1); }
  ~TradeTableFile() override { unsetenv("XDG_CONFIG_HOME"); }
  const tests::TemporaryFolder folder_;
};

TEST(MeasuredChoice, ErrsAsTheNearestPointBelow) {
  const MeasuredChoice choice = table().choices.front();
  EXPECT_EQ(choice.error_at(3.9), 1);  // coarser than measured: no promise
  EXPECT_EQ(choice.error_at(4), 0.3);
  EXPECT_EQ(choice.error_at(19.9), 0.03);
  EXPECT_EQ(choice.error_at(1e6), 0.009);
  EXPECT_EQ(table().choices.back().error_at(2), 0);  // no error of its own
}

TEST_F(TradeTableFile, ReadsBack) {
  const auto text = trade_table_json(table());
  ASSERT_TRUE(text) << message(text.error());
  write_text(folder_ / "a.trade.json", *text);
  const auto read = read_trade_table(folder_ / "a.trade.json");
  ASSERT_TRUE(read) << message(read.error());
  EXPECT_EQ(*trade_table_json(*read), *text);
  ASSERT_EQ(read->at("resampling").size(), 1U);
  EXPECT_EQ(read->at("resampling").front().errors.back().error, 0.009);
  EXPECT_TRUE(check_file({FileKind::trade, folder_ / "a.trade.json"})->findings.empty());
}

TEST_F(TradeTableFile, RefusesWhatIsUnsound) {
  TradeTable made = table();
  made.choices.front().cost_ns = -1;
  EXPECT_EQ(trade_table_json(made).error().kind, ErrorKind::unsuitable);
  made = table();
  std::swap(made.choices.front().errors[0], made.choices.front().errors[1]);
  write_text(folder_ / "b.trade.json", *trade_table_json(made));
  const auto refused = read_trade_table(folder_ / "b.trade.json");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().where.find("#/choices/0/errors"), std::string::npos) << refused.error().where;
  EXPECT_EQ(read_trade_table(folder_ / "absent.trade.json").error().kind, ErrorKind::not_found);
}

TEST_F(TradeTableFile, TheMachinesOwnComesBeforeTheShippedOne) {
  const auto shipped = find_trade_table();
  ASSERT_TRUE(shipped) << message(shipped.error());
  EXPECT_NE(shipped->origin.find("shipped"), std::string::npos);
  EXPECT_NE(shipped->origin.find(shipped->table.machine), std::string::npos);
  for (const char* stage : {"resampling", "grid", "spectrogram", "reading", "inverse"})
    EXPECT_FALSE(shipped->table.at(stage).empty()) << stage;
  const auto path = write_machine_trade_table(table());
  ASSERT_TRUE(path) << message(path.error());
  const auto own = find_trade_table();
  ASSERT_TRUE(own);
  EXPECT_EQ(own->table.machine, "a test's");
  EXPECT_NE(own->origin.find(*path), std::string::npos);
}

TEST_F(TradeTableFile, ABrokenOneIsNotPassedOver) {
  const auto path = machine_trade_path();
  ASSERT_TRUE(path);
  std::filesystem::create_directories(std::filesystem::path(*path).parent_path());
  write_text(*path, "{");
  EXPECT_EQ(find_trade_table().error().kind, ErrorKind::malformed);
}

}  // namespace
}  // namespace tacto::schema
