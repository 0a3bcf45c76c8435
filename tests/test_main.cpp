// SPDX-License-Identifier: GPL-3.0-or-later
// PROGRAM [FILE...] [--gtest_...] : runs the cases that these files define (`playback_tests
// scene_kernel_test`), without a file all. GoogleTest knows the file of each case, so that none is outside of
// the ctest entries, which are one a file.
#include <gtest/gtest.h>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

namespace {

/// GoogleTest's filter for the cases of a file, each followed by a colon.
std::string cases_of(const std::string& file) {
  std::string cases;
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int suite = 0; suite < all.total_test_suite_count(); ++suite) {
    for (int i = 0; i < all.GetTestSuite(suite)->total_test_count(); ++i) {
      const testing::TestInfo& test = *all.GetTestSuite(suite)->GetTestInfo(i);
      if (std::filesystem::path(test.file()).stem() == file) {
        cases += std::string(test.test_suite_name()) + "." + test.name() + ":";
      }
    }
  }
  return cases;
}

}  // namespace

int main(int count, char** words) {
  testing::InitGoogleTest(&count, words);
  std::string filter;
  for (const std::string& file : std::vector<std::string>(words + 1, words + count)) {
    const std::string cases = cases_of(file);
    if (cases.empty()) {
      std::cerr << "no test case in " << file << ".cpp\n";
      return 1;
    }
    filter += cases;
  }
  if (!filter.empty()) {
    GTEST_FLAG_SET(filter, filter);
  }
  return RUN_ALL_TESTS();
}
