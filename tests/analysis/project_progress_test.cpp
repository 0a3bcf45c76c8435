// SPDX-License-Identifier: GPL-3.0-or-later
// A folder's files are read one after the other; the progress also covers the part of a file.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/report/project.hpp"
#include "data-schema/texture/texture.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::analysis {
namespace {

TEST(Project, WhoWaitsHearsHowFarItIs) {
  const tests::TemporaryFolder folder;
  schema::Texture texture;
  texture.signal = {10e-6, 0, std::vector<double>(100'000)};
  for (std::size_t i = 0; i < texture.signal.values.size(); ++i)
    texture.signal.values[i] = std::sin(0.1 * static_cast<double>(i));
  ASSERT_TRUE(schema::write_texture(folder / "one", texture));
  ASSERT_TRUE(schema::write_texture(folder / "two", texture));
  std::vector<double> heard;
  const auto project =
      read_project(folder / "", folder / "page.html", [&](double part) { heard.push_back(part); });
  ASSERT_TRUE(project) << schema::message(project.error());
  ASSERT_EQ(project->files.size(), 2U);
  EXPECT_TRUE(std::ranges::is_sorted(heard));
  EXPECT_TRUE(std::ranges::any_of(heard, [](double part) { return part > 0 && part < 0.25; }))
      << "within the first file";
  ASSERT_FALSE(heard.empty());
  EXPECT_EQ(heard.back(), 1);
}

}  // namespace
}  // namespace tacto::analysis
