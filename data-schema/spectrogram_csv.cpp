// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cstdio>
#include <iterator>
#include <memory>

#include "data-schema/files.hpp"
#include "data-schema/spectrogram_axes.hpp"

namespace tacto::schema {
namespace {

using Buffer = fmt::memory_buffer;
using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

// Nine digits drop the noise of rounding ("0.30000000000000004") and keep picometres on a metre.
void append_axis(Buffer& row, double value) {
  fmt::format_to(std::back_inserter(row), "{:.9g}", value);
}

void append_header(Buffer& row, const Spectrogram& spectrogram, bool several) {
  fmt::format_to(std::back_inserter(row), "{}position_mm", several ? "stroke," : "");
  for (std::size_t k = 0; k < spectrogram.bins; ++k) {
    fmt::format_to(std::back_inserter(row), ",{} at ", density_unit(spectrogram.unit));
    append_axis(row, spectrogram.frequency_per_m(k) / kMillimetres);
    fmt::format_to(std::back_inserter(row), "/mm");
  }
  row.push_back('\n');
}

void append_row(Buffer& row, const Spectrogram& spectrogram, std::size_t p) {
  append_axis(row, spectrogram.position_m[p] * kMillimetres);
  for (std::size_t k = 0; k < spectrogram.bins; ++k)
    fmt::format_to(std::back_inserter(row), ",{}", spectrogram.at(p, k) * static_cast<float>(kMillimetres));
  row.push_back('\n');
}

bool flush(Buffer& row, std::FILE* file) {
  const bool written = std::fwrite(row.data(), 1, row.size(), file) == row.size();
  row.clear();
  return written;
}

bool write_rows(std::FILE* file, const Spectrogram& spectrogram, std::size_t stroke) {
  Buffer row;
  for (std::size_t p = 0; p < spectrogram.position_m.size(); ++p) {
    if (stroke != 0) fmt::format_to(std::back_inserter(row), "{},", stroke);
    append_row(row, spectrogram, p);
    if (!flush(row, file)) return false;
  }
  return true;
}

bool write_table(std::FILE* file, std::span<const Spectrogram> spectrograms) {
  const bool several = spectrograms.size() > 1;
  Buffer row;
  append_header(row, spectrograms.front(), several);
  bool written = flush(row, file);
  for (std::size_t i = 0; written && i < spectrograms.size(); ++i)
    written = write_rows(file, spectrograms[i], several ? i + 1 : 0);
  return written;
}

}  // namespace

Result<void> write_spectrogram_csv(const std::string& path, std::span<const Spectrogram> spectrograms) {
  if (auto fitting = check_axes(spectrograms); !fitting) return fitting;
  PendingFiles pending;
  const auto temporary = pending.add(path);
  if (!temporary) return forward_error(temporary);
  File file(std::fopen(temporary->c_str(), "wb"), &std::fclose);
  if (!file) return fail(Fault::cannot_write, "the file can't be made", path);
  const bool written = write_table(file.get(), spectrograms);
  if (std::fclose(file.release()) != 0 || !written)
    return fail(Fault::cannot_write, "writing stopped half-way", path, "is the disk full?");
  return pending.commit();
}

}  // namespace tacto::schema
