// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <iterator>
#include <memory>
#include <optional>

#include "data-schema/spectrogram/spectrogram_axes.hpp"
#include "data-schema/spectrogram/spectrogram_writer.hpp"

namespace tacto::schema {
namespace {

using Buffer = fmt::memory_buffer;

struct CloseTable {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseTable>;

// Nine digits remove rounding noise ("0.30000000000000004") and keep picometres on a metre.
void append_axis(Buffer& row, double value) {
  if (std::isfinite(value)) fmt::format_to(std::back_inserter(row), "{:.9g}", value);
}

class CsvWriter : public SpectrogramWriter {
 public:
  CsvWriter(File file, std::string path, bool several)
      : file_(std::move(file)), path_(std::move(path)), several_(several) {}

  Result<void> begin(const SpectrogramHeader& header) override {
    if (auto fitting = check_axes(first_, header); !fitting) return fitting;
    ++strokes_;
    header_ = header;
    if (first_) return {};
    first_ = header;
    append_names();
    return flush();
  }

  Result<void> rows(std::size_t first, std::span<const float> cells) override {
    for (std::size_t row = 0; row * header_.bins < cells.size(); ++row) {
      append_row(first + row, cells.subspan(row * header_.bins, header_.bins));
      if (auto written = flush(); !written) return written;
    }
    return {};
  }

  Result<void> close() override {
    if (strokes_ == 0) return fail(ErrorKind::unsuitable, "there is no spectrogram to write", path_);
    return std::fclose(file_.release()) == 0 ? Result<void>{} : stopped();
  }

 private:
  bool knows() const { return !first_->known.empty(); }

  void append_names() {
    const auto out = std::back_inserter(row_);
    fmt::format_to(out, "{}position_mm", several_ ? "stroke," : "");
    if (knows()) fmt::format_to(out, ",known_from_per_mm,known_to_per_mm");
    for (std::size_t k = 0; k < header_.bins; ++k) {
      fmt::format_to(out, ",{} at ", cell_unit(header_));
      append_axis(row_, header_.frequency_per_m(k) / kMillimetres);
      fmt::format_to(out, "/mm");
    }
    row_.push_back('\n');
  }

  void append_known(std::size_t p) {
    for (const auto limit : {&KnownBand::low_per_m, &KnownBand::high_per_m}) {
      row_.push_back(',');
      if (!header_.known.empty()) append_axis(row_, header_.known[p].*limit / kMillimetres);
    }
  }

  // Empty if there is no finite number.
  void append_cell(float cell) {
    row_.push_back(',');
    if (std::isfinite(cell)) fmt::format_to(std::back_inserter(row_), "{}", cell);
  }

  void append_row(std::size_t p, std::span<const float> cells) {
    if (several_) fmt::format_to(std::back_inserter(row_), "{},", strokes_);
    append_axis(row_, header_.position_m[p] * kMillimetres);
    if (knows()) append_known(p);
    const float factor = cell_factor(header_.scaling);
    for (const float cell : cells) append_cell(cell * factor);
    row_.push_back('\n');
  }

  Result<void> flush() {
    const bool written = std::fwrite(row_.data(), 1, row_.size(), file_.get()) == row_.size();
    row_.clear();
    return written ? Result<void>{} : stopped();
  }

  Result<void> stopped() const {
    return fail(ErrorKind::cannot_write, "the file was not written completely", path_,
                "check whether the disk is full");
  }

  File file_;
  std::string path_;
  bool several_;
  std::size_t strokes_ = 0;
  std::optional<SpectrogramHeader> first_;
  SpectrogramHeader header_;  // of the spectrogram being written
  Buffer row_;
};

}  // namespace

Result<std::unique_ptr<SpectrogramWriter>> open_spectrogram_csv(const std::string& path,
                                                                const SpectrogramFileOptions& options) {
  File file(std::fopen(path.c_str(), "wbe"));
  const std::string& named = options.named.empty() ? path : options.named;
  if (!file) return fail(ErrorKind::cannot_write, "the file cannot be created", named);
  return std::make_unique<CsvWriter>(std::move(file), named, options.several);
}

}  // namespace tacto::schema
