// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/cli/spectrogram_files.hpp"

#include "spatial/picture/spectrogram_output.hpp"

namespace tacto::spatial {

using schema::Result;

Result<void> SpectrogramFiles::open(std::span<const std::string> paths, bool several, bool compress) {
  for (const std::string& path : paths) {
    const OutputForm form = form_of(path);
    if (form == OutputForm::picture) {
      pictures_.push_back(path);
      continue;
    }
    const auto temporary = pending_.add(path);
    TACTO_TRY(temporary);
    const auto open = form == OutputForm::netcdf ? schema::open_spectrogram_nc : schema::open_spectrogram_csv;
    auto writer = open(*temporary, {several, compress, path});
    TACTO_TRY(writer);
    writers_.push_back(std::move(*writer));
  }
  return {};
}

Result<void> SpectrogramFiles::begin(const schema::SpectrogramHeader& header) {
  for (const auto& writer : writers_)
    if (auto begun = writer->begin(header); !begun) return begun;
  return {};
}

Result<void> SpectrogramFiles::rows(std::size_t first, std::span<const float> cells) {
  for (const auto& writer : writers_)
    if (auto written = writer->rows(first, cells); !written) return written;
  return {};
}

Result<void> SpectrogramFiles::finish(const Figure* figure, schema::Existing existing) {
  for (const auto& writer : writers_)
    if (auto closed = writer->close(); !closed) return closed;
  writers_.clear();
  for (const std::string& path : pictures_)
    if (auto added = add_figure(pending_, path, *figure); !added) return added;
  return pending_.commit(existing);
}

}  // namespace tacto::spatial
