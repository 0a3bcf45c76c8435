// SPDX-License-Identifier: GPL-3.0-or-later
// Usage: libxdf_samples FILE.xdf STREAM OUT. Reads a stream by Debian's libxdf, for import_xdf_test.py, and
// writes its times (float64) and then each channel (float32, as libxdf keeps all numbers).
#include <xdf.h>

#include <algorithm>
#include <fstream>
#include <span>

namespace {

template <class Number>
void append(std::ofstream& out, std::span<const Number> numbers) {
  out.write(reinterpret_cast<const char*>(numbers.data()),
            static_cast<std::streamsize>(numbers.size_bytes()));
}

}  // namespace

int main(int argc, char** argv) {
  Xdf xdf;
  if (argc != 4 || xdf.load_xdf(argv[1]) != 0) return 1;
  const auto stream =
      std::ranges::find(xdf.streams, argv[2], [](const Xdf::Stream& each) { return each.info.name; });
  if (stream == xdf.streams.end()) return 1;
  std::ofstream out(argv[3], std::ios::binary);
  append(out, std::span<const double>(stream->time_stamps));
  for (const auto& channel : stream->time_series) append(out, std::span<const float>(channel));
  return out.flush() ? 0 : 1;
}
