// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/control/daemon_config.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::schema {
namespace {

Error refused(const std::string& members) {
  tests::TemporaryFolder folder;
  const std::string path = folder / "d.json";
  std::ofstream(path) << R"({"kind":"daemon","version":"1.0","device":"sim:","transducer":"t",)"
                      << R"("socket":"s","sessions":"f",)" << members << "}";
  const auto config = read_daemon_config(path);
  return config ? Error{} : config.error();
}

TEST(DaemonConfig, TwoPromisesExcludeEachOther) {
  const Error error = refused(R"("quality":"fast","max_error":0.01)");
  EXPECT_EQ(error.kind, ErrorKind::malformed);
  for (const char* member : {"quality", "max_error"}) EXPECT_NE(error.what.find(member), std::string::npos);
}

TEST(DaemonConfig, ANumberOutOfRangeIsToldItsRange) {
  for (const char* rate : {R"("rate_hz":500)", R"("rate_hz":"fast")"}) {
    const Error error = refused(rate);
    EXPECT_TRUE(error.where.ends_with("#/rate_hz")) << error.where;
    EXPECT_TRUE(error.remedy.ends_with("from 1000 to 20000")) << schema::message(error);
  }
  EXPECT_TRUE(refused(R"("max_error":0)").remedy.ends_with("above 0 to 0.1"));
}

TEST(DaemonConfig, AllMissingMembersAreNamedAtOnce) {
  const tests::TemporaryFolder folder;
  std::ofstream(folder / "d.json") << R"({"kind":"daemon","version":"1.0","transducer":"t"})";
  const auto config = read_daemon_config(folder / "d.json");
  ASSERT_FALSE(config);
  for (const char* member : {"'device'", "'socket'", "'sessions'"})
    EXPECT_NE(config.error().what.find(member), std::string::npos) << config.error().what;
  EXPECT_EQ(config.error().what.find("'transducer'"), std::string::npos) << config.error().what;
}

TEST(DaemonConfig, AMisspeltChoiceIsNamedWithTheNearest) {
  EXPECT_NE(refused(R"("playback":{"contact_on":1})").remedy.find("'contact_on_n'"), std::string::npos);
  EXPECT_NE(refused(R"("rate_Hz":2000)").remedy.find("'rate_hz'"), std::string::npos);
}

}  // namespace
}  // namespace tacto::schema
