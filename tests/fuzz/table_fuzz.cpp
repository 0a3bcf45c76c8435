// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as a table or as a profile's XML for import. An import gives a valid recording or leaves no
// files.
#include "capture/import/height_profile.hpp"
#include "capture/import/import.hpp"
#include "data-schema/check/check.hpp"
#include "data-schema/kinds/file_kind.hpp"
#include "tests/fuzz/fuzzed_file.hpp"

using namespace tacto;

namespace {

const auto kQuiet = [](double) {};

void import(capture::ImportRequest request) {
  request.name = (std::filesystem::path(request.file).parent_path() / "made").string();
  const bool profile = capture::is_profile_request(request);
  const bool made = profile ? capture::import_profile(request, kQuiet).has_value()
                            : capture::import_file(request, kQuiet).has_value();
  const auto files = schema::stored_files(request.name);
  tests::demand(made == files.has_value());
  if (!made) return;
  for (const auto& file : *files) {
    const auto checked = schema::check_file(file);
    tests::demand(checked && checked->findings.empty());
  }
}

}  // namespace

// The first byte selects the format of the rest.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const bool xml = (data[0] & 1) != 0, timed = (data[0] & 2) != 0;
  capture::ImportRequest request;
  request.file = tests::fuzzed_file(xml ? "x.xml" : "x.csv", data + 1, size - 1);
  if (xml) return import(request), 0;
  request.channels = {"tangential_force=2*0.5N", "position=3*1um+2um"};
  if (timed)
    request.time_column = "1*1s";
  else
    request.rate_hz = 1000;
  import(request);
  return 0;
}
