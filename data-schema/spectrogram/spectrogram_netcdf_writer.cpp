// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "data-schema/base/decibels.hpp"
#include "data-schema/base/format_version.hpp"
#include "data-schema/spectrogram/netcdf_file.hpp"
#include "data-schema/spectrogram/spectrogram_axes.hpp"
#include "data-schema/spectrogram/spectrogram_sum.hpp"
#include "data-schema/spectrogram/spectrogram_writer.hpp"
#include "data-schema/version.hpp"

namespace tacto::schema {
namespace {

constexpr const char *kPositionUnit = "mm", *kFrequencyUnit = "1/mm", *kDecibelUnit = "dB";

std::vector<double> in_millimetres(const std::vector<double>& position_m) {
  std::vector<double> values(position_m.size());
  std::ranges::transform(position_m, values.begin(), [](double m) { return m * kMillimetres; });
  return values;
}

std::vector<double> frequencies_per_mm(const SpectrogramHeader& header) {
  std::vector<double> values(header.bins);
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = header.frequency_per_m(k) / kMillimetres;
  return values;
}

std::vector<double> limits_per_mm(const std::vector<KnownBand>& known, double KnownBand::*limit) {
  std::vector<double> values(known.size());
  std::ranges::transform(known, values.begin(),
                         [limit](const KnownBand& band) { return band.*limit / kMillimetres; });
  return values;
}

// As few blocks as possible, of about equal length: the unused end of the last block is in the file, too.
std::size_t block_rows(std::size_t positions, std::size_t bins) {
  const std::size_t blocks = (positions - 1) / rows_at_once(bins) + 1;
  return (positions - 1) / blocks + 1;
}

class NcWriter : public SpectrogramWriter {
 public:
  NcWriter(const std::string& path, std::string named, const SpectrogramFileOptions& options)
      : file_(path), named_(std::move(named)), options_(options) {}

  Result<void> begin(const SpectrogramHeader& header) override {
    if (auto fitting = check_axes(first_, header); !fitting) return fitting;
    end_sum();
    if (!first_) define(header);
    header_ = header;
    rows_.push_back(header.position_m.size());
    if (rows_.back() > position_m_.size()) position_m_ = header.position_m;
    names_ += (names_.empty() ? "" : "\n") + header.name;
    if (simulated_.empty()) simulated_ = header.simulated;
    if (header.known.empty()) return {};
    const Part part = part_of(stroke(), {0}, {header.known.size()});
    file_.put(known_from_, part, limits_per_mm(header.known, &KnownBand::low_per_m));
    file_.put(known_to_, part, limits_per_mm(header.known, &KnownBand::high_per_m));
    return {};
  }

  Result<void> rows(std::size_t first, std::span<const float> cells) override {
    const float factor = cell_factor(header_.scaling);
    const std::size_t count = cells.size() / header_.bins;
    scaled_.resize(cells.size());
    std::ranges::transform(cells, scaled_.begin(), [factor](float cell) { return cell * factor; });
    const Part part = part_of(stroke(), {first, 0}, {count, header_.bins});
    file_.put(cells_, part, std::span<const float>(scaled_));
    sum_.add(scaled_);
    put_decibels(first, count);
    flags_.assign(cells.size(), 0);
    for (std::size_t row = 0; row < count; ++row) flag(first + row, row);
    file_.put(known_, part, std::span<const signed char>(flags_));
    return {};
  }

  Result<void> close() override {
    if (!first_) return fail(ErrorKind::unsuitable, "there is no spectrogram to write", named_);
    end_sum();
    flag_absent_rows();
    if (options_.several) {
      std::vector<double> strokes(rows_.size());
      std::ranges::generate(strokes, [n = 0.0]() mutable { return n += 1; });
      file_.put(stroke_axis_, strokes);
    }
    file_.put(position_axis_, in_millimetres(position_m_));
    put_identity();
    put_summed();
    std::string sums;  // one a line
    for (SpectrogramSum& sum : sums_) sums += (sums.empty() ? "" : "\n") + sum.hexadecimal();
    file_.attribute("sha256", sums);
    return file_.close(named_);
  }

 private:
  std::size_t stroke() const { return rows_.size() - 1; }

