// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/texture/average_textures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data-schema/base/creation_time.hpp"
#include "data-schema/base/quantity.hpp"
#include "spatial/numbers/band_at.hpp"

namespace tacto::spatial {
namespace {

using schema::ErrorKind;

constexpr double kBandSpacing_m = 1e-4;
constexpr double kFurthestAway = 10;  // lengths of the first: another place, or a wrong position

std::int64_t whole(double value) {
  return static_cast<std::int64_t>(std::llround(value));
}

}  // namespace

schema::Result<void> TextureAverager::check(const schema::Texture& texture, std::int64_t first) const {
  if (strokes_.empty()) return {};
  if (texture.signal.pitch_m != model_.signal.pitch_m || texture.quantity != model_.quantity ||
      texture.unit != model_.unit)
    return schema::fail(ErrorKind::unsuitable,
                        "strokes with different grids or quantities cannot be averaged");
  const auto reach = static_cast<std::int64_t>(kFurthestAway * static_cast<double>(cells_.size()));
  if (first < first_ - reach || first > first_ + static_cast<std::int64_t>(cells_.size()) + reach)
    return schema::fail(
        ErrorKind::unsuitable,
        fmt::format("stroke {} is {} away from the others", texture.source.stroke,
                    schema::for_people(static_cast<double>(std::abs(first - first_)) * model_.signal.pitch_m,
                                       schema::Dimension::length)),
        {}, "average strokes over the same place; --stroke N makes a texture of this one");
  return {};
}

const std::string& TextureAverager::Names::with(const std::string& name, const char* between) {
  if (!name.empty() && seen.insert(name).second) list += (list.empty() ? "" : between) + name;
  return list;
}

// Extends the cells to `size` cells from `first` on.
void TextureAverager::cover(std::int64_t first, std::size_t size) {
  if (cells_.empty()) first_ = first;
  if (first < first_) {
    cells_.insert(cells_.begin(), static_cast<std::size_t>(first_ - first), Cell{});
    first_ = first;
  }
  cells_.resize(std::max(cells_.size(), static_cast<std::size_t>(first - first_) + size));
}

// Reduces the common band to what is valid in this stroke, too.
void TextureAverager::narrow_band(const schema::Texture& texture) {
  if (texture.valid_band.empty()) return;
  const double origin_m = texture.source_origin_m;
  const std::int64_t last = whole(std::ceil((origin_m + texture.signal.length_m()) / kBandSpacing_m));
  for (std::int64_t at = whole(std::floor(origin_m / kBandSpacing_m)); at <= last; ++at) {
    const auto here = band_at(texture.valid_band, static_cast<double>(at) * kBandSpacing_m - origin_m);
    auto& common = band_.try_emplace(at, here).first->second;
    common.low_per_m = std::max(common.low_per_m, here.low_per_m);
    common.high_per_m = std::min(common.high_per_m, here.high_per_m);
  }
}

// Keeps the text members that are the same in all textures; recordings may differ in subject and finger.
// Surfaces and simulations are listed.
void TextureAverager::keep_common_members(const schema::Texture& texture) {
  const auto keep = [](std::string& kept, const std::string& said) {
    if (kept != said) kept.clear();
  };
  keep(model_.subject, texture.subject);
  keep(model_.finger, texture.finger);
  keep(model_.notes, texture.notes);
  keep(model_.source.recording_sha256, texture.source.recording_sha256);
  model_.surface = surfaces_.with(texture.surface, "; ");
  model_.simulated = simulations_.with(texture.simulated, "; ");
  model_.source.recording = recordings_.with(texture.source.recording, ", ");
}

schema::Result<void> TextureAverager::add(const schema::Texture& texture,
                                          const schema::AveragedStroke& stroke) {
  const std::int64_t first = whole(texture.source_origin_m / texture.signal.pitch_m);
  if (auto fits = check(texture, first); !fits) return fits;
  const schema::TextureSource& source = texture.source;
  if (strokes_.empty()) {
    model_ = texture;
    model_.signal.values.clear();
    model_.source.stroke = 0;
  }
  keep_common_members(texture);
  cover(first, texture.signal.values.size());
  auto* cell = &cells_[static_cast<std::size_t>(first - first_)];
  for (const double value : texture.signal.values) {
    const double off = value - cell->mean;
    cell->mean += off / ++cell->count;
    cell->squares += off * (value - cell->mean);
    ++cell;
  }
  narrow_band(texture);
  strokes_.push_back(stroke);
  speeds_mps_ += source.mean_speed_mps;
  schema::TextureSource& all = model_.source;
  all.from_s = std::min(all.from_s, source.from_s);
  all.to_s = std::max(all.to_s, source.to_s);
  all.min_speed_mps = std::min(all.min_speed_mps, source.min_speed_mps);
  all.max_speed_mps = std::max(all.max_speed_mps, source.max_speed_mps);
  all.position_moved_m = std::max(all.position_moved_m, source.position_moved_m);
  all.counter_wraps = std::max(all.counter_wraps, source.counter_wraps);
  return {};
}

std::vector<double> TextureAverager::mean() const {
  std::vector<double> mean;
  mean.reserve(cells_.size());
  for (const Cell& cell : cells_) mean.push_back(cell.mean);
  return mean;
}

TextureAverager::Section TextureAverager::well_covered() const {
  const auto enough = static_cast<std::int32_t>(std::max<std::size_t>(2, (strokes_.size() + 1) / 2));
  Section longest;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (cells_[i].count < enough) continue;
    std::size_t end = i;
    while (end < cells_.size() && cells_[end].count >= enough) ++end;
    if (end - i > longest.end - longest.begin) longest = {i, end};
    i = end;
  }
  return longest;
}

