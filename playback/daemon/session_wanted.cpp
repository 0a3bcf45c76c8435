// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/daemon/session_wanted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "data-schema/texture.hpp"
#include "data-schema/texture_wav.hpp"
#include "playback/daemon/played_ends.hpp"
#include "playback/daemon/texture_mix.hpp"
#include "playback/reference/spatial_content.hpp"
#include "playback/reference/wanted.hpp"

namespace tacto::playback {
namespace {

using schema::fail;
using schema::Fault;
using schema::Result;
using schema::SessionTexture;

// Where the count changes the finger is between the two, half a tick ago; until the next change it goes on
// from there. The counts themselves are a staircase, which nobody wanted to be felt.
FingerPath path_of(const SessionColumns& columns) {
  const std::vector<double>& x = columns.position_m;
  const double rate_hz = columns.header.rate_hz;
  FingerPath path{{0}, {x.front()}};
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (x[i] == x[i - 1]) continue;
    path.time_s.push_back((static_cast<double>(i) - 0.5) / rate_hz);
    path.position_m.push_back(0.5 * (x[i - 1] + x[i]));
  }
  path.time_s.push_back(std::max(static_cast<double>(x.size() - 1), 0.5) / rate_hz);
  path.position_m.push_back(path.position_m.back());
  if (path.position_m.size() > 2) path.position_m.front() = path.position_m[1];
  return path;
}

Result<schema::Texture> same_texture(const SessionTexture& played) {
  auto texture = schema::read_texture(played.file);
  if (!texture) return texture;
  const auto wav = schema::texture_wav(played.file);
  if (wav && wav->sha256 == played.sha256) return texture;
  return fail(Fault::unsuitable, "is not what was played any more", played.file);
}

// A part that begins or ends between two rows goes evenly.
class PartOfReadings {
 public:
  PartOfReadings(const MixedSet& set, const std::vector<double>& gain, double delay_rows, double per_row)
      : set_(set), gain_(gain), delay_rows_(delay_rows), per_row_(per_row) {}

  /// Readings outside [first, last) have no part of it.
  std::size_t first() const { return set_.first == 0 ? 0 : reading_of(static_cast<double>(set_.first) - 1); }
  std::size_t last(std::size_t readings) const {
    const std::size_t end = set_.first + set_.part.size();
    return end == gain_.size() ? readings : std::min(readings, reading_of(static_cast<double>(end) + 1));
  }
  double operator()(std::size_t reading) const {
    const double row = std::max(0.0, static_cast<double>(reading) / per_row_ - delay_rows_);
    const auto whole = static_cast<std::size_t>(row);
    return std::lerp(in_row(whole), in_row(whole + 1), row - std::floor(row));
  }

 private:
  std::size_t reading_of(double row) const {
    return static_cast<std::size_t>(std::max(0.0, (row + delay_rows_) * per_row_));
  }
  double in_row(std::size_t row) const {
    row = std::min(row, gain_.size() - 1);
    const bool has_part = row >= set_.first && row - set_.first < set_.part.size();
    return has_part ? gain_[row] * double{set_.part[row - set_.first]} : 0;
  }

  const MixedSet& set_;
  const std::vector<double>& gain_;
  double delay_rows_, per_row_;
};

class Judge {
 public:
  explicit Judge(const SessionColumns& columns) : columns_(columns), path_(path_of(columns)) {
    const auto [nearest, farthest] = std::ranges::minmax_element(path_.position_m);
    nearest_m_ = *nearest, farthest_m_ = *farthest;
  }

  SessionWanted wanted() {
    look_at_sets();
    const TextureMix mix = texture_mix(columns_, known_);
    const schema::SessionHeader& header = columns_.header;
    const spatial::Band band{header.low_hz, header.high_hz};
    const ReadingGrid grid =
        reading_grid(path_.duration_s(), header.rate_hz, band, greatest_speed_mps(path_) * finest_per_m_);
    std::vector<double> readings = mixed(mix, grid);
    wanted_.displacement_m = signal_of(wanted_of_readings(std::move(readings), grid, band, 0));
    wanted_.displacement_m.resize(columns_.tick.size());
    wanted_.unknown = felt(mix.unknown);
    return std::move(wanted_);
  }

