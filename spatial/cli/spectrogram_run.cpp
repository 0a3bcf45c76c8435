// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/cli/spectrogram_run.hpp"
#include "data-schema/base/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data-schema/command/verb.hpp"

namespace tacto::spatial {
namespace {

using schema::Dimension;
using schema::ErrorKind;
using schema::Result;
using schema::SpectrogramHeader;

void warn_of_odd_options(const SpectrogramOptions& options, double pitch_m) {
  if (options.hop_m > options.window_m)
    cli::warn(
        fmt::format("the hop of {} is longer than the window of {}: the parts between windows are ignored",
                    schema::length_for_people(options.hop_m), schema::length_for_people(options.window_m)));
  if (options.max_frequency_per_m > 0.5 / pitch_m)
    cli::warn(fmt::format("a grid of {} contains no frequencies above {}", schema::length_for_people(pitch_m),
                          schema::for_people(0.5 / pitch_m, Dimension::spatial_frequency)));
}

void warn_if_little_is_seen(const NamedTexture& texture, const SpectrogramHeader& header) {
  const double length_m = texture.texture.signal.length_m();
  const double seen_m = header.position_m.back() - header.position_m.front();
  if (seen_m < 0.25 * length_m)
    cli::warn(
        fmt::format("{}: is only slightly longer than the window, so the spectrogram covers only {} of {}; "
                    "use a shorter --window",
                    texture.path, schema::length_for_people(seen_m), schema::length_for_people(length_m)));
}

template <class T>
tl::unexpected<schema::Error> naming(const NamedTexture& texture, const Result<T>& failed) {
  schema::Error error = failed.error();
  if (error.kind == ErrorKind::unsuitable) error.where = texture.path + ": " + error.where;
  return tl::unexpected(error);
}

}  // namespace

Result<void> SpectrogramRun::transform(TextureInputs& inputs) {
  expected_ = inputs.expected();
  for (;;) {
    auto texture = inputs.next();
    TACTO_TRY(texture);
    if (!*texture) break;
    if (auto taken = take(std::move(**texture)); !taken) return taken;
  }
  if (lines_.empty()) return schema::fail(ErrorKind::unsuitable, "none of the given files is a texture");
  return {};
}

Result<void> SpectrogramRun::take(NamedTexture texture) {
  const auto ready = first_ ? check_alike(texture) : prepare(texture);
  if (!ready) return ready;
  auto header = maker_->describe(texture.texture);
  if (!header) return naming(texture, header);
  header->name = texture.name;
  warn_if_little_is_seen(texture, *header);
  if (!first_) {
    first_ = *header;
    lowest_ = INFINITY;
  }
  lowest_ = std::min(lowest_, lowest_of_interest_per_m(texture.texture));
  lines_.push_back({texture.name, header->position_m.size(), {*header, lowest_per_m()}});
  if (auto made = make(texture, *header); !made) return naming(texture, made);
  if (keep_) textures_.push_back(std::move(texture));
  return {};
}

// The number of rows is estimated from the first texture, because most others are about as long.
Result<void> SpectrogramRun::prepare(const NamedTexture& first) {
  const auto& signal = first.texture.signal;
  const auto shape = frame_shape(options_, signal.pitch_m);
  TACTO_TRY(shape);
  auto maker = SpectrogramMaker::prepare(options_, signal.pitch_m,
                                         expected_ * (1 + signal.values.size() / shape->hop));
  TACTO_TRY(maker);
  maker_.emplace(std::move(*maker));
  first_path_ = first.path;
  warn_of_odd_options(options_, signal.pitch_m);
  return {};
}

Result<void> SpectrogramRun::check_alike(const NamedTexture& other) const {
  const double pitch_m = first_->pitch_m;
  const auto& texture = other.texture;
  if (std::abs(texture.signal.pitch_m - pitch_m) > 1e-9 * pitch_m)
    return schema::fail(
        ErrorKind::unsuitable,
        fmt::format("has a grid of {}, but {} has {}", schema::length_for_people(texture.signal.pitch_m),
                    first_path_, schema::length_for_people(pitch_m)),
        other.path, "make one spectrogram of each, or make textures with equal grids ('spatial --grid')");
  if (texture.quantity != first_->quantity || texture.unit != first_->unit)
    return schema::fail(
        ErrorKind::unsuitable,
        fmt::format("contains {}, but {} contains {}", texture.quantity, first_path_, first_->quantity),
        other.path, "make one spectrogram of each");
  return {};
}

Result<void> SpectrogramRun::make(const NamedTexture& texture, const SpectrogramHeader& header) {
  if (auto begun = files_.begin(header); !begun) return begun;
  if (keep_) spectrograms_.push_back({header, {}});
  const auto before = static_cast<double>(lines_.size() - 1),
             rows = static_cast<double>(header.position_m.size());
  return maker_->make(texture.texture, [&](std::size_t first, std::span<const float> cells) -> Result<void> {
    lines_.back().tally.add(first, cells);
    if (keep_) {
      auto& kept = spectrograms_.back().cells;
      kept.insert(kept.end(), cells.begin(), cells.end());
    }
    progress_.update(
        std::min(1.0, (before + static_cast<double>(first) / rows) / static_cast<double>(expected_)));
    return files_.rows(first, cells);
  });
}

}  // namespace tacto::spatial
