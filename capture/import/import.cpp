// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <filesystem>
#include <iterator>
#include <memory>
#include <numeric>
#include <span>

#include "capture/import/derived_position.hpp"
#include "capture/import/import_plan.hpp"
#include "capture/import/outlier_mask.hpp"
#include "capture/import/plausibility.hpp"
#include "capture/import/stream_clock.hpp"
#include "capture/import/uniform_clock.hpp"
#include "capture/record/store_strokes.hpp"

namespace tacto::capture {
namespace {

using schema::RecordingHeader;
using schema::Result;
using Progress = std::function<void(double)>;

void gather(const RowBlock& block, std::size_t column, std::vector<double>& values) {
  values.resize(block.rows());
  const double* const numbers = block.numbers.data() + column;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = numbers[i * block.columns];
}

// For the search for outliers only: an unknown value becomes the one before it. Its row is not stored.
void hold_unknown(std::vector<double>& values) {
  const auto known = std::ranges::find_if(values, [](double value) { return !std::isnan(value); });
  double last = known == values.end() ? 0 : *known;
  for (double& value : values) last = value = std::isnan(value) ? last : value;
}

// A measured channel during the import.
struct Measured {
  std::size_t column = 0;  // in the blocks
  std::unique_ptr<Plausibility> judged;
  std::vector<double> stored;  // of the current block
};

struct Derived {
  DerivedPosition position;
  std::size_t speed = 0;  // the measured channel that is integrated
  std::vector<double> stored;
  double smallest = 0, largest = 0;
};

// A running import, block by block.
class Import {
 public:
  Import(const ImportRequest& request, ImportPlan plan, Progress progress);
  Result<Imported> run();

 private:
  void choose_derived();
  Result<void> first_clock();
  Result<void> read_stream_clock();
  std::vector<schema::Gap> gaps_of_times() const;
  Result<void> find_outliers();
  Result<void> survey(const RowBlock& block);
  Result<void> note_unknown(const RowBlock& block);
  Result<void> mask_what_was_found();
  Result<void> write_all();
  Result<void> take(const RowBlock& block);
  void take_times(const RowBlock& block);
  void derive(std::size_t rows);
  Result<void> write_block(std::size_t rows);
  bool second_pass_needed() const;
  Result<void> second_pass(double from, double to);
  Result<void> name(const RowBlock& block, bool clock);
  void place_marks(RecordingHeader& header) const;
  void add_warnings(RecordingHeader& header) const;
  std::uint64_t outliers() const;
  Result<Imported> close();
  Progress share(double from, double to) const;
  Result<void> read(const RowHandler& take_rows, const Progress& progress, schema::Sha256* sum = nullptr);

