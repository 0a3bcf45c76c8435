// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/html.hpp"

#include <gtest/gtest.h>

#include "analysis/demo_page.hpp"

namespace tacto::analysis {
namespace {

TEST(Html, TextCannotBecomeMarkup) {
  EXPECT_EQ(escaped("<b>\"A & B\"</b>"), "&lt;b&gt;&quot;A &amp; B&quot;&lt;/b&gt;");
  EXPECT_EQ(html_table({{"a"}, {"<"}}), "<table>\n<tr><th>a</th></tr>\n<tr><td>&lt;</td></tr>\n</table>\n");
}

TEST(Html, BytesThatAreNoTextAreReplaced) {
  EXPECT_EQ(escaped("\u00e4\u2192\U0001F600"), "\u00e4\u2192\U0001F600");
  EXPECT_EQ(escaped("a\xff<\xe2\x86"), "a\uFFFD&lt;\uFFFD\uFFFD");
}

TEST(Html, PicturesAreInside) {
  EXPECT_EQ(inline_svg("<svg/>", "a \"line\""),
            "<img alt=\"a &quot;line&quot;\" src=\"data:image/svg+xml;base64,PHN2Zy8+\">\n");
}

TEST(DemoPage, SaysSimulatedOnEverySurface) {
  DemoSurface surface;
  surface.surface = "X<";
  surface.simulated = "by a test";
  const std::string page = demo_page({surface, surface}, "by a test");
  std::size_t said = 0;
  for (auto at = page.find("simulated: by a test"); at != page.npos;
       at = page.find("simulated: by a test", at + 1))
    ++said;
  EXPECT_EQ(said, 2U);
  EXPECT_EQ(page.find("X<"), page.npos);
}

}  // namespace
}  // namespace tacto::analysis
