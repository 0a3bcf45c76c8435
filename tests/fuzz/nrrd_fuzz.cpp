// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as an NRRD file: as many values as its sizes say.
#include "data-schema/exchange/nrrd_file.hpp"
#include "tests/fuzz/fuzzed_file.hpp"

using namespace tacto;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string path = tests::fuzzed_file("v.nrrd", data, size);
  auto read = schema::read_nrrd(path, 1e-3);
  if (!read) read = schema::read_nrrd(path, {});  // it may state a unit
  if (!read) return 0;
  const auto& [columns, rows, layers] = read->volume.samples;
  tests::demand(read->volume.stored.size() == columns * rows * layers);
  tests::demand(schema::check_volume(read->volume, "v").has_value());
  return 0;
}
