// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/texture/make_texture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "data-schema/base/creation_time.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/base/statistics.hpp"
#include "data-schema/transducer/transducer_plausible.hpp"
#include "data-schema/version.hpp"
#include "spatial/dsp/resample/thinned.hpp"
#include "spatial/strokes/smoothed_speed.hpp"

namespace tacto::spatial {
namespace {

using schema::ErrorKind;

constexpr double kSlowPart = 0.25;  // of the median speed
constexpr double kMaxFiner = 4096;  // 1 um of a grid of 4 mm

}  // namespace

TextureMaker::TextureMaker(TouchRecord record, TextureOptions options)
    : record_(std::move(record)), options_(std::move(options)), resampler_(options_.method) {}

schema::Result<TextureMaker> TextureMaker::open(const schema::Recording& recording,
                                                const TextureOptions& options) {
  auto record = TouchRecord::open(recording, options.channel);
  TACTO_TRY(record);
  return open(std::move(*record), options);
}

schema::Result<TextureMaker> TextureMaker::open(TouchRecord record, const TextureOptions& options) {
  TextureMaker maker(std::move(record), options);
  TACTO_TRY(maker.prepare());
  return maker;
}

schema::Result<void> TextureMaker::prepare() {
  if (!(options_.pitch_m > 0)) return schema::fail(ErrorKind::usage, "the grid's pitch must be above 0");
  const schema::RecordingHeader& header = record_.header();
  if (auto fits = check(options_.filter, header.sample_rate_hz); !fits) {
    fits.error().where = record_.where();
    return fits;
  }
  if (options_.space) options_.filter.method = FilterMethod::none;
  if (const auto equalised = choose_equaliser(); !equalised) return equalised;
  for (const Track track : record_.value_tracks())
    filtered_.emplace_back(header.sample_rate_hz, options_.filter, equaliser_, track);
  return {};
}

schema::Result<void> TextureMaker::choose_equaliser() {
  const schema::RecordingHeader& header = record_.header();
  if (options_.equalise == Equalise::off) return {};
  if (options_.equalise == Equalise::on && !header.transducer)
    return schema::fail(ErrorKind::unsuitable, "contains no transducer, so there is no response to divide by",
                        record_.where(), "omit --equalise");
  const bool of_transducer = record_.channel().quantity == "tangential_force";
  if (options_.equalise == Equalise::on && !of_transducer)
    return schema::fail(
        ErrorKind::unsuitable,
        record_.channel().name + " was not measured with the transducer, so its response does not apply",
        record_.where(), "omit --equalise, or use tangential_force");
  if (!header.transducer || !of_transducer) return {};
  const auto plausible = schema::check_plausible(*header.transducer, record_.where() + "#/transducer");
  if (!plausible)
    return schema::fail(ErrorKind::unsuitable, plausible.error().what, plausible.error().where,
                        "correct it, or do not divide by the response (--equalise off)");
  equaliser_ = equaliser(*header.transducer);
  return {};
}

double TextureMaker::lowest_hz() const {
  return options_.filter.passed(record_.header().sample_rate_hz).low_hz;
}

bool TextureMaker::is_long_enough(const Stroke& stroke) const {
  const double low_hz = lowest_hz();
  return low_hz == 0 || (record_.to_s(stroke) - record_.from_s(stroke)) * low_hz >= 1;
}

schema::Result<void> TextureMaker::check_duration(const Stroke& stroke) const {
  if (is_long_enough(stroke)) return {};
  const double low_hz = lowest_hz(), duration_s = record_.to_s(stroke) - record_.from_s(stroke);
  return schema::fail(ErrorKind::unsuitable,
                      fmt::format("the stroke at {:.4g} s lasts {:.3g} s, less than one period of {:g} Hz",
                                  record_.from_s(stroke), duration_s, low_hz),
                      record_.where(), "use a higher --low, or --band off");
}

schema::Result<MonotonePath> TextureMaker::path_of(const Stroke& stroke, double shift_m) const {
  const auto positions = record_.position_m(stroke.frames);
  TACTO_TRY(positions);
  MonotonePath path = monotone_path(*positions, stroke.direction, record_.position_error());
  if (path.way_m.empty())
    return schema::fail(ErrorKind::unsuitable, "the finger does not advance in the stroke", record_.where());
  if (shift_m != 0)
    for (double& way_m : path.way_m) way_m += stroke.direction * shift_m;
  return path;
}

// Of three axes the one signal. Valid until the next call.
schema::Result<std::span<const double>> TextureMaker::filtered(FrameRange piece, FrameRange frames) {
  std::vector<std::span<const double>> axes;
  for (FilteredTrack& track : filtered_) {
    const auto values = track.values(record_.source(), piece, frames);
    TACTO_TRY(values);
    axes.push_back(*values);
  }
  if (axes.size() == 1) return axes.front();
  reduced_ = dft321(axes);
  return std::span<const double>(reduced_.values);
}

schema::Result<std::vector<double>> TextureMaker::resampled(const Stroke& stroke, const MonotonePath& path,
                                                            const SpaceGrid& grid) {
  const auto holds = [&](const FrameRange& piece) { return piece.contains(stroke.frames); };
  const auto piece = std::ranges::find_if(record_.pieces(), holds);
  if (piece == record_.pieces().end())
    return schema::fail(ErrorKind::unsuitable, "frames are missing inside the stroke", record_.where());
  // Includes a margin beyond the stroke's ends, so that S_f is the same there as in the whole signal.
  const std::size_t margin = margin_of(options_.method);
  const std::size_t before = std::min(margin, stroke.frames.begin - piece->begin);
  const FrameRange frames{stroke.frames.begin - before, std::min(stroke.frames.end + margin, piece->end)};
  const auto seen = filtered(*piece, frames);
  TACTO_TRY(seen);
  std::vector<double> values(grid.count);
  resampler_(path, stroke.direction, grid, *seen, before, values);
  return values;
}

SpeedProfile TextureMaker::profile_of(const Stroke& stroke, const MonotonePath& path,
                                      const SpaceGrid& grid) const {
  const double rate_hz = record_.header().sample_rate_hz;
  const auto window = speed_window(record_.facts().resolution_m(), record_.mean_speed_mps(stroke), rate_hz);
  const Band band = options_.filter.passed(rate_hz);
  const LocalSpeed speed(
      path, rate_hz,
      speed_windows(record_.facts().resolution_m(), static_cast<double>(window), band, rate_hz));
  const double length_m = static_cast<double>(grid.count - 1) * grid.pitch_m;
  return speed_profile(speed, grid.origin_m(), length_m, stroke.direction);
}

Band TextureMaker::kept_band() const {
  const double rate_hz = record_.header().sample_rate_hz;
  Band band = options_.filter.kept(rate_hz);
  band.high_hz = std::min(band.high_hz, kept_hz(options_.method, rate_hz));
  return band;
}

// Resampling directly to a coarse grid would alias content above half a cycle per sample, so it is done on a
// finer one.
schema::Result<std::vector<double>> TextureMaker::on_grid(const Stroke& stroke, const MonotonePath& path,
                                                          const SpaceGrid& grid, std::size_t finer) {
  const auto times = static_cast<double>(finer);
  const SpaceGrid fine{grid.pitch_m / times, grid.first * times, (grid.count - 1) * finer + 1};
  auto values = resampled(stroke, path, fine);
  if (!values) return values;
  if (finer > 1) *values = thinned(*values, finer);
  return options_.space ? filter_in_space(*values, grid.pitch_m, *options_.space) : values;
}

// A finger that almost rests has its band at frequencies above those of any grid; the result would be noise.
schema::Result<void> TextureMaker::check_band(double usual_mps) const {
  const Band band = options_.filter.passed(record_.header().sample_rate_hz);
  const double highest_per_m = 1 / (2 * options_.pitch_m);
  if (band.low_hz <= highest_per_m * usual_mps) return {};
  const auto text = [](double value, schema::Dimension dimension) {
    return schema::for_people(value, dimension);
  };
  return schema::fail(
      ErrorKind::unsuitable,
      fmt::format(
          "the finger is too slow: at {} the band from {:g} Hz begins at {}, and a grid of {} ends at {}",
          text(usual_mps, schema::Dimension::speed), band.low_hz,
          text(band.low_hz / usual_mps, schema::Dimension::spatial_frequency),
          text(options_.pitch_m, schema::Dimension::length),
          text(highest_per_m, schema::Dimension::spatial_frequency)),
      record_.where(), "select a time range in which it moves; --list shows the strokes");
}

schema::Result<schema::Texture> TextureMaker::make(const Stroke& stroke, int number, double shift_m) {
  if (stroke.jump) return tl::unexpected(record_.refusal(*stroke.jump));
  TACTO_TRY(check_duration(stroke));
  const auto path = path_of(stroke, shift_m);
  TACTO_TRY(path);
  const auto grid = grid_along(*path, stroke.direction, options_.pitch_m);
  TACTO_TRY(grid);
  const SpeedProfile profile = profile_of(stroke, *path, *grid);
  auto speeds_mps = profile.speed_mps;
  const double usual_mps = schema::upper_median(std::span(speeds_mps));
  TACTO_TRY(check_band(usual_mps));
  const std::size_t finer = finer_grid(
      options_.pitch_m, options_.filter.passed(record_.header().sample_rate_hz).high_hz, usual_mps);
  auto values = on_grid(stroke, *path, *grid, finer);
  TACTO_TRY(values);

  schema::Texture texture;
  texture.signal = {grid->pitch_m, 0, std::move(*values)};
  texture.source_origin_m = grid->origin_m();
  texture.source.position_moved_m = path->moved_m;
  const auto [slowest, fastest] = std::ranges::minmax(profile.speed_mps);
  texture.source.min_speed_mps = slowest;
  texture.source.max_speed_mps = fastest;
  texture.valid_band = valid_band(profile, kept_band());
  narrow(texture.valid_band, 0, (finer > 1 ? kThinnedPass : 0.5) / options_.pitch_m);
  if (options_.space) {
    const auto [low_per_m, high_per_m] = options_.space->kept(options_.pitch_m);
    narrow(texture.valid_band, low_per_m, high_per_m);
  }
  describe(texture, stroke, number);
  return texture;
}

void TextureMaker::describe_filter(schema::TextureSource& source) const {
  const TimeFilter& filter = options_.filter;
  const Band band = filter.passed(record_.header().sample_rate_hz);
  const FilterMethod method = options_.space ? options_.space->method : filter.method;
  source.filter = name_of(method);
  source.edges = name_of(options_.space ? options_.space->edges : filter.edges);
  source.order = method != FilterMethod::butterworth ? 0
                 : options_.space                    ? options_.space->order
                                                     : filter.order;
  source.low_hz = band.low_hz;
  source.high_hz = band.high_hz;
  if (!options_.space) return;
  source.low_per_m = options_.space->low_per_m;
  source.high_per_m = options_.space->high_per_m;
}

void TextureMaker::describe_position(schema::TextureSource& source, const Stroke& stroke) const {
  source.mean_speed_mps = record_.mean_speed_mps(stroke);
  source.position_quantum_m = record_.facts().quantum_m;
  source.position_noise_m = record_.facts().noise_m;
  source.counter_bits = record_.counter_wraps().bits;
  source.counter_wraps =
      static_cast<int>(record_.counter_wraps().count_in(stroke.frames.begin, stroke.frames.end));
  source.interpolated_frames = static_cast<int>(record_.filled_in(stroke.frames));
  source.normal_force_n = stroke.force_n;
  source.finger_up = stroke.finger_up;
}

void TextureMaker::describe(schema::Texture& texture, const Stroke& stroke, int number) const {
  const schema::RecordingHeader& header = record_.header();
  texture.quantity = record_.channel().quantity;
  texture.unit = record_.channel().unit;
  texture.direction = stroke.direction;
  schema::TextureSource& source = texture.source;
  source.recording = std::filesystem::path(record_.where()).filename().string() + ".json";
  source.recording_sha256 = header.sha256;
  source.from_s = record_.from_s(stroke);
  source.to_s = record_.to_s(stroke);
  source.stroke = number;
  source.method = name_of(options_.method);
  if (filtered_.size() > 1) {
    source.reduction = "dft321";
    source.waveform_correlation = reduced_.waveform_correlation;
    for (const Track track : record_.value_tracks())
      source.axes.push_back(record_.source().channel(track)->name);
  }
  describe_filter(source);
  source.equalised = static_cast<bool>(equaliser_);
  describe_position(source, stroke);
  texture.simulated = header.simulated;
  texture.surface = header.surface;
  texture.subject = header.subject;
  texture.finger = header.finger;
  texture.notes = header.notes;
  texture.created = schema::creation_time();
  texture.creator = kCreator;
}

std::size_t finer_grid(double pitch_m, double highest_hz, double usual_mps) {
  const double times = std::ceil(2 * pitch_m * highest_hz / (kSlowPart * usual_mps));
  return static_cast<std::size_t>(std::clamp(times, 1.0, kMaxFiner));
}

double rms_of(const schema::Texture& texture) {
  return schema::rms_of(texture.signal.values);
}

}  // namespace tacto::spatial
