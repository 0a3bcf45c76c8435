// SPDX-License-Identifier: GPL-3.0-or-later
// Each stored format and protocol: another major version is refused, a newer minor one is read and noted.
#include "data-schema/base/format_version.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "data-schema/base/sha256.hpp"
#include "data-schema/control/control.hpp"
#include "data-schema/experiment/journal.hpp"
#include "data-schema/files/embedded_files.hpp"
#include "data-schema/height/height_map.hpp"
#include "data-schema/json/json_document.hpp"
#include "data-schema/session/session_netcdf.hpp"
#include "data-schema/spectrogram/netcdf_file.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"
#include "tests/data-schema/temporary_folder.hpp"
#include "tests/data-schema/texts.hpp"

namespace tacto::schema {
namespace {

// A format: `read` reads a file or line of that version, whose other content may be wrong.
struct Format {
  std::string name;
  std::function<std::optional<ErrorKind>(const std::string& version)> read;
};

template <class Value>
std::optional<ErrorKind> kind_of_error(const Result<Value>& read) {
  return read ? std::nullopt : std::optional(read.error().kind);
}

std::vector<Format> json_formats() {
  std::vector<Format> formats;
  const nlohmann::json::json_pointer kind_of("/properties/kind/const");
  for (const EmbeddedFile& file : embedded_files()) {
    if (!file.name.ends_with(".schema.json")) continue;
    const auto schema = nlohmann::json::parse(file.content);
    if (!schema.contains(kind_of)) continue;
    const std::string kind = schema[kind_of];
    formats.push_back({kind, [kind](const std::string& version) {
                         const nlohmann::json document = {{"kind", kind}, {"version", version}};
                         return kind_of_error(parse_document(document.dump(), kind, kind));
                       }});
  }
  return formats;
}

template <class Read>
Format netcdf_format(const std::string& kind, const std::string& path, Read read) {
  return {path, [=](const std::string& version) {
            {
              NetcdfWriter file(path);
              file.attribute("kind", kind);
              file.attribute("version", version);
              EXPECT_TRUE(file.close(path));
            }
            return kind_of_error(read(path));
          }};
}

Format journal_format() {
  return {"journal", [](const std::string& version) {
            const std::string line = journal_line(RunPlanned{"lab", "P01", "", "", "none", "", "", ""}, 1);
            const std::string other =
                replaced(line.substr(0, line.find(R"(,"check")")) + "}", R"("version":"1.0")",
                         fmt::format(R"("version":"{}")", version));
            const std::string sum = sha256_of(other).substr(0, 16);
            return kind_of_error(parse_journal(
                fmt::format("{},\"check\":\"{}\"}}\n", other.substr(0, other.size() - 1), sum), "journal"));
          }};
}

Format control_format() {
  return {"the client", [](const std::string& version) {
            return kind_of_error(
                parse_control_request(fmt::format(R"({{"request":"hello","version":"{}"}})", version)));
          }};
}

std::vector<std::string> noted(const std::string& version) {
  std::vector<std::string> files;
  for (const NewerVersion& each : newer_versions())
    if (each.version == version) files.push_back(each.file);
  return files;
}

TEST(FormatVersion, OfEachFormatIsJudgedBeforeItsContent) {
  const tests::TemporaryFolder folder;
  std::vector<Format> formats = json_formats();
  EXPECT_GT(formats.size(), 15U);
  formats.push_back(netcdf_format("spectrogram", folder / "spectrogram.nc",
                                  [](const std::string& path) { return read_spectrogram_nc(path); }));
  formats.push_back(netcdf_format("height_map", folder / "map.height.nc",
                                  [](const std::string& path) { return read_height_map(path); }));
  formats.push_back(netcdf_format("session", folder / "session.nc",
                                  [](const std::string& path) { return read_session_table(path); }));
  formats.push_back(journal_format());
  formats.push_back(control_format());
  for (const Format& format : formats) {
    EXPECT_EQ(format.read("2.0"), ErrorKind::unsupported_version) << format.name;
    EXPECT_EQ(format.read("0.1"), ErrorKind::unsupported_version) << format.name;
    EXPECT_EQ(format.read("one"), ErrorKind::malformed) << format.name;
    EXPECT_NE(format.read("1.0"), ErrorKind::unsupported_version) << format.name;
    EXPECT_NE(format.read("1.73"), ErrorKind::unsupported_version) << format.name;
    EXPECT_NE(format.read("1.73"), ErrorKind::unsupported_version) << format.name;
    EXPECT_EQ(noted("1.73").size(), 1 + static_cast<std::size_t>(&format - formats.data())) << format.name;
    EXPECT_EQ(noted("1.73").back(), format.name);
  }
  EXPECT_TRUE(noted("1.0").empty());
}

}  // namespace
}  // namespace tacto::schema
