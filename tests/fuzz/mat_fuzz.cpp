// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as a MATLAB file of version 5: its tags. A file that is whole is not whole without its last byte.
#include "data-schema/exchange/mat5_check.hpp"
#include "tests/fuzz/fuzzed_file.hpp"

using namespace tacto;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const bool whole = schema::check_mat5(tests::fuzzed_file("x.mat", data, size)).has_value();
  if (whole) tests::demand(!schema::check_mat5(tests::fuzzed_file("x.mat", data, size - 1)));
  return 0;
}
