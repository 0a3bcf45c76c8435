// SPDX-License-Identifier: GPL-3.0-or-later
// A project's page: if the pictures of one file cannot be drawn, only that file is reported as broken.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/report/project.hpp"
#include "analysis/report/project_readers.hpp"

namespace tacto::analysis {
namespace {

ProjectFile results_file(const std::string& path, std::vector<double> x) {
  ProjectFile file;
  file.path = path;
  file.kind = schema::FileKind::results;
  file.pictures = {{"Drawn of " + path, "x", "y", false, {{"curve", std::move(x), {1, 2, 3}}}}};
  return file;
}

TEST(ReportProject, LeavesOutWhatCannotBeDrawn) {
  Project project{"study", {results_file("study/a", {1, 2}), results_file("study/b", {1, 2, 3})}, {}, {}};
  draw_pictures(project);
  ASSERT_EQ(project.files.size(), 1u);
  EXPECT_EQ(project.files.front().path, "study/b");
  ASSERT_EQ(project.broken.size(), 1u);
  EXPECT_EQ(project.broken.front().path, "study/a");
  EXPECT_NE(project.broken.front().error.where.find("study/a"), std::string::npos);
  const std::string page = project_page(project);
  EXPECT_NE(page.find("Drawn of study/b"), std::string::npos);
  EXPECT_NE(page.find("x and y differ in length"), std::string::npos);
  EXPECT_NE(page.find("<a href=\"#file-1\">b</a>"), std::string::npos) << "the table leads to the section";
  EXPECT_NE(page.find("<h2 id=\"file-1\">"), std::string::npos);
}

// A twentieth of a recording at a larger amplitude is an onset, not a spike: no gap, and no words in the
// title. A spike is a gap, not a flat line at the end of the axis, and the title has its value.
TEST(ReportProject, AnOnsetIsShownWhole) {
  constexpr int kSamples = 20'000;
  for (const int loud : {1, kSamples / 20}) {
    Envelope envelope(kSamples);
    for (int i = 0; i < kSamples; ++i) envelope.add(i, (i < loud ? 8000 : 1) * std::cos(0.1 * i));
    const schema::ResultPicture picture = envelope.picture("C-1.json", "time (s)", "force (mN)", "mN");
    const bool whole =
        std::ranges::all_of(picture.curves.front().y, [](double y) { return std::isfinite(y); });
    EXPECT_EQ(whole, loud > 1);
    EXPECT_EQ(std::ranges::all_of(picture.curves.front().y, [](double y) { return !(std::abs(y) > 1); }),
              loud == 1);
    EXPECT_EQ(picture.title.find(" 8000 mN") != std::string::npos, loud == 1) << picture.title;
    EXPECT_EQ(picture.title == "C-1.json", loud > 1) << picture.title;
  }
}

}  // namespace
}  // namespace tacto::analysis
