// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/exchange/mat_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::schema {
namespace {

// Both versions hold the same bits; names become MATLAB's, and stay unique.
TEST(MatFile, ComesBackInBothVersions) {
  const tests::TemporaryFolder folder;
  std::vector<double> force_n;
  for (int i = 0; i < 1000; ++i) force_n.push_back(std::sin(i));
  const std::vector<float> cells = {0.1F, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F};
  for (const MatVersion version : {MatVersion::v5, MatVersion::v73}) {
    const std::string path = folder / (version == MatVersion::v5 ? "5.mat" : "73.mat");
    auto mat = MatWriter::create(path, path, version);
    ASSERT_TRUE(mat);
    ASSERT_TRUE(mat->put("force_n", force_n) && mat->put("a b", cells, 2) && mat->put("a-b", cells));
    ASSERT_TRUE(mat->put("provenance", MatMembers{{"program", "x"}, {"empty", ""}, {"gain", 0.1}}));
    ASSERT_TRUE(mat->close());
    const auto contents = mat_contents(path);
    ASSERT_TRUE(contents);
    EXPECT_EQ(contents->format, version == MatVersion::v5 ? "MATLAB 5.0 MAT-file" : "MATLAB 7.3 MAT-file");
    EXPECT_EQ(contents->arrays.size(), 6U);  // three variables and three fields
    std::size_t found = 0;
    for (const MatColumn& column : contents->columns) {
      const auto values = read_mat(path, std::vector{column});
      ASSERT_TRUE(values);
      if (column.name == "force_n") found += (*values)[0] == force_n ? 1 : 100;
      if (column.name == "a_b(:,2)")
        found += (*values)[0] == std::vector<double>(cells.begin() + 3, cells.end()) ? 1 : 100;
      if (column.name == "a_b_2")
        found += (*values)[0] == std::vector<double>(cells.begin(), cells.end()) ? 1 : 100;
    }
    EXPECT_EQ(found, 3U);
  }
}

// MATLAB and matio store lengths of version 5 in 31 bits.
TEST(MatFile, LargeVariablesNeedVersion73) {
  EXPECT_EQ(mat_version_for(std::uint64_t{1} << 30), MatVersion::v5);
  EXPECT_EQ(mat_version_for(std::uint64_t{1} << 31), MatVersion::v73);
}

}  // namespace
}  // namespace tacto::schema
