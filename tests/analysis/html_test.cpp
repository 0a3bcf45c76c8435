// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/page/html.hpp"

#include <gtest/gtest.h>

namespace tacto::analysis {
namespace {

TEST(Html, ANumberAndItsUnitDoNotBreakApart) {
  EXPECT_EQ(escaped("2.8 um, 15 um/V at 2 1/mm"), "2.8&nbsp;\u00B5m, 15&nbsp;\u00B5m/V at 2&nbsp;1/mm");
  EXPECT_EQ(with_micro_signs("filter 12 um (knee), 3 us; number 4 umbra; 5 m, um"),
            "filter 12 \u00B5m (knee), 3 \u00B5s; number 4 umbra; 5 m, um");
  EXPECT_EQ(escaped("5 %; 3 strokes; take 2 mumble; 7 m"), "5&nbsp;%; 3 strokes; take 2 mumble; 7&nbsp;m");
  EXPECT_EQ(escaped("um 4; p 0.003; step 4"), "um 4; p&nbsp;0.003; step 4");
}

TEST(Html, TextCannotBecomeMarkup) {
  EXPECT_EQ(escaped("<b>\"A & B\"</b>"), "&lt;b&gt;&quot;A &amp; B&quot;&lt;/b&gt;");
  EXPECT_EQ(html_table({{"a"}, {"<"}}),
            "<table>\n<thead><tr><th>a</th></tr></thead>\n<tbody>\n"
            "<tr><td data-label=\"a\">&lt;</td></tr>\n</tbody></table>\n");
}

TEST(Html, BytesThatAreNoTextAreReplaced) {
  EXPECT_EQ(escaped("\u00e4\u2192\U0001F600"), "\u00e4\u2192\U0001F600");
  EXPECT_EQ(escaped("a\xff<\xe2\x86"), "a\uFFFD&lt;\uFFFD\uFFFD");
}

TEST(Html, PicturesAreInside) {
  EXPECT_EQ(inline_svg("<svg/>", "a \"line\""),
            "<div class=\"picture\"><img alt=\"a &quot;line&quot;\" "
            "src=\"data:image/svg+xml,%3Csvg/%3E\"></div>\n");
  EXPECT_NE(inline_svg("<a b=\"#1\">50 %\u00b5</a>", "").find("%3Ca b=%22%231%22%3E50 %25%C2%B5%3C/a%3E"),
            std::string::npos);
}

std::size_t count_of(std::string_view words, std::string_view text) {
  std::size_t count = 0;
  for (auto at = text.find(words); at != text.npos; at = text.find(words, at + 1)) ++count;
  return count;
}

// A column needs its header and its cell: neither can be declared alone.
static_assert(std::is_constructible_v<Column<int>, std::string, std::string (*)(const int&)>);
static_assert(!std::is_constructible_v<Column<int>, std::string>);
static_assert(!std::is_constructible_v<Column<int>, std::string (*)(const int&)>);
static_assert(!std::is_constructible_v<Column<int>, std::string, std::string>);
static_assert(!std::is_default_constructible_v<Column<int>>);

TEST(Html, ATableHasAHeaderForEachCell) {
  const std::vector<int> rows = {7, 8};
  const std::string table = html_table(rows, {{"number", [](int n) { return std::to_string(n); }},
                                              {"square", [](int n) { return std::to_string(n * n); }}});
  EXPECT_EQ(count_of("<th>", table), 2U);
  EXPECT_NE(table.find("<td data-label=\"number\">8</td><td data-label=\"square\">64</td>"),
            std::string::npos);
}

TEST(Html, RowsOfAnotherSizeThanTheHeadMakeNoTable) {
  EXPECT_THROW(html_table({{"a"}, {"1", "2"}}), std::logic_error);
  EXPECT_THROW(html_table({{"a", "b"}, {"1"}}), std::logic_error);
}

TEST(Html, APageHoldsNoAddress) {
  EXPECT_EQ(inline_svg("<svg xmlns=\"http://www.w3.org/2000/svg\"/>", "").find("http"), std::string::npos);
}

TEST(Html, LongTablesFoldAndLongWordsWrap) {
  EXPECT_EQ(folded("all <rows>", "<table></table>\n"),
            "<details><summary>all &lt;rows&gt;</summary>\n<table></table>\n</details>\n");
  const std::string table =
      html_table(std::vector<std::string>{std::string(60, 'x')}, {{"a", [](const auto& x) { return x; }}});
  EXPECT_NE(table.find("<td class=\"long text\""), std::string::npos);
  EXPECT_EQ(table.find("word"), std::string::npos);  // only short words do not wrap
}

// A sentence and a word in one column begin at one edge; a date is on one line.
TEST(Html, AColumnIsAlignedAsAWhole) {
  const std::vector<std::string> cells = {"2026-11-28", std::string(50, ' ') + "x"};
  const std::string table = html_table(cells, {{"a", [](const auto& x) { return x; }}});
  EXPECT_NE(table.find("<td class=\"word text\" data-label=\"a\">2026-11-28"), std::string::npos) << table;
  EXPECT_EQ(count_of("text\"", table), 3U) << table;  // with the head
  const std::string uri = html_table(std::vector<std::string>{"sim:surface=C,speed=50mm/s,seed=1"},
                                     {{"a", [](const auto& x) { return x; }}});
  EXPECT_NE(uri.find("C,<wbr>speed=50mm/s,<wbr>seed"), std::string::npos) << uri;
}

}  // namespace
}  // namespace tacto::analysis
