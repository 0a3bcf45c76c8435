// SPDX-License-Identifier: GPL-3.0-or-later
// Real files of other laboratories, if they are available.
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "tests/capture/import_fixture.hpp"

namespace tacto::capture {
namespace {

class ImportRealData : public ImportTest {
 protected:
  std::string data(const std::string& name) const { return std::string(TACTO_DATA) + "/" + name; }
};

#define NEED(file) \
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "skipped: no real data"

// An independent reader: line by line, field by field, strtod.
std::vector<double> plain_column(const std::string& file, std::size_t column) {
  std::ifstream input(file);
  std::string line;
  std::getline(input, line);
  std::vector<double> values;
  while (std::getline(input, line)) {
    std::istringstream fields(line);
    std::string field;
    for (std::size_t i = 0; i <= column; ++i) std::getline(fields, field, ',');
    values.push_back(std::strtod(field.c_str(), nullptr));
  }
  return values;
}

TEST_F(ImportRealData, TheBareFingerIsKeptExactly) {
  const std::string file = data("bare-finger/bare_finger_10kHz.csv");
  NEED(file);
  auto asked = request(file, {"tangential_force=lateral_V*0.444444N", "normal_force=normal_V*-0.31+1.6647N",
                              "position=encoder_count*0.5um"});
  asked.rate_hz = 10000;
  const auto recording = imported(asked);
  EXPECT_EQ(recording.header.frames, 85000U);
  EXPECT_EQ(stored(recording, 0), plain_column(file, 0));
  EXPECT_EQ(stored(recording, 1), plain_column(file, 1));
  EXPECT_EQ(stored(recording, 2), plain_column(file, 4));
  EXPECT_TRUE(recording.header.warnings.empty());
}

// Every column of every good file is imported without a warning: unusual values in them are real.
TEST_F(ImportRealData, RealTransientsAreNoOutliers) {
  const std::string finger = data("bare-finger/bare_finger_10kHz.csv");
  const std::string taps = data("impact-taps/impacts_100kHz.csv");
  NEED(taps);
  EXPECT_TRUE(imported(request(finger, {"a:signal=1", "b:signal=2", "c:signal=3", "d:signal=4"}))
                  .header.warnings.empty());
  auto asked = request(taps, {"tangential_force=lateral_V*1N"});
  asked.replace = true;
  EXPECT_TRUE(imported(asked).header.warnings.empty());
}

// The export lost exponents: one speed is 4581 among values near 100, two are below a tenth of their
// neighbours.
TEST_F(ImportRealData, TheDirtyFilesLostExponentsAreNamed) {
  const std::string file = data("dirty/T1.csv");
  NEED(file);
  const auto header = imported(request(file, {"acceleration=acc*1m/s^2", "normal_force=normal_force_N*1N",
                                              "speed=speed_mm_s*1mm/s"}))
                          .header;
  ASSERT_EQ(header.warnings.size(), 2U);
  EXPECT_NE(header.warnings[0].find("no position was measured"), std::string::npos);
  const std::string& named = header.warnings[1];
  EXPECT_TRUE(named.starts_with("speed: 3 of 10000 samples")) << named;
  EXPECT_NE(named.find("line 4229, 4.227 s"), std::string::npos) << named;
  EXPECT_NE(named.find("line 8943"), std::string::npos) << named;
}

}  // namespace
}  // namespace tacto::capture
