// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/spectrogram/spectrogram_writer.hpp"

#include "data-schema/files/files.hpp"

namespace tacto::schema {
namespace {

using Open = Result<std::unique_ptr<SpectrogramWriter>> (*)(const std::string&,
                                                            const SpectrogramFileOptions&);

Result<void> write_each(SpectrogramWriter& writer, std::span<const Spectrogram> spectrograms) {
  for (const Spectrogram& each : spectrograms) {
    if (each.cells.size() != each.position_m.size() * each.bins)
      return fail(ErrorKind::unsuitable, "the spectrogram's cells do not fit its axes", each.name);
    if (auto begun = writer.begin(each); !begun) return begun;
    if (auto written = writer.rows(0, each.cells); !written) return written;
  }
  return writer.close();
}

Result<void> write_whole(Open open, const std::string& path, std::span<const Spectrogram> spectrograms,
                         bool compress) {
  PendingFiles pending;
  const auto temporary = pending.add(path);
  TACTO_TRY(temporary);
  auto writer = open(*temporary, {spectrograms.size() > 1, compress, path});
  TACTO_TRY(writer);
  if (auto written = write_each(**writer, spectrograms); !written) return written;
  return pending.commit();
}

}  // namespace

Result<void> write_spectrogram_nc(const std::string& path, std::span<const Spectrogram> spectrograms,
                                  bool compress) {
  return write_whole(open_spectrogram_nc, path, spectrograms, compress);
}

Result<void> write_spectrogram_csv(const std::string& path, std::span<const Spectrogram> spectrograms) {
  return write_whole(open_spectrogram_csv, path, spectrograms, false);
}

}  // namespace tacto::schema
