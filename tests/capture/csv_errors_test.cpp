// SPDX-License-Identifier: GPL-3.0-or-later
// Every kind of error in a table, reported with its place.
#include <gtest/gtest.h>

#include "tests/capture/read_text.hpp"
#include "tests/faults.hpp"

namespace tacto::capture {
namespace {

struct ErrorCase {
  const char* name;
  std::string text;
  std::string what;   // part of it
  std::string where;  // all of it
};

class CsvErrors : public testing::TestWithParam<ErrorCase> {};

void expect_error(const schema::Result<ReadText>& table, const ErrorCase& target) {
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().kind, schema::ErrorKind::malformed);
  EXPECT_NE(table.error().what.find(target.what), std::string::npos) << table.error().what;
  EXPECT_EQ(table.error().where, target.where);
  EXPECT_EQ(schema::message(table.error()).find('\n'), std::string::npos);
}

TEST_P(CsvErrors, SayWhatAndWhere) {
  for (const std::size_t piece : {1UL << 20, 1UL, 3UL})
    expect_error(read_text(GetParam().text, {}, piece), GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    All, CsvErrors,
    testing::Values(
        ErrorCase{"empty", "", "is empty", "t.csv"},
        ErrorCase{"only_a_mark", "\xEF\xBB\xBF", "is empty", "t.csv"},
        ErrorCase{"only_blanks", "\n \n\n", "contains no data", "t.csv"},
        ErrorCase{"only_comments", "# a\n# b\n", "contains no data", "t.csv"},
        ErrorCase{"header_only", "f,x\n", "a header but no data", "t.csv: line 1"},
        ErrorCase{"header_only_after_comments", "# a\n\nf,x", "a header but no data", "t.csv: line 3"},
        ErrorCase{"too_few", "f,x\n1,2\n3\n4,5\n", "has 1 field instead of 2", "t.csv: line 3"},
        ErrorCase{"too_many", "f,x\n1,2\n3,4,5\n4,5\n", "has 3 fields instead of 2", "t.csv: line 3"},
        ErrorCase{"too_few_at_the_end", "f,x,y\n1,2,3\n1,2", "has 2 fields instead of 3", "t.csv: line 3"},
        ErrorCase{"broken_off_in_a_number", "f,x\n1,2\n3,\n", "has no value",
                  "t.csv: line 3, column 2 ('x')"},
        ErrorCase{"text", "f,x\n1,2\n3,four\n", "'four' is not a number", "t.csv: line 3, column 2 ('x')"},
        ErrorCase{"text_in_latin1", "f,x\n1,2\n3,\xE4\n", "'\xC3\xA4' is not a number",
                  "t.csv: line 3, column 2 ('x')"},
        ErrorCase{"unit_in_a_field", "f,x\r\n1,2\r\n3N,4\r\n", "'3N' is not a number",
                  "t.csv: line 3, column 1 ('f')"},
        ErrorCase{"thousands", "f;x\n1,5;2\n1.234,5;4\n", "'1.234,5' is not a number",
                  "t.csv: line 3, column 1 ('f')"},
        ErrorCase{"nan", "f,x\n1,2\nNaN,4\n", "is NaN", "t.csv: line 3, column 1 ('f')"},
        ErrorCase{"windows_nan", "f,x\n1,2\n1.#QNAN,4\n", "is NaN", "t.csv: line 3, column 1 ('f')"},
        ErrorCase{"inf", "f,x\n1,2\n3,-inf\n", "is infinite", "t.csv: line 3, column 2 ('x')"},
        ErrorCase{"nan_without_header", "1,nan\n2,3\n", "is NaN", "t.csv: line 1, column 2"},
        ErrorCase{"missing", "f,x\n1,2\n,4\n", "has no value", "t.csv: line 3, column 1 ('f')"},
        ErrorCase{"missing_in_quotes", "f,x\n1,2\n\" \",4\n", "has no value",
                  "t.csv: line 3, column 1 ('f')"},
        ErrorCase{"all_missing", "f,x\n1,2\n,\n", "has no value", "t.csv: line 3, column 1 ('f')"},
        ErrorCase{"too_large", "f,x\n1,2\n3,1e400\n", "too large for a number",
                  "t.csv: line 3, column 2 ('x')"},
        ErrorCase{"other_mark", "f;x\n1,5;2\n3.5;4\n", "another decimal mark",
                  "t.csv: line 3, column 1 ('f')"},
        ErrorCase{"open_quote", "f,x\n1,2\n\"3,4\n", "has 1 field instead of 2", "t.csv: line 3"},
        ErrorCase{"open_quote_at_the_end", "f,x\n1,2\n3,\"4\n", "'\"4' is not a number",
                  "t.csv: line 3, column 2 ('x')"},
        ErrorCase{"blank_line_among_rows", "f,x\n1,2\n\n3,4\n", "is blank", "t.csv: line 3"},
        ErrorCase{"blank_lines_among_rows", "f,x\n1,2\n# c\n\n\n3,4\n", "is blank", "t.csv: line 4"},
        ErrorCase{"line_counts_comments", "# a\n\nf,x\n1,2\n# b\n3,four\n", "four",
                  "t.csv: line 6, column 2 ('x')"},
        ErrorCase{"old_mac", "f,x\r1,2\r3,four\r", "four", "t.csv: line 3, column 2 ('x')"},
        ErrorCase{"text_alone", "a line\nand another\n\nno table\n", "contains no numbers there",
                  "t.csv: lines 1 to 4"},
        ErrorCase{"blanks_between", "t f\n 0.0  1.5\n 0.1  1.6\n", "has spaces between its columns",
                  "t.csv: lines 1 to 3"},
        ErrorCase{"name_among_numbers", "1,two,3\n1,2,3\n", "'two' is a name among numbers",
                  "t.csv: line 1, column 2"},
        ErrorCase{"utf16",
                  std::string("\xFF\xFE"
                              "f\0,\0",
                              6),
                  "is UTF-16", "t.csv"},
        ErrorCase{"zero_byte", std::string("f,x\n1,\0\n", 8), "zero byte at 6", "t.csv"},
        ErrorCase{"long_field", "f\n1\n" + std::string(500, 'z') + "\n",
                  std::string(40, 'z') + "...' is not a number", "t.csv: line 3, column 1 ('f')"}),
    [](const auto& one) { return one.param.name; });

TEST(CsvErrors, AHeaderWhoseRowsAreAllCommentsHasNoRow) {
  const auto layout = find_csv_layout("f,x\n# a\n", false, "t.csv");
  ASSERT_TRUE(layout);
  CsvReader reader(*layout, {0}, "t.csv");
  ASSERT_TRUE(reader.feed("# a\n"));
  EXPECT_TRUE(tests::fails(reader.finish(), schema::ErrorKind::malformed, "t.csv"));
}

// Of a file that ends within a row the rows before it can be had.
TEST(CsvErrors, AFileThatWasCutShortSaysHowManyRowsAreWhole) {
  for (const char* text : {"f,x\n1,2\n3,4\n5,6\n7", "f,x\n1,2\n3,4\n5,6\n7,-"}) {
    const auto table = read_text(text, {}, 1UL << 20);
    ASSERT_FALSE(table);
    EXPECT_EQ(table.error().where.substr(0, 13), "t.csv: line 5");
    EXPECT_NE(table.error().remedy.find(" 3 rows"), std::string::npos) << table.error().remedy;
  }
  const auto within = read_text("f,x\n1,2\n3\n5,6\n", {}, 1UL << 20);
  ASSERT_FALSE(within);
  EXPECT_EQ(within.error().remedy.find("rows before"), std::string::npos) << within.error().remedy;
}

TEST(CsvErrors, ALongFirstLineIsNoTable) {
  const auto layout = find_csv_layout("1,2,3", false, "t.csv");
  EXPECT_TRUE(tests::fails(layout, schema::ErrorKind::malformed, "t.csv"));
}

}  // namespace
}  // namespace tacto::capture