  const ImportRequest& request_;
  ImportPlan plan_;
  Progress progress_;
  std::vector<std::size_t> columns_;
  RecordingHeader header_;  // until it is moved to the writer; `judged` refers to its channels
  std::vector<Measured> measured_;
  std::optional<Derived> derived_;
  std::vector<std::unique_ptr<Plausibility>>
      unmasked_plausibility_;  // only with the mask: statistics of all rows
  OutlierMask mask_;
  std::vector<std::uint64_t> unknown_rows_;  // only with the mask: rows that lack a value
  std::uint64_t rows_ = 0;
  ClockFinder clock_;
  std::optional<StreamClock> stream_clock_;
  StreamMarks stream_marks_;
  std::uint64_t frames_written_ = 0;
  bool clock_known_ = true, decimal_comma_ = false;
  std::vector<double> times_s_, interleaved_;
  std::optional<schema::RecordingWriter> writer_;
  schema::Sha256 sum_;
  std::deque<CsvReader::Landmark> last_landmarks_;
};

schema::Channel described(const ChannelSpec& spec, const Source& source, const std::string& calibrated) {
  schema::Channel channel;
  channel.name = spec.name;
  channel.quantity = spec.quantity;
  channel.unit = schema::si_symbol(spec.dimension);
  channel.scale = spec.source.scale;
  channel.offset = spec.source.offset;
  channel.source = source.columns[spec.source.column];
  if (channel.source.empty()) channel.source = column_in_words(source.columns, spec.source.column);
  channel.calibrated = calibrated;
  return channel;
}

// The range of integer codes follows from their width: -32768 to 32767 for 16 bits.
void describe_range(schema::Channel& channel, int code_bits) {
  if (code_bits == 0) return;
  const double full = std::ldexp(1.0, code_bits - 1);
  const auto [low, high] = std::minmax({channel.physical(-full), channel.physical(full - 1)});
  channel.range_min = low;
  channel.range_max = high;
}

void describe_clock(RecordingHeader& header, const ImportRequest& request, const ImportPlan& plan) {
  if (plan.time) {
    header.clock = "times of the source, " + column_in_words(plan.source.columns, plan.time->column);
    return;
  }
  const auto& given = request.rate_hz;
  if (!given && plan.source.xdf) return;  // read_stream_clock() describes it
  header.sample_rate_hz = given ? *given : *plan.source.rate_hz;
  header.clock = given ? "nominal rate, given at import" : "rate of the sound file";
  if (given && plan.source.rate_hz)
    header.clock += fmt::format(" (its header has {:g} Hz)", *plan.source.rate_hz);
}

// The part that is known before the data are read. With a time column, the rate is not set yet.
RecordingHeader import_header(const ImportRequest& request, const ImportPlan& plan) {
  RecordingHeader header;
  for (const ChannelSpec& spec : plan.channels) {
    header.channels.push_back(described(spec, plan.source, request.calibrated));
    describe_range(header.channels.back(), plan.source.code_bits);
  }
  header.source_file = std::filesystem::path(request.file).filename().string();
  header.recorded = request.recorded;
  header.subject = request.subject;
  header.finger = request.finger;
  header.surface = request.surface;
  header.notes = request.notes;
  header.humidity_percent = request.humidity_percent;
  describe_clock(header, request, plan);
  return header;
}

// One line, or none if there are no gaps.
std::vector<std::string> gap_warnings(const std::vector<schema::Gap>& gaps) {
  if (gaps.empty()) return {};
  const auto missing =
      std::accumulate(gaps.begin(), gaps.end(), std::uint64_t{0},
                      [](std::uint64_t sum, const schema::Gap& gap) { return sum + gap.count; });
  return {fmt::format("{} gap{} in the times, {} frames missing (not filled in)", gaps.size(),
                      gaps.size() == 1 ? "" : "s", missing)};
}

Import::Import(const ImportRequest& request, ImportPlan plan, Progress progress)
    : request_(request),
      plan_(std::move(plan)),
      progress_(std::move(progress)),
      columns_(columns_of(plan_)),
      header_(import_header(request, plan_)),
      clock_known_(!plan_.time) {
  const auto place = [&](std::size_t column) {
    return static_cast<std::size_t>(std::ranges::find(columns_, column) - columns_.begin());
  };
  for (std::size_t k = 0; k < plan_.channels.size(); ++k)
    measured_.push_back(
        {place(plan_.channels[k].source.column), std::make_unique<Plausibility>(header_.channels[k]), {}});
  if (plan_.source.csv) {
    plan_.source.csv->unknown_as_nan = request.mask_outliers;
    plan_.source.csv->unknown_remedy =
        "unknown values are not filled in: --mask-outliers makes gaps of their rows";
  }
  plan_.source.unknown_as_nan = request.mask_outliers;
  choose_derived();
}

void Import::choose_derived() {
  const auto channel_of = [&](std::string_view quantity) {
    return std::ranges::find(plan_.channels, quantity, &ChannelSpec::quantity);
  };
  if (channel_of("position") != plan_.channels.end()) return;
  if (request_.speed_mps) derived_ = {DerivedPosition::nominal(*request_.speed_mps), 0, {}, 0, 0};
  const auto speed = channel_of("speed");
  if (derived_ || speed == plan_.channels.end() || !request_.integrate_speed) return;
  const auto index = static_cast<std::size_t>(speed - plan_.channels.begin());
  derived_ = {DerivedPosition::integrated(header_.channels[index]), index, {}, 0, 0};
}

Progress Import::share(double from, double to) const {
  return [this, from, to](double fraction) { progress_(from + (to - from) * fraction); };
}

Result<void> Import::read(const RowHandler& take_rows, const Progress& progress, schema::Sha256* sum) {
  return read_source(plan_.source, columns_, take_rows, progress, sum);
}

void Import::take_times(const RowBlock& block) {
  const ScaledColumn& time = *plan_.time;
  const auto place = std::ranges::find(columns_, time.column) - columns_.begin();
  gather(block, static_cast<std::size_t>(place), times_s_);
  for (double& value : times_s_) value = time.physical(value);
}

// The clock must be known before the first position can be written.
Result<void> Import::first_clock() {
  const auto survey = [this](const RowBlock& block) -> Result<void> {
    take_times(block);
    clock_.survey(times_s_);
    return {};
  };
  if (const auto surveyed = read(survey, share(0, 0.2)); !surveyed) return surveyed;
  if (const auto ended = clock_.end_survey(request_.file); !ended) return ended;
  const auto locate = [this](const RowBlock& block) { return name(block, true); };
  if (clock_.second_pass_needed())
    if (const auto located = read(locate, share(0.2, 0.3)); !located) return located;
  clock_known_ = true;
  header_.sample_rate_hz = clock_.clock().rate_hz;
  header_.gaps = clock_.clock().gaps;
  return check_rate_of_times(header_.sample_rate_hz, request_.file);
}

Result<void> Import::read_stream_clock() {
  auto clock = find_stream_clock(request_.file, *plan_.source.xdf_stream, share(0, 0.3));
  TACTO_TRY(clock);
  header_.sample_rate_hz = clock->clock.rate_hz;
  header_.gaps = clock->clock.gaps;
  header_.clock = clock->words;
  auto marks = find_stream_marks(request_.file, *plan_.source.xdf, *plan_.source.xdf_stream, *clock);
  TACTO_TRY(marks);
  stream_marks_ = std::move(*marks);
  stream_clock_ = std::move(*clock);
  return check_rate_of_times(header_.sample_rate_hz, request_.file);
}

std::vector<schema::Gap> Import::gaps_of_times() const {
  if (stream_clock_) return stream_clock_->clock.gaps;
  return plan_.time ? clock_.clock().gaps : std::vector<schema::Gap>{};
}

// Rows that lack a value are left out, too; but where a row is in time must be known.
Result<void> Import::note_unknown(const RowBlock& block) {
  for (std::size_t i = 0; i < block.numbers.size(); ++i) {
    if (!std::isnan(block.numbers[i])) continue;
    const std::uint64_t row = block.first_row + i / block.columns;
    const std::size_t column = columns_[i % block.columns];
    if (plan_.time && column == plan_.time->column)
      return schema::fail(schema::ErrorKind::malformed, "has no time",
                          fmt::format("{}: {}, {}", request_.file, block.place_of(row),
                                      column_in_words(plan_.source.columns, column)),
                          "give --rate instead of --time-column, or leave out the row");
    if (unknown_rows_.empty() || unknown_rows_.back() != row) unknown_rows_.push_back(row);
  }
  return {};
}

Result<void> Import::survey(const RowBlock& block) {
  const auto place_of = [&](std::uint64_t row) { return block.place_of(row); };
  TACTO_TRY(note_unknown(block));
  if (plan_.time) {
    take_times(block);
    clock_.survey(times_s_);
  }
  for (Measured& channel : measured_) {
    gather(block, channel.column, channel.stored);
    if (!unknown_rows_.empty()) hold_unknown(channel.stored);
    channel.judged->survey(channel.stored, block.first_row, place_of);
  }
  rows_ += block.rows();
  return {};
}

// Finds the rows to leave out, and so the times of the others, before the first sample is written.
Result<void> Import::find_outliers() {
  const auto take_rows = [this](const RowBlock& block) { return survey(block); };
  if (const auto surveyed = read(take_rows, share(0, 0.2)); !surveyed) return surveyed;
  for (Measured& channel : measured_) channel.judged->end_survey();
  if (plan_.time)
    if (const auto ended = clock_.end_survey(request_.file); !ended) return ended;
  if (second_pass_needed())
    if (const auto named = second_pass(0.2, 0.3); !named) return named;
  return mask_what_was_found();
}

Result<void> Import::mask_what_was_found() {
  std::vector<std::uint64_t> rows = unknown_rows_;
  for (std::size_t k = 0; k < measured_.size(); ++k) {
    unmasked_plausibility_.push_back(
        std::exchange(measured_[k].judged, std::make_unique<Plausibility>(header_.channels[k])));
    std::ranges::copy(unmasked_plausibility_[k]->outlier_samples(), std::back_inserter(rows));
  }
  auto mask = OutlierMask::of(std::move(rows), rows_, request_.file);
  TACTO_TRY(mask);
  mask_ = std::move(*mask);
  if (plan_.time) {
    header_.sample_rate_hz = clock_.clock().rate_hz;
    TACTO_TRY(check_rate_of_times(header_.sample_rate_hz, request_.file));
  }
  header_.gaps = mask_.gaps_with(gaps_of_times());
  clock_known_ = true;
  return {};
}

void Import::derive(std::size_t rows) {
  const auto& speeds = measured_[derived_->speed].stored;
  derived_->stored.resize(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    const double position_m = derived_->position.next(header_, speeds[i]);
    derived_->stored[i] = position_m;
    derived_->smallest = std::min(derived_->smallest, position_m);
    derived_->largest = std::max(derived_->largest, position_m);
  }
}

Result<void> Import::write_block(std::size_t rows) {
  const std::size_t channels = measured_.size() + (derived_ ? 1 : 0);
  interleaved_.resize(rows * channels);
  for (std::size_t k = 0; k < channels; ++k) {
    const double* const stored = (k < measured_.size() ? measured_[k].stored : derived_->stored).data();
    for (std::size_t i = 0; i < rows; ++i) interleaved_[i * channels + k] = stored[i];
  }
  frames_written_ += rows;
  return writer_->write(std::span<const double>(interleaved_));
}

Result<void> Import::take(const RowBlock& block) {
  const auto place_of = [&](std::uint64_t row) { return block.place_of(row); };
  decimal_comma_ = block.decimal_mark == ',';
  if (!clock_known_) {
    take_times(block);
    clock_.survey(times_s_);
  }
  for (Measured& channel : measured_) {
    gather(block, channel.column, channel.stored);
    mask_.erase_from(channel.stored, block.first_row);
    if (!channel.stored.empty()) channel.judged->survey(channel.stored, block.first_row, place_of);
  }
  const std::size_t rows = measured_[0].stored.size();
  if (rows == 0) return {};
  if (derived_) derive(rows);
  return write_block(rows);
}

Result<void> Import::write_all() {
  RecordingHeader written = header_;
  if (!clock_known_) written.sample_rate_hz = 1;  // until it is known
  if (derived_) written.channels.push_back(derived_->position.channel());
  auto writer = schema::RecordingWriter::create(request_.name, std::move(written), request_.replace);
  TACTO_TRY(writer);
  writer_ = std::move(*writer);
  const auto done = read([this](const RowBlock& block) { return take(block); }, share(0.3, 0.8), &sum_);
  if (!done) return done;
  for (Measured& channel : measured_) channel.judged->end_survey();
  return clock_known_ ? Result<void>{} : clock_.end_survey(request_.file);
}

bool Import::second_pass_needed() const {
  const auto needs = [](const Measured& channel) { return channel.judged->second_pass_needed(); };
  return (!clock_known_ && clock_.second_pass_needed()) || std::ranges::any_of(measured_, needs);
}

// Finds the line numbers for messages: gaps and errors of the clock, or isolated samples.
Result<void> Import::name(const RowBlock& block, bool clock) {
  const auto place_of = [&](std::uint64_t row) { return block.place_of(row); };
  if (clock) {
    take_times(block);
    return clock_.locate(times_s_, place_of, request_.file);
  }
  for (Measured& channel : measured_) {
    if (!channel.judged->second_pass_needed()) continue;
    gather(block, channel.column, channel.stored);
    if (!unknown_rows_.empty()) hold_unknown(channel.stored);
    channel.judged->find(channel.stored, place_of);
  }
  return {};
}

Result<void> Import::second_pass(double from, double to) {
  const bool clock = !clock_known_ && clock_.second_pass_needed();
  const auto name_both = [&](const RowBlock& block) -> Result<void> {
    if (block.landmarks != nullptr) last_landmarks_ = *block.landmarks;
    if (clock)
      if (const auto located = name(block, true); !located) return located;
    return name(block, false);
  };
  if (const auto done = read(name_both, share(from, to)); !done) return done;
  RowBlock after{{}, columns_.size(), 0, plan_.source.csv ? &last_landmarks_ : nullptr};
  for (Measured& channel : measured_)
    if (channel.judged->second_pass_needed())
      channel.judged->end_find([&](std::uint64_t row) { return after.place_of(row); });
  return {};
}

void add_stream_warnings(RecordingHeader& header, const Source& source, bool rate_given) {
  const schema::XdfStream& stream = *source.xdf_stream;
  if (!source.xdf->cut.empty()) header.warnings.push_back(source.xdf->cut);
  if (!stream.stated_samples)
    header.warnings.push_back(
        "the stream has no footer: its recording was not ended, or the file was cut; samples may be "
        "missing");
  else if (*stream.stated_samples != stream.samples)
    header.warnings.push_back(fmt::format("the stream has {} samples, but its footer states {}",
                                          stream.samples, *stream.stated_samples));
  if (rate_given)
    header.warnings.push_back("the rate is the one given; the times of the stream and its gaps are not read");
}

// Each marker at the nearest frame; in a gap at the one behind it.
void Import::place_marks(RecordingHeader& header) const {
  header.frames = frames_written_;
  std::uint64_t outside = 0;
  for (const auto& [at_s, label] : stream_marks_.marks) {
    const double half_s = 0.5 / header.sample_rate_hz;
    const std::uint64_t frame = schema::frame_at(header, at_s - half_s);
    if (at_s < -half_s || frame == header.frames)
      ++outside;
    else
      header.marks.push_back({frame, label});
  }
  if (outside > 0)
    header.warnings.push_back(fmt::format("{} marker{} before the first or behind the last sample {} no mark",
                                          outside, outside == 1 ? "" : "s", outside == 1 ? "gives" : "give"));
}

void Import::add_warnings(RecordingHeader& header) const {
  RecordingHeader source = header;  // the header before rows were left out
  if (request_.mask_outliers) source.gaps = gaps_of_times();
  const auto time_of = [&](std::uint64_t sample) {
    return fmt::format("{:.6g} s", schema::frame_time_s(source, sample));
  };
  if (const auto column = time_column_of(plan_.source); column && request_.rate_hz)
    header.warnings.push_back(fmt::format(
        "the rate is the one given; the table's times are not read: --time-column '{}' takes it from them",
        plan_.source.columns[*column]));
  if (plan_.source.xdf_stream) add_stream_warnings(header, plan_.source, request_.rate_hz.has_value());
  if (stream_clock_) std::ranges::copy(stream_clock_->warnings, std::back_inserter(header.warnings));
  std::ranges::copy(stream_marks_.warnings, std::back_inserter(header.warnings));
  if (plan_.source.xdf && !stream_clock_ &&
      std::ranges::any_of(plan_.source.xdf->streams, &schema::XdfStream::is_text))
    header.warnings.push_back("the times of the stream are not read, so the file's markers give no marks");
  for (const ChannelSpec& channel : plan_.channels)
    if (!channel.source.other_unit.empty())
      header.warnings.push_back(
          fmt::format("{}: the unit of its column '{}' is {}; that of --channel is used instead",
                      channel.name, plan_.source.columns[channel.source.column], channel.source.other_unit));
  if (derived_)
    header.warnings.push_back("no position was measured: it is " + derived_->position.channel().derivation);
  std::ranges::move(gap_warnings(source.gaps), std::back_inserter(header.warnings));
  for (std::size_t k = 0; k < measured_.size(); ++k) {
    const Plausibility& judged = request_.mask_outliers ? *unmasked_plausibility_[k] : *measured_[k].judged;
    std::ranges::move(judged.warnings(time_of), std::back_inserter(header.warnings));
  }
  if (mask_.count() > 0)
    header.warnings.push_back(
        fmt::format("outliers masked: {} row{} removed and recorded as gaps, not filled in", mask_.count(),
                    mask_.count() == 1 ? "" : "s"));
}

ChannelRange range_of(const schema::Channel& channel, double low, double high) {
  const auto [smallest, largest] = std::minmax({channel.physical(low), channel.physical(high)});
  return {smallest, largest};
}

std::uint64_t Import::outliers() const {
  std::uint64_t count = 0;
  for (const Measured& channel : measured_) count += channel.judged->outliers();
  for (const auto& judged : unmasked_plausibility_) count += judged->outliers();
  return count + unknown_rows_.size();
}

Result<Imported> Import::close() {
  RecordingHeader& header = writer_->header();
  if (plan_.time && !request_.mask_outliers) {
    header.sample_rate_hz = clock_.clock().rate_hz;
    header.gaps = clock_.clock().gaps;
    TACTO_TRY(check_rate_of_times(header.sample_rate_hz, request_.file));
  }
  header.source_sha256 = sum_.hexadecimal();
  place_marks(header);
  add_warnings(header);
  auto recording = writer_->close();
  TACTO_TRY(recording);
  TACTO_TRY(store_strokes(*recording));
  Imported imported{std::move(*recording), {}, plan_.source.format, outliers(), mask_.count()};
  if (decimal_comma_) imported.format += ", decimal commas";
  for (std::size_t k = 0; k < measured_.size(); ++k) {
    const Plausibility& judged = *measured_[k].judged;
    imported.ranges.push_back(
        range_of(header_.channels[k], judged.smallest_stored(), judged.largest_stored()));
  }
  if (derived_) imported.ranges.push_back({derived_->smallest, derived_->largest});
  progress_(1);
  return imported;
}

Result<Imported> Import::run() {
  if (plan_.source.xdf_stream && !plan_.time && !request_.rate_hz) TACTO_TRY(read_stream_clock());
  if (request_.mask_outliers) {
    TACTO_TRY(find_outliers());
  } else if (plan_.time && derived_) {
    TACTO_TRY(first_clock());
  }
  TACTO_TRY(write_all());
  if (!request_.mask_outliers && second_pass_needed()) TACTO_TRY(second_pass(0.8, 0.9));
  return close();
}

}  // namespace

Result<Imported> import_file(const ImportRequest& request, const std::function<void(double)>& progress) {
  auto plan = plan_import(request);
  TACTO_TRY(plan);
  return Import(request, std::move(*plan), progress).run();
}

}  // namespace tacto::capture
