// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/make_texture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "data-schema/creation_time.hpp"
#include "data-schema/quantity.hpp"
#include "data-schema/version.hpp"
#include "spatial/equaliser.hpp"
#include "spatial/monotone_path.hpp"
#include "spatial/resample.hpp"
#include "spatial/smoothed_speed.hpp"
#include "spatial/valid_band.hpp"

namespace tacto::spatial {
namespace {

using schema::Fault;

std::vector<double> resample_piece(const FilteredPiece& piece, const Stroke& stroke, const MonotonePath& path,
                                   const SpaceGrid& grid, ResampleMethod method) {
  // Beyond the stroke's ends, so that S_f is there what it is in the whole signal.
  const std::size_t margin = margin_of(method);
  const std::size_t begin = stroke.frames.begin - piece.frames.begin, size = stroke.frames.size();
  const std::size_t before = std::min(margin, begin);
  const std::size_t after = std::min(margin, piece.values.size() - begin - size);
  const auto values = std::span(piece.values).subspan(begin - before, before + size + after);
  return resample(path, stroke.direction, grid, values, before, method);
}

}  // namespace

TextureMaker::TextureMaker(TouchRecord record, TextureOptions options)
    : record_(std::move(record)), options_(std::move(options)) {}

schema::Result<TextureMaker> TextureMaker::open(const schema::Recording& recording,
                                                const TextureOptions& options) {
  auto record = TouchRecord::open(recording, options.channel);
  if (!record) return schema::forward_error(record);
  TextureMaker maker(std::move(*record), options);
  if (const auto prepared = maker.prepare(); !prepared) return schema::forward_error(prepared);
  return maker;
}

schema::Result<void> TextureMaker::prepare() {
  if (!(options_.pitch_m > 0)) return schema::fail(Fault::usage, "the grid's pitch must be above 0");
  const schema::RecordingHeader& header = record_.header();
  if (auto fits = check(options_.filter, header.sample_rate_hz); !fits) {
    fits.error().where = record_.where();
    return fits;
  }
  if (options_.equalise == Equalise::off) return {};
  if (options_.equalise == Equalise::on && !header.transducer)
    return schema::fail(Fault::unsuitable, "names no transducer, so there is no response to divide by",
                        record_.where(), "leave --equalise away");
  if (header.transducer &&
      (options_.equalise == Equalise::on || record_.channel().quantity == "tangential_force"))
    equaliser_ = equaliser(*header.transducer);
  return {};
}

schema::Result<void> TextureMaker::check_duration(const Stroke& stroke) const {
  const double low_hz = options_.filter.passed(record_.header().sample_rate_hz).low_hz;
  const double duration_s = record_.to_s(stroke) - record_.from_s(stroke);
  if (duration_s * low_hz >= 1 || low_hz == 0) return {};
  return schema::fail(Fault::unsuitable,
                      fmt::format("the stroke at {:.4g} s lasts {:.3g} s, less than one period of {:g} Hz",
                                  record_.from_s(stroke), duration_s, low_hz),
                      record_.where(), "raise --low, or turn the band off with --band off");
}

schema::Result<const FilteredPiece*> TextureMaker::filtered_piece(FrameRange frames) {
  const auto holds = [&](const FrameRange& p) { return p.begin <= frames.begin && frames.end <= p.end; };
  if (piece_ && holds(piece_->frames)) return &*piece_;
  const auto found = std::ranges::find_if(record_.pieces(), holds);
  if (found == record_.pieces().end())
    return schema::fail(Fault::unsuitable, "frames are missing inside the stroke", record_.where());
  auto filtered =
      filter_in_time(record_.values(*found), record_.header().sample_rate_hz, options_.filter, equaliser_);
  if (!filtered) return schema::forward_error(filtered);
  piece_ = FilteredPiece{*found, std::move(*filtered)};
  return &*piece_;
}

schema::Result<schema::Texture> TextureMaker::make(const Stroke& stroke, int number) {
  if (const auto fine = check_duration(stroke); !fine) return schema::forward_error(fine);
  const auto piece = filtered_piece(stroke.frames);
  if (!piece) return schema::forward_error(piece);
  const MonotonePath path =
      monotone_path(record_.position_m(stroke.frames), stroke.direction, record_.quantum_m());
  if (path.way_m.empty())
    return schema::fail(Fault::unsuitable, "the finger gets nowhere in the stroke", record_.where());
  auto grid = grid_along(path, stroke.direction, options_.pitch_m);
  if (!grid) return schema::forward_error(grid);

  schema::Texture texture;
  texture.signal = {grid->pitch_m, 0, resample_piece(**piece, stroke, path, *grid, options_.method)};
  texture.source_origin_m = grid->origin_m();
  texture.source.position_moved_m = path.moved_m;
  describe(texture, stroke, number);
  add_band(texture, path);
  return texture;
}

void TextureMaker::add_band(schema::Texture& texture, const MonotonePath& path) const {
  const double rate_hz = record_.header().sample_rate_hz;
  const auto window = speed_window(record_.quantum_m(), texture.source.mean_speed_mps, rate_hz);
  const LocalSpeed speed(path, rate_hz, static_cast<double>(window));
  const SpeedProfile profile =
      speed_profile(speed, texture.source_origin_m, texture.signal.length_m(), texture.direction);
  const auto [slowest, fastest] = std::ranges::minmax(profile.speed_mps);
  texture.source.min_speed_mps = slowest;
  texture.source.max_speed_mps = fastest;
  texture.valid_band = valid_band(profile, options_.filter.passed(rate_hz));
}

void TextureMaker::describe(schema::Texture& texture, const Stroke& stroke, int number) const {
  const schema::RecordingHeader& header = record_.header();
  const TimeFilter& filter = options_.filter;
  const Band band = filter.passed(header.sample_rate_hz);
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
  source.filter = name_of(filter.method);
  source.edges = name_of(filter.edges);
  source.order = filter.method == FilterMethod::butterworth ? filter.order : 0;
  source.low_hz = band.low_hz;
  source.high_hz = band.high_hz;
  source.equalised = static_cast<bool>(equaliser_);
  source.mean_speed_mps = record_.mean_speed_mps(stroke);
  texture.simulated = header.simulated;
  texture.surface = header.surface;
  texture.subject = header.subject;
  texture.finger = header.finger;
  texture.notes = header.notes;
  texture.created = schema::creation_time();
  texture.creator = kCreator;
}

double rms_of(const schema::Texture& texture) {
  double squares = 0;
  for (const double value : texture.signal.values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(texture.signal.values.size()));
}

}  // namespace tacto::spatial
