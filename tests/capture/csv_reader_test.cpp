// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/table/csv_reader.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "tests/capture/read_text.hpp"

namespace tacto::capture {
namespace {

using Columns = std::vector<std::vector<double>>;

ReadText read(std::string_view text, std::vector<std::size_t> columns = {}, std::size_t piece = 1 << 20) {
  auto table = read_text(text, std::move(columns), piece);
  EXPECT_TRUE(table) << (table ? "" : schema::message(table.error()));
  return table.value_or(ReadText{});
}

struct TableCase {
  const char* what;
  std::string text;
  Columns values;
};

class CsvTables : public testing::TestWithParam<TableCase> {};

TEST_P(CsvTables, GivesItsNumbers) {
  EXPECT_EQ(read(GetParam().text).values, GetParam().values);
}

// The numbers do not depend on how the file is cut into pieces, down to single bytes.
TEST_P(CsvTables, GivesThemInPiecesOfAnySize) {
  for (std::size_t piece = 1; piece < 9; ++piece)
    EXPECT_EQ(read(GetParam().text, {}, piece).values, GetParam().values) << piece;
}

INSTANTIATE_TEST_SUITE_P(
    All, CsvTables,
    testing::Values(TableCase{"comma", "f,x\n1,2\n-3.5,4e-3\n", {{1, -3.5}, {2, 4e-3}}},
                    TableCase{"no_line_end_at_the_end", "f,x\n1,2\n3,4", {{1, 3}, {2, 4}}},
                    TableCase{"crlf", "f,x\r\n1,2\r\n3,4\r\n", {{1, 3}, {2, 4}}},
                    TableCase{"old_mac", "f,x\r1,2\r3,4\r", {{1, 3}, {2, 4}}},
                    TableCase{
                        "semicolon_decimal_comma", "f;x\n1,5;2\n-3,5;4,25e-3\n", {{1.5, -3.5}, {2, 4.25e-3}}},
                    TableCase{"integers_then_decimal_comma", "1;2\n3;4\n0,5;6\n", {{1, 3, 0.5}, {2, 4, 6}}},
                    TableCase{"tab", "f\tx\n1\t2\n", {{1}, {2}}},
                    TableCase{"quoted", "f,x\n\"1.5\",\"2\"\n", {{1.5}, {2}}},
                    TableCase{"quoted_decimal_comma", "f,x\n\"1,5\",\"2,5\"\n", {{1.5}, {2.5}}},
                    TableCase{"spaces", "f , x\n 1 ,  2 \n", {{1}, {2}}},
                    TableCase{"plus_signs", "f,x\n+1,+.5\n", {{1}, {0.5}}},
                    TableCase{"blank_lines_at_the_end", "f,x\n1,2\n\n  \r\n\n", {{1}, {2}}},
                    TableCase{"blank_line_under_the_header", "f,x\n\n1,2\n", {{1}, {2}}},
                    TableCase{"comments", "# a\nf,x\n# b,c\n1,2\n  # d\n3,4\n#", {{1, 3}, {2, 4}}},
                    TableCase{"no_header",
                              "\xEF\xBB\xBF"
                              "1,2\n3,4\n",
                              {{1, 3}, {2, 4}}},
                    TableCase{"one_column", "f\n1\n2\n", {{1, 2}}}),
    [](const auto& one) { return one.param.what; });

TEST(CsvReader, ColumnsThatAreNotAskedForMayHoldAnything) {
  const std::string text = "when,f,note\n12:00,1,\"a, b\"\n12:01,2,\n,3,nan\n";
  EXPECT_EQ(read(text, {1}).values, (Columns{{1, 2, 3}}));
}

TEST(CsvReader, ColumnsComeInTheOrderAskedFor) {
  EXPECT_EQ(read("a,b,c\n1,2,3\n", {2, 0}).values, (Columns{{3}, {1}}));
}

TEST(CsvReader, KnowsTheLineOfEachRow) {
  const auto landmarks = read("# x\nf\n1\n2\n# y\n# z\n3\n4\n").landmarks;
  EXPECT_EQ(line_of_row(landmarks, 0), 3U);
  EXPECT_EQ(line_of_row(landmarks, 1), 4U);
  EXPECT_EQ(line_of_row(landmarks, 2), 7U);
  EXPECT_EQ(line_of_row(landmarks, 3), 8U);
}

// Against strtod, in all notations that the fast parser might not handle.
TEST(CsvReader, NumbersAreExact) {
  std::mt19937_64 random(7);
  std::string text = "a,b,c\n";
  Columns target(3);
  for (int row = 0; row < 5000; ++row) {
    const double x = std::ldexp(static_cast<double>(random()), static_cast<int>(random() % 160) - 120);
    const std::string fields[] = {fmt::format("{}", x), fmt::format("{:.6f}", x / 1e9),
                                  fmt::format("{:.9g}", -x)};
    for (std::size_t k = 0; k < 3; ++k) target[k].push_back(std::strtod(fields[k].c_str(), nullptr));
    text += fields[0] + "," + fields[1] + "," + fields[2] + "\n";
  }
  EXPECT_EQ(read(text, {}, 4093).values, target);
}

// Plain rows of every length and sign, between rows that need the slow parser.
TEST(CsvReader, TheQuickWayAndTheSlowOneAgree) {
  std::mt19937_64 random(11);
  for (const char* mark : {".", ","}) {
    std::string text = "a;b;c\n";
    Columns target(3);
    for (int row = 0; row < 3000; ++row) {
      for (auto& column : target) {
        std::string digits = std::to_string(random() >> random() % 64);
        if (random() % 4 != 0) digits.insert(random() % (digits.size() + 1), ".");
        if (random() % 3 == 0) digits.insert(0, "-");
        if (random() % 50 == 0) digits += "e-7";
        column.push_back(std::strtod(digits.c_str(), nullptr));
        if (const auto point = digits.find('.'); point != std::string::npos) digits.replace(point, 1, mark);
        const char* const quote = random() % 40 == 0 ? "\"" : "";
        text += quote + digits + quote + (&column == &target[2] ? "" : ";");
      }
      text += random() % 2 == 0 ? "\r\n" : "\n";
      if (random() % 100 == 0) text += "# a comment\n";
    }
    for (const std::size_t piece : {1 << 20, 4093, 100})
      EXPECT_EQ(read(text, {}, piece).values, target) << mark;
    EXPECT_EQ(read(text, {2}, 777).values, Columns{target[2]}) << mark;
  }
}

TEST(CsvReader, RowsCanBeDroppedOnTheWay) {
  const std::string text = "f\n1\n2\n# c\n3\n4\n5\n6\n7\n8\n";
  const auto layout = find_csv_layout(text, true, "t.csv");
  CsvReader reader(*layout, {0}, "t.csv");
  ASSERT_TRUE(reader.feed(std::string_view(text).substr(layout->data_offset, 10)));
  EXPECT_EQ(reader.first_row(), 0U);
  EXPECT_EQ(reader.rows().size(), 3U);
  reader.drop_rows();
  ASSERT_TRUE(reader.feed(std::string_view(text).substr(layout->data_offset + 10)));
  EXPECT_EQ(reader.first_row(), 3U);
  EXPECT_EQ(std::vector<double>(reader.rows().begin(), reader.rows().end()),
            (std::vector<double>{4, 5, 6, 7, 8}));
  EXPECT_EQ(line_of_row(reader.landmarks(), 3), 6U);
  EXPECT_EQ(line_of_row(reader.landmarks(), 1), 3U);  // some rows back
}

}  // namespace
}  // namespace tacto::capture
