// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <span>

#include "capture/derived_position.hpp"
#include "capture/import_plan.hpp"
#include "capture/plausibility.hpp"
#include "capture/uniform_clock.hpp"
#include "data-schema/files.hpp"

namespace tacto::capture {
namespace {

using schema::forward_error;
using schema::RecordingHeader;
using schema::Result;

constexpr std::size_t kBlockFrames = 65536;
constexpr double kReadingShare = 0.7;  // of the progress that people see

// An import under way: what was read, and the header that grows with it.
struct Import {
  const ImportRequest& request;
  ImportPlan plan;
  SourceData data;
  RecordingHeader header;
  std::vector<std::span<const double>> stored;  // of each channel
  std::vector<double> derived;                  // the position that was made, where there is one

  std::span<const double> column(std::size_t number) const {
    const auto columns = columns_of(plan);
    return data.columns[static_cast<std::size_t>(std::ranges::find(columns, number) - columns.begin())];
  }
  std::string name_of(std::size_t sample) const {
    return fmt::format("{}, {:.6g} s", data.place_of(sample), schema::frame_time_s(header, sample));
  }
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

// Integer codes end where their width does: 16 bits at -32768 and 32767.
void describe_range(schema::Channel& channel, int code_bits) {
  if (code_bits == 0) return;
  const double full = std::ldexp(1.0, code_bits - 1);
  const auto [low, high] =
      std::minmax({-full * channel.scale + channel.offset, (full - 1) * channel.scale + channel.offset});
  channel.range_min = low;
  channel.range_max = high;
}

void describe_channels(Import& import) {
  for (const ChannelSpec& spec : import.plan.channels) {
    import.header.channels.push_back(described(spec, import.plan.source, import.request.calibrated));
    describe_range(import.header.channels.back(), import.plan.source.code_bits);
    import.stored.push_back(import.column(spec.source.column));
  }
  import.header.frames = import.stored[0].size();
}

void describe_circumstances(Import& import) {
  const ImportRequest& request = import.request;
  RecordingHeader& header = import.header;
  header.source_file = std::filesystem::path(request.file).filename().string();
  header.recorded = request.recorded;
  header.subject = request.subject;
  header.finger = request.finger;
  header.surface = request.surface;
  header.notes = request.notes;
  header.humidity_percent = request.humidity_percent;
}

Result<void> take_time_column(Import& import) {
  const ScaledColumn& time = *import.plan.time;
  std::vector<double> time_s;
  for (const double number : import.column(time.column)) time_s.push_back(number * time.scale + time.offset);
  const auto place_of = [&](std::size_t row) { return import.data.place_of(row); };
  const auto clock = find_uniform_clock(time_s, place_of, import.request.file);
  if (!clock) return forward_error(clock);
  import.header.sample_rate_hz = clock->rate_hz;
  import.header.gaps = clock->gaps;
  import.header.clock = "times of the source, " + column_in_words(import.plan.source.columns, time.column);
  return {};
}

Result<void> set_clock(Import& import) {
  if (import.plan.time) return take_time_column(import);
  const auto& given = import.request.rate_hz;
  import.header.sample_rate_hz = given ? *given : *import.plan.source.rate_hz;
  import.header.clock = given ? "nominal rate given at import" : "rate of the sound file";
  if (given && import.plan.source.rate_hz)
    import.header.clock += fmt::format(" (its file says {:g} Hz)", *import.plan.source.rate_hz);
  return {};
}

const schema::Channel* channel_of(const RecordingHeader& header, std::string_view quantity) {
  const auto found = std::ranges::find(header.channels, quantity, &schema::Channel::quantity);
  return found == header.channels.end() ? nullptr : &*found;
}

void add_derived(Import& import, DerivedChannel derived) {
  import.derived = std::move(derived.values);
  import.header.warnings.push_back("no position was measured: it is " + derived.channel.derivation);
  import.header.channels.push_back(std::move(derived.channel));
  import.stored.emplace_back(import.derived);
}

void derive_position(Import& import) {
  if (channel_of(import.header, "position") != nullptr) return;
  if (import.request.speed_mps)
    return add_derived(import, nominal_position(import.header, *import.request.speed_mps));
  const schema::Channel* const speed = channel_of(import.header, "speed");
  if (speed == nullptr || !import.request.integrate_speed) return;
  const auto index = static_cast<std::size_t>(speed - import.header.channels.data());
  add_derived(import, integrated_position(import.header, *speed, import.stored[index]));
}

void warn_of_gaps(RecordingHeader& header) {
  if (header.gaps.empty()) return;
  const auto missing =
      std::accumulate(header.gaps.begin(), header.gaps.end(), std::uint64_t{0},
                      [](std::uint64_t sum, const schema::Gap& gap) { return sum + gap.count; });
  header.warnings.push_back(fmt::format("{} gap{} in the times, {} frames missing (not filled in)",
                                        header.gaps.size(), header.gaps.size() == 1 ? "" : "s", missing));
}

// Of what was measured only: a derived position is what the numbers before it make it.
void warn_of_implausible(Import& import) {
  const auto name_of = [&](std::size_t sample) { return import.name_of(sample); };
  for (std::size_t k = 0; k < import.plan.channels.size(); ++k)
    for (std::string& text : implausible(import.header.channels[k], import.stored[k], name_of))
      import.header.warnings.push_back(std::move(text));
}

Result<void> complete(Import& import) {
  describe_channels(import);
  describe_circumstances(import);
  if (const auto clock = set_clock(import); !clock) return clock;
  derive_position(import);
  warn_of_gaps(import.header);
  warn_of_implausible(import);
  const auto sum = schema::sha256_of_file(import.request.file);
  if (!sum) return forward_error(sum);
  import.header.source_sha256 = *sum;
  return {};
}

std::vector<double> interleaved(const Import& import, std::size_t first, std::size_t frames) {
  const std::size_t channels = import.stored.size();
  std::vector<double> block(frames * channels);
  for (std::size_t k = 0; k < channels; ++k)
    for (std::size_t i = 0; i < frames; ++i) block[i * channels + k] = import.stored[k][first + i];
  return block;
}

Result<schema::Recording> write(const Import& import, const std::function<void(double)>& progress) {
  auto writer = schema::RecordingWriter::create(import.request.name, import.header, import.request.replace);
  if (!writer) return forward_error(writer);
  const std::size_t all = import.header.frames;
  for (std::size_t first = 0; first < all; first += kBlockFrames) {
    const std::size_t frames = std::min(kBlockFrames, all - first);
    const auto written = writer->write(std::span<const double>(interleaved(import, first, frames)));
    if (!written) return forward_error(written);
    progress(kReadingShare +
             (1 - kReadingShare) * static_cast<double>(first + frames) / static_cast<double>(all));
  }
  return writer->close();
}

ChannelRange range_of(const schema::Channel& channel, std::span<const double> stored) {
  const auto [low, high] = std::ranges::minmax(stored);
  const auto [smallest, largest] =
      std::minmax({low * channel.scale + channel.offset, high * channel.scale + channel.offset});
  return {smallest, largest};
}

}  // namespace

Result<Imported> import_file(const ImportRequest& request, const std::function<void(double)>& progress) {
  auto plan = plan_import(request);
  if (!plan) return forward_error(plan);
  const auto reading = [&](double fraction) { progress(kReadingShare * fraction); };
  auto data = read_source(plan->source, columns_of(*plan), reading);
  if (!data) return forward_error(data);
  Import import{request, std::move(*plan), std::move(*data), {}, {}, {}};
  if (const auto completed = complete(import); !completed) return forward_error(completed);
  auto recording = write(import, progress);
  if (!recording) return forward_error(recording);
  Imported imported{std::move(*recording), {}, import.plan.source.format};
  for (std::size_t k = 0; k < import.stored.size(); ++k)
    imported.ranges.push_back(range_of(import.header.channels[k], import.stored[k]));
  return imported;
}

}  // namespace tacto::capture
