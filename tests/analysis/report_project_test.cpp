// SPDX-License-Identifier: GPL-3.0-or-later
// A project's page: if the pictures of one file cannot be drawn, only that file is reported as broken.
#include <gtest/gtest.h>

#include "analysis/report/project.hpp"

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
}

}  // namespace
}  // namespace tacto::analysis
