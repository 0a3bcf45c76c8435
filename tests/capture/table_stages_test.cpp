// SPDX-License-Identifier: GPL-3.0-or-later
// A table of many pieces, read by several threads: rows, checksum and errors are those of the file, in their
// order.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <new>

#include "capture/table/source.hpp"
#include "data-schema/files/files.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::capture {
namespace {

constexpr std::size_t kStageRows = 200000;  // 2.6 MB: some twenty pieces
const std::vector<std::size_t> kBoth = {0, 1};

class TableStages : public ::testing::Test {
 protected:
  // Rows 0,0.5 1,1.5 2,2.5 ...; one of them may be another text.
  std::string table(std::size_t odd_row = kStageRows, const std::string& odd = "") {
    const std::string path = folder_ / "table.csv";
    std::ofstream file(path, std::ios::binary);
    file << "a,b\n";
    for (std::size_t i = 0; i < kStageRows; ++i)
      if (i == odd_row)
        file << odd << '\n';
      else
        file << i << ',' << i << ".5\n";
    return path;
  }

  // Counts what comes; fails with the block that reaches `last`.
  schema::Result<void> read(const std::string& path, std::size_t last = kStageRows + 1,
                            schema::Sha256* sum = nullptr) {
    const auto source = open_source(path);
    TACTO_TRY(source);
    const auto take = [&](const RowBlock& block) -> schema::Result<void> {
      EXPECT_EQ(block.first_row, rows_);
      EXPECT_EQ(block.place_of(rows_), "line " + std::to_string(rows_ + 2));
      for (std::size_t i = 0; i < block.rows(); ++i, ++rows_) {
        wrong_ += block.numbers[2 * i] != static_cast<double>(rows_);
        wrong_ += block.numbers[2 * i + 1] != static_cast<double>(rows_) + 0.5;
      }
      if (rows_ >= last) return schema::fail(schema::ErrorKind::cannot_write, "the disk is full");
      return {};
    };
    return read_source(
        *source, kBoth, take, [&](double part) { parts_.push_back(part); }, sum);
  }

  tests::TemporaryFolder folder_;
  std::size_t rows_ = 0, wrong_ = 0;
  std::vector<double> parts_;
};

TEST_F(TableStages, GiveEachRowOnceAndTheChecksum) {
  const std::string path = table();
  schema::Sha256 sum;
  ASSERT_TRUE(read(path, kStageRows + 1, &sum));
  EXPECT_EQ(rows_, kStageRows);
  EXPECT_EQ(wrong_, 0U);
  EXPECT_EQ(sum.hexadecimal(), *schema::sha256_of_file(path));
  EXPECT_TRUE(std::ranges::is_sorted(parts_));
  EXPECT_EQ(parts_.back(), 1);
}

TEST_F(TableStages, GiveTheRowsBeforeAnErrorFirst) {
  const auto done = read(table(150000, "150000,nonsense"));
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().kind, schema::ErrorKind::malformed);
  EXPECT_NE(done.error().where.find("line 150002, column 2"), std::string::npos) << done.error().where;
  EXPECT_GT(rows_, 130000U);
  EXPECT_LE(rows_, 150000U);
  EXPECT_EQ(wrong_, 0U);
}

TEST_F(TableStages, TheCallersErrorComesBeforeOneFurtherDown) {
  const auto done = read(table(199999, "nonsense"), 20000);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().kind, schema::ErrorKind::cannot_write);
  EXPECT_LT(rows_, 60000U);
}

TEST_F(TableStages, WhatTheCallerThrowsEndsTheThreads) {
  const auto source = open_source(table());
  ASSERT_TRUE(source);
  const auto take = [](const RowBlock&) -> schema::Result<void> { throw std::bad_alloc(); };
  EXPECT_THROW(static_cast<void>(read_source(*source, kBoth, take, [](double) {})), std::bad_alloc);
}

}  // namespace
}  // namespace tacto::capture
