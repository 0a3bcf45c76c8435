// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/table/csv_layout.hpp"

#include <gtest/gtest.h>

#include "capture/table/csv_fields.hpp"
#include "capture/table/text_encoding.hpp"

namespace tacto::capture {
namespace {

using Names = std::vector<std::string>;

CsvLayout layout_of(std::string_view text, bool whole = true) {
  const auto layout = find_csv_layout(text, whole, "t.csv");
  EXPECT_TRUE(layout) << (layout ? "" : schema::message(layout.error()));
  return layout.value_or(CsvLayout{});
}

struct LayoutCase {
  const char* what;
  std::string text;
  char delimiter;
  bool header;
  Names columns;
  std::size_t data_line;
};

class CsvLayouts : public testing::TestWithParam<LayoutCase> {};

TEST_P(CsvLayouts, IsFound) {
  const LayoutCase& target = GetParam();
  const CsvLayout found = layout_of(target.text);
  EXPECT_EQ(found.delimiter, target.delimiter);
  EXPECT_EQ(found.header, target.header);
  EXPECT_EQ(found.columns, target.columns);
  EXPECT_EQ(found.data_line, target.data_line);
}

INSTANTIATE_TEST_SUITE_P(
    All, CsvLayouts,
    testing::Values(
        LayoutCase{"comma", "f,x\n1,2\n", ',', true, {"f", "x"}, 2},
        LayoutCase{"semicolon", "f;x\n1.5;2\n", ';', true, {"f", "x"}, 2},
        LayoutCase{"tab", "f\tx\n1\t2\n", '\t', true, {"f", "x"}, 2},
        LayoutCase{"no_header", "1,2,3\n4,5,6\n", ',', false, {"", "", ""}, 1},
        LayoutCase{"decimal_commas", "0,5;1,5\n0,6;1,6\n", ';', false, {"", ""}, 1},
        LayoutCase{"decimal_commas_under_a_header", "Kraft;Weg\n0,5;1,5\n", ';', true, {"Kraft", "Weg"}, 2},
        LayoutCase{"tabs_and_decimal_commas", "0,5\t1,5\t2\n0,6\t1,6\t2\n", '\t', false, {"", "", ""}, 1},
        LayoutCase{
            "comma_in_a_unit", "t;F [N, raw];x\n1;2;3\n4;5;6\n", ';', true, {"t", "F [N, raw]", "x"}, 2},
        LayoutCase{"quotes", "\"F, left\",\" x \"\n1,2\n", ',', true, {"F, left", "x"}, 2},
        LayoutCase{"doubled_quotes", "\"3\"\" disk\",x\n1,2\n", ',', true, {"3\" disk", "x"}, 2},
        LayoutCase{"byte_order_mark",
                   "\xEF\xBB\xBF"
                   "f,x\n1,2\n",
                   ',',
                   true,
                   {"f", "x"},
                   2},
        LayoutCase{"mark_and_no_header",
                   "\xEF\xBB\xBF"
                   "1,2\n",
                   ',',
                   false,
                   {"", ""},
                   1},
        LayoutCase{"latin1",
                   "f,Gr\xF6\xDF"
                   "e\n1,2\n",
                   ',',
                   true,
                   {"f",
                    "Gr\xC3\xB6\xC3\x9F"
                    "e"},
                   2},
        LayoutCase{"utf8",
                   "f,Gr\xC3\xB6\xC3\x9F"
                   "e\n1,2\n",
                   ',',
                   true,
                   {"f",
                    "Gr\xC3\xB6\xC3\x9F"
                    "e"},
                   2},
        LayoutCase{"crlf", "f,x\r\n1,2\r\n", ',', true, {"f", "x"}, 2},
        LayoutCase{"old_mac", "f,x\r1,2\r", ',', true, {"f", "x"}, 2},
        LayoutCase{"comments_and_blanks", "# made by x\n\n# 1,2\nf,x\n1,2\n", ',', true, {"f", "x"}, 5},
        LayoutCase{"one_column", "force\n1\n2\n", ',', true, {"force"}, 2},
        LayoutCase{"nameless_index", ",f,x\n0,1,2\n", ',', true, {"", "f", "x"}, 2},
        LayoutCase{"text_column_without_header", "a,1,2\nb,3,4\n", ',', false, {"", "", ""}, 1},
        LayoutCase{"nan_is_no_name", "nan,1\n2,3\n", ',', false, {"", ""}, 1},
        LayoutCase{"last_line_broken_off", "f\tx\ty\n1\t2\t3\n4\t5\t6\n7", '\t', true, {"f", "x", "y"}, 2}),
    [](const auto& one) { return one.param.what; });

const std::string kRows = "0,1.5,2\n1,2.5,3\n2,3.5,4\n3,4.5,5\n4,5.5,6\n5,6.5,7\n";

struct LateCase {
  const char* what;
  std::string text;
  char delimiter;
  Names columns, units;
  std::size_t header_line, data_line;
};

class LateTables : public testing::TestWithParam<LateCase> {};

TEST_P(LateTables, BeginAfterOtherLines) {
  const LateCase& target = GetParam();
  const CsvLayout found = layout_of(target.text);
  EXPECT_EQ(found.delimiter, target.delimiter);
  EXPECT_EQ(found.columns, target.columns);
  EXPECT_EQ(found.units, target.units);
  EXPECT_EQ(found.header_line, target.header_line);
  EXPECT_EQ(found.data_line, target.data_line);
}

INSTANTIATE_TEST_SUITE_P(
    All, LateTables,
    testing::Values(
        LateCase{"title",
                 "Measurement, 12 March\nby hand\nt,f,x\n" + kRows,
                 ',',
                 {"t", "f", "x"},
                 {"", "", ""},
                 3,
                 4},
        LateCase{"title_without_names",
                 "Measurement of 12 March\nby hand\n" + kRows,
                 ',',
                 {"", "", ""},
                 {"", "", ""},
                 0,
                 3},
        LateCase{"settings",
                 "Rate,1000\nGain,2\nDate,12.03.2024\n\nt,f,x\n\n" + kRows,
                 ',',
                 {"t", "f", "x"},
                 {"", "", ""},
                 5,
                 7},
        LateCase{"units_row", "t,f,x\ns,N,mm\n" + kRows, ',', {"t", "f", "x"}, {"s", "N", "mm"}, 1, 3},
        LateCase{"units_row_in_brackets",
                 "t,f,x\n[s],[N],[counts]\n" + kRows,
                 ',',
                 {"t", "f", "x"},
                 {"[s]", "[N]", "[counts]"},
                 1,
                 3},
        LateCase{
            "units_of_one_and_none", "t,f,x\ns,1,\n" + kRows, ',', {"t", "f", "x"}, {"s", "1", ""}, 1, 3},
        LateCase{"title_and_units_row",
                 "Run 7\nt,f,x\ns,N,mm\n" + kRows,
                 ',',
                 {"t", "f", "x"},
                 {"s", "N", "mm"},
                 2,
                 4},
        LateCase{"german",
                 "Messung vom 12.03.2024\nZeit;Kraft;Weg\ns;N;mm\n0,0;1,5;2\n0,1;1,6;3\n",
                 ';',
                 {"Zeit", "Kraft", "Weg"},
                 {"s", "N", "mm"},
                 2,
                 4},
        LateCase{"times_of_day",
                 "When;Force\n;N\n10:00:01;1,5\n10:00:02;1,6\n",
                 ';',
                 {"When", "Force"},
                 {"", "N"},
                 1,
                 3},
        LateCase{"labview",
                 "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\n***End_of_Header***\t\n\t\n"
                 "Channels\t2\t\t\t\nSamples\t3\t3\t\t\nX0\t0.0\t0.0\t\t\nDelta_X\t0.001\t0.001\t\t\n"
                 "***End_of_Header***\t\t\t\t\nX_Value\tVoltage\tVoltage 1\tComment\n"
                 "0.000\t1.5\t2\n0.001\t1.6\t2\n0.002\t1.7\t2\n",
                 '\t',
                 {"X_Value", "Voltage", "Voltage 1"},
                 {"", "", ""},
                 11,
                 12},
        LateCase{"rows_that_end_with_a_delimiter",
                 "t;f\n0;1;\n1;2;\n2;3;\n",
                 ';',
                 {"t", "f", ""},
                 {"", "", ""},
                 1,
                 2},
        LateCase{"a_broken_row_is_no_title",
                 "Run 7\nt,f,x\n1,2,3\n1,2\n" + kRows,
                 ',',
                 {"t", "f", "x"},
                 {"", "", ""},
                 2,
                 3}),
    [](const auto& one) { return one.param.what; });

TEST(CsvLayout, UnitsMayStandInTheNames) {
  const Names units = {"s", "mN", "mm", "", "counts", "N, raw"};
  EXPECT_EQ(layout_of("Time (s),Force [mN],x / mm,ratio a/b,n (counts),\"F [N, raw]\"\n1,2,3,4,5,6\n").units,
            units);
}

TEST(CsvLayout, RowsOfTheTableAreNeverTakenForATitle) {
  for (const char* text : {"f,x\n1,2\nfoo,bar\n3,4\n5,6\n7,8\n9,10\n11,12\n", "f,x\n1,2\n3,four\n5,6\n",
                           "when,f\n12:00,1\n12:01,four\n12:02,3\n12:03,4\n12:04,5\n12:05,6\n12:06,7\n"})
    EXPECT_EQ(layout_of(text).data_line, 2U) << text;
}

TEST(CsvLayout, LinesAreSkippedWhereThatIsAskedFor) {
  const auto layout = find_csv_layout("1,2\n3,4\nf,x\nN,mm\n5,6\n", true, "t.csv", 2);
  ASSERT_TRUE(layout);
  EXPECT_EQ(layout->columns, (Names{"f", "x"}));
  EXPECT_EQ(layout->units, (Names{"N", "mm"}));
  EXPECT_EQ(layout->data_line, 5U);
  EXPECT_EQ(find_csv_layout("f\n1\n", true, "t.csv", 3).error().kind, schema::ErrorKind::usage);
}

TEST(CsvLayout, ALineThatIsCutOffIsNotLookedAt) {
  EXPECT_EQ(layout_of("f,x\n1,2\n3", false).columns, (Names{"f", "x"}));
  EXPECT_EQ(layout_of("f,x\n1,2\n", false).data_offset, 4U);
}

TEST(CsvLayout, Latin1IsReadOnlyWhereUtf8IsNot) {
  EXPECT_TRUE(is_utf8("\xC2\xB5m \xE2\x82\xAC \xF0\x9F\x91\x86"));
  for (const char* text : {"\xB5", "\xC0\xAF", "\xED\xA0\x80", "\xF5\x80\x80\x80", "\xE2\x82", "\xC3("})
    EXPECT_FALSE(is_utf8(text)) << text;
  EXPECT_EQ(to_utf8("\xB5m"), "\xC2\xB5m");
  EXPECT_EQ(to_utf8("\xFF"), "\xC3\xBF");
}

TEST(CsvFields, QuotesGuardDelimiters) {
  EXPECT_EQ(fields_of("a,\"b,c\",d", ','), (Names{"a", "b,c", "d"}));
  EXPECT_EQ(fields_of("a,,", ','), (Names{"a", "", ""}));
  EXPECT_EQ(fields_of("3.5\" disk,x", ','), (Names{"3.5\" disk", "x"}));
  EXPECT_EQ(field_count("\"a,b", ','), 1U);
  EXPECT_EQ(field_count("", ','), 1U);
}

}  // namespace
}  // namespace tacto::capture