std::vector<schema::StrokeCount> TextureAverager::counts(Section section) const {
  std::vector<schema::StrokeCount> counts;
  for (std::size_t i = section.begin; i < section.end; ++i)
    if (i == section.begin || cells_[i].count != cells_[i - 1].count)
      counts.push_back({static_cast<double>(i - section.begin) * model_.signal.pitch_m, cells_[i].count});
  return counts;
}

// Where no band is common to all strokes, the result is a band of zero width.
std::vector<schema::BandPoint> TextureAverager::band(double origin_m, double length_m) const {
  std::vector<schema::BandPoint> all, points;
  for (const auto& [at, common] : band_)
    all.push_back({static_cast<double>(at) * kBandSpacing_m - origin_m, common.low_per_m,
                   std::max(common.low_per_m, common.high_per_m)});
  if (all.empty()) return {};
  points.push_back(band_at(all, 0));
  points.back().position_m = 0;
  for (const schema::BandPoint& point : all)
    if (point.position_m > 0 && point.position_m < length_m) points.push_back(point);
  points.push_back(band_at(all, length_m));
  points.back().position_m = length_m;
  return points;
}

schema::Texture TextureAverager::described() const {
  schema::Texture texture = model_;
  texture.source.mean_speed_mps = speeds_mps_ / static_cast<double>(strokes_.size());
  const auto same_way = [&](const schema::AveragedStroke& stroke) {
    return stroke.direction == strokes_.front().direction;
  };
  texture.direction = std::ranges::all_of(strokes_, same_way) ? strokes_.front().direction : 1;
  texture.source.normal_force_n.reset();
  texture.source.waveform_correlation.reset();
  texture.created = schema::creation_time();
  return texture;
}

schema::Result<schema::Texture> TextureAverager::finish(const std::string& align) const {
  if (strokes_.size() < 2)
    return schema::fail(ErrorKind::unsuitable,
                        fmt::format("a mean needs at least 2 strokes, there is {}", strokes_.size()));
  const Section section = well_covered();
  if (section.end - section.begin < 2)
    return schema::fail(ErrorKind::unsuitable, "the strokes do not overlap", {},
                        "at least half of them must overlap; --list shows their positions");
  schema::Texture texture = described();
  texture.average = schema::TextureAverage{align, {}, strokes_, counts(section)};
  for (std::size_t i = section.begin; i < section.end; ++i) {
    const Cell& cell = cells_[i];
    texture.signal.values.push_back(cell.mean);
    texture.average->spread.push_back(std::sqrt(cell.squares / (cell.count - 1)));
  }
  const auto origin = first_ + static_cast<std::int64_t>(section.begin);
  texture.source_origin_m = static_cast<double>(origin) * texture.signal.pitch_m;
  texture.valid_band = band(texture.source_origin_m, texture.signal.length_m());
  return texture;
}

}  // namespace tacto::spatial