 private:
  std::span<const SessionTexture> textures_of(std::size_t set) const {
    if (set == 0) return columns_.header.textures;
    return columns_.turns[set - 1].brings->textures;
  }
  void note(std::string words) {
    if (std::ranges::find(wanted_.notes, words) == wanted_.notes.end())
      wanted_.notes.push_back(std::move(words));
  }

  // Which sets there are, and how fine they are. They are not kept: a session may name any number.
  void look_at_sets() {
    for (std::size_t set = 0; set <= columns_.turns.size(); ++set) {
      known_.push_back(set == 0 || columns_.turns[set - 1].brings);
      if (!known_[set]) {
        note_of_turn(set);
        continue;
      }
      for (const SessionTexture& played : textures_of(set)) look_at(played, set);
    }
  }
  void look_at(const SessionTexture& played, std::size_t set) {
    const auto texture = same_texture(played);
    const auto there = texture ? as_played(*texture, played, nearest_m_, farthest_m_)
                               : Result<PlayedSignal>(schema::forward_error(texture));
    known_[set] = known_[set] && there;
    if (!there) return note(schema::message(there.error()));
    finest_per_m_ = std::max(finest_per_m_, highest_spatial_frequency(texture->signal));
  }
  // Told once, of those that follow each other.
  void note_of_turn(std::size_t set) {
    if (set > 1 && !columns_.turns[set - 2].brings) return;
    note(fmt::format("the texture changes at {:.3f} s: strokes that reach beyond are not judged{}",
                     columns_.time_s[columns_.turns[set - 1].row], is_named_again_after(set)));
  }
  std::string is_named_again_after(std::size_t set) const {
    for (; set < columns_.turns.size(); ++set)
      if (columns_.turns[set].brings)
        return fmt::format(", up to the change at {:.3f} s", columns_.time_s[columns_.turns[set].row]);
    return {};
  }

  std::vector<double> mixed(const TextureMix& mix, const ReadingGrid& grid) {
    const std::vector<double> places = reading_places(path_, grid);
    const std::vector<double> gain = followed_gain(columns_);
    std::vector<double> readings(places.size(), 0.0);
    for (std::size_t set = 0; set < mix.sets.size(); ++set) {
      if (mix.sets[set].part.empty()) continue;
      const PartOfReadings part(mix.sets[set], gain, columns_.look_ahead_ticks,
                                static_cast<double>(grid.oversampling));
      for (const SessionTexture& played : textures_of(set)) add(played, part, places, readings);
    }
    return readings;
  }
  void add(const SessionTexture& played, const PartOfReadings& part, std::span<const double> places,
           std::span<double> readings) {
    const auto texture = same_texture(played);
    if (!texture) return note(schema::message(texture.error()));
    const auto signal = as_played(*texture, played, nearest_m_, farthest_m_);
    if (!signal) return note(schema::message(signal.error()));
    const TextureLookup lookup(signal->signal, signal->at_m);
    for (std::size_t i = part.first(), last = part.last(places.size()); i < last; ++i)
      readings[i] += part(i) * played.gain_m_per_n * lookup(places[i]);
  }

  // What a row's drive is of is felt later.
  std::vector<bool> felt(const std::vector<bool>& driven) const {
    const auto delay = static_cast<std::size_t>(std::ceil(columns_.look_ahead_ticks));
    std::vector<bool> unknown = driven;
    for (std::size_t row = 0; row < driven.size(); ++row)
      for (std::size_t later = 1; driven[row] && later <= delay && row + later < driven.size(); ++later)
        unknown[row + later] = true;
    return unknown;
  }

  const SessionColumns& columns_;
  FingerPath path_;
  double nearest_m_ = 0, farthest_m_ = 0, finest_per_m_ = 0;
  std::vector<bool> known_;  // a set of textures
  SessionWanted wanted_;
};

}  // namespace

SessionWanted wanted_in(const SessionColumns& columns) {
  return Judge(columns).wanted();
}

}  // namespace tacto::playback