  // Part of a variable over (stroke,) position and what follows.
  Part part_of(std::size_t stroke, std::vector<std::size_t> start, std::vector<std::size_t> count) const {
    Part part{std::move(start), std::move(count)};
    if (!options_.several) return part;
    part.start.insert(part.start.begin(), stroke);
    part.count.insert(part.count.begin(), 1);
    return part;
  }

  // Frequency by frequency: the order of a plot with the position along its lower edge.
  void put_decibels(std::size_t first, std::size_t rows) {
    decibels_.resize(scaled_.size());
    turned_.resize(scaled_.size());
    to_decibels(scaled_, header_.scaling == Scaling::amplitude ? 20.0F : 10.0F, decibels_);
    transpose(decibels_, rows, header_.bins, turned_);
    file_.put(decibels_variable_, part_of(stroke(), {0, first}, {header_.bins, rows}),
              std::span<const float>(turned_));
  }

  // Adds the axes of the last spectrogram.
  void end_sum() {
    if (!first_) return;
    const std::vector<double> absent(header_.known.empty() ? rows_.back() : 0,
                                     std::numeric_limits<double>::quiet_NaN());
    for (const auto limit : {&KnownBand::low_per_m, &KnownBand::high_per_m})
      sum_.add(header_.known.empty() ? absent : limits_per_mm(header_.known, limit));
    sum_.add(in_millimetres(header_.position_m));
    sum_.add(frequencies_per_mm(header_));
    sums_.push_back(std::exchange(sum_, SpectrogramSum()));
  }

  // The number of spectrograms and the length of the longest are known only at the end.
  void define(const SpectrogramHeader& header) {
    first_ = header;
    const std::size_t positions = header.position_m.size();
    Blocks limits, blocks;
    if (options_.several) limits = {{file_.dimension("stroke", std::nullopt)}, {1}};
    const int position =
        file_.dimension("position", options_.several ? std::optional<std::size_t>() : positions);
    limits.dimensions.push_back(position);
    blocks = limits;
    limits.lengths.push_back(positions);
    blocks.lengths.push_back(block_rows(positions, header.bins));
    blocks.dimensions.push_back(file_.dimension("spatial_frequency", header.bins));
    blocks.lengths.push_back(header.bins);
    define_variables(limits, blocks);
    define_decibels(blocks);
    file_.put(frequency_axis_, frequencies_per_mm(header));
  }

  void define_variables(const Blocks& limits, const Blocks& blocks) {
    if (options_.several) stroke_axis_ = file_.axis("stroke", blocks.dimensions[0], "", "stroke");
    position_axis_ =
        file_.axis("position", limits.dimensions.back(), kPositionUnit, "position of the window's centre");
    frequency_axis_ =
        file_.axis("spatial_frequency", blocks.dimensions.back(), kFrequencyUnit, "spatial frequency");
    const bool amplitude = first_->scaling == Scaling::amplitude;
    cells_ = file_.cells(amplitude ? "amplitude" : "density", blocks, options_.compress, cell_unit(*first_),
                         (amplitude ? "amplitude of " : "power spectral density of ") + first_->quantity);
    known_ = file_.flags("known", blocks, "unknown known", "whether the recording determines the cell");
    known_from_ = file_.values("known_from", limits, kFrequencyUnit,
                               "lowest spatial frequency that the recording determines");
    known_to_ = file_.values("known_to", limits, kFrequencyUnit,
                             "highest spatial frequency that the recording determines");
  }

  void define_decibels(Blocks blocks) {
    const bool amplitude = first_->scaling == Scaling::amplitude;
    std::swap(blocks.dimensions.back(), *(blocks.dimensions.end() - 2));
    std::swap(blocks.lengths.back(), *(blocks.lengths.end() - 2));
    decibels_variable_ =
        file_.cells(amplitude ? "amplitude_db" : "density_db", blocks, options_.compress, kDecibelUnit,
                    fmt::format("{} {} re 1 {}", amplitude ? "amplitude of" : "power spectral density of",
                                first_->quantity, cell_unit(*first_)));
  }

