// SPDX-License-Identifier: GPL-3.0-or-later
// Texts of files that tests change and write.
#pragma once

#include <gtest/gtest.h>

#include <regex>
#include <string>

#include "data-schema/files/files.hpp"

namespace tacto::schema {

/// With the one place of `from` replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// A sidecar as of another program, or to be changed on purpose: without the checksum of its numbers.
inline std::string without_numbers_sum(const std::string& sidecar) {
  return std::regex_replace(sidecar, std::regex(R"(,\s*"numbers_sha256": ?"[0-9a-f]{64}")"), "");
}

inline void write_text(const std::string& path, const std::string& text) {
  PendingFiles files;
  ASSERT_TRUE(files.write(path, text));
  ASSERT_TRUE(files.commit());
}

}  // namespace tacto::schema
