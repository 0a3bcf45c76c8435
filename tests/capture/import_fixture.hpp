// SPDX-License-Identifier: GPL-3.0-or-later
// Imports in a temporary folder.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "capture/import/import.hpp"
#include "data-schema/recording/recording.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::capture {

class ImportTest : public testing::Test {
 protected:
  std::string write(const std::string& name, std::string_view text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  ImportRequest request(const std::string& file, std::vector<std::string> channels = {}) const {
    ImportRequest made;
    made.file = file;
    made.name = folder_ / "out";
    made.channels = std::move(channels);
    if (file.ends_with(".csv")) made.rate_hz = 1000;
    return made;
  }

  static schema::Result<Imported> import(const ImportRequest& request) {
    return import_file(request, [](double) {});
  }

  /// The recording on disk after an import that must succeed.
  schema::Recording imported(const ImportRequest& request) const {
    const auto done = import(request);
    EXPECT_TRUE(done) << (done ? "" : schema::message(done.error()));
    const auto opened = schema::open_recording(request.name);
    EXPECT_TRUE(opened) << (opened ? "" : schema::message(opened.error()));
    return opened.value_or(schema::Recording{});
  }

  static std::vector<double> stored(const schema::Recording& recording, std::size_t channel) {
    return schema::read_stored(recording, channel).value_or(std::vector<double>{});
  }

  tests::TemporaryFolder folder_;
};

}  // namespace tacto::capture