  void flag(std::size_t p, std::size_t row) {
    const auto flags = std::span(flags_).subspan(row * header_.bins, header_.bins);
    if (header_.known.empty()) {
      std::ranges::fill(flags, 1);
      return;
    }
    const auto bins = static_cast<double>(header_.bins);
    const auto& [low, high] = header_.known[p];
    // Rounding must not remove a bin from the band for which contains() is true.
    auto from = static_cast<std::size_t>(std::clamp(low / header_.frequency_step_per_m - 1, 0.0, bins));
    auto to = static_cast<std::size_t>(std::clamp(high / header_.frequency_step_per_m + 2, 0.0, bins));
    while (from < to && !header_.knows(p, from)) ++from;
    while (from < to && !header_.knows(p, to - 1)) --to;
    if (from < to) std::ranges::fill(flags.subspan(from, to - from), 1);
  }

  // Cells beyond the end of a shorter stroke are not valid.
  void flag_absent_rows() {
    const std::size_t most = rows_at_once(first_->bins);
    flags_.assign(most * first_->bins, 0);
    for (std::size_t each = 0; each < rows_.size(); ++each)
      for (std::size_t row = rows_[each]; row < position_m_.size(); row += most) {
        const std::size_t count = std::min(most, position_m_.size() - row);
        file_.put(known_, part_of(each, {row, 0}, {count, first_->bins}),
                  std::span<const signed char>(flags_));
      }
  }

  void put_identity() {
    file_.attribute("Conventions", std::string("CF-1.10"));
    file_.attribute("kind", std::string("spectrogram"));
    file_.attribute("version", std::string(kFormatVersion));
    file_.attribute("title", fmt::format("Spatial spectrogram of {}", first_->name));
    file_.attribute("source", std::string(kCreator));
  }

  void put_summed() {
    const bool amplitude = first_->scaling == Scaling::amplitude;
    const std::string texts[] = {names_,  // one a line
                                 simulated_,     first_->quantity,
                                 first_->unit,   amplitude ? "amplitude, one-sided" : "density, one-sided",
                                 first_->window, first_->detrend};
    const double numbers[] = {first_->window_m * kMillimetres, first_->hop_m * kMillimetres,
                              first_->pitch_m * kMillimetres, first_->coherent_gain};
    const std::size_t counts[] = {first_->padded_samples, first_->decimation};
    static_assert(std::size(texts) == std::size(kSummedTexts));
    static_assert(std::size(numbers) == std::size(kSummedNumbers));
    static_assert(std::size(counts) == std::size(kSummedCounts));
    for (std::size_t i = 0; i < std::size(texts); ++i)
      if (!texts[i].empty()) file_.attribute(kSummedTexts[i], texts[i]);
    for (std::size_t i = 0; i < std::size(numbers); ++i) file_.attribute(kSummedNumbers[i], numbers[i]);
    for (std::size_t i = 0; i < std::size(counts); ++i)
      file_.attribute(kSummedCounts[i], static_cast<long long>(counts[i]));
    for (SpectrogramSum& sum : sums_) {
      for (const std::string& text : texts) sum.add(text);
      for (const double number : numbers) sum.add(number);
      for (const std::size_t count : counts) sum.add(static_cast<double>(count));
      for (const std::string& unit :
           {std::string(kPositionUnit), std::string(kFrequencyUnit), std::string(kFrequencyUnit),
            std::string(kFrequencyUnit), cell_unit(*first_), std::string(kDecibelUnit)})
        sum.add(unit);
    }
  }

  NetcdfWriter file_;
  std::string named_;
  SpectrogramFileOptions options_;
  int stroke_axis_ = -1, position_axis_ = -1, frequency_axis_ = -1;  // variables
  int cells_ = -1, decibels_variable_ = -1, known_ = -1, known_from_ = -1, known_to_ = -1;
  std::optional<SpectrogramHeader> first_;
  SpectrogramHeader header_;        // of the spectrogram being written
  std::vector<std::size_t> rows_;   // of each so far
  std::vector<double> position_m_;  // of the longest so far
  std::string names_, simulated_;
  SpectrogramSum sum_;                // of the spectrogram being written
  std::vector<SpectrogramSum> sums_;  // of those before
  std::vector<float> scaled_, decibels_, turned_;
  std::vector<signed char> flags_;
};

}  // namespace

Result<std::unique_ptr<SpectrogramWriter>> open_spectrogram_nc(const std::string& path,
                                                               const SpectrogramFileOptions& options) {
  return std::make_unique<NcWriter>(path, options.named.empty() ? path : options.named, options);
}

}  // namespace tacto::schema
