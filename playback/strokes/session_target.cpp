// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/strokes/session_target.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data-schema/texture/texture_wav.hpp"
#include "playback/model/spatial_content.hpp"
#include "playback/render/loop_seam.hpp"
#include "playback/render/reference/exact_target.hpp"

namespace tacto::playback {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;
using schema::SessionTexture;

// At a change of the count the finger is between both counts, half a tick earlier; these points are the knots
// of its path. The counts themselves form a staircase, which is not a part of the target.
FingerPath path_of(std::span<const JudgedRow> rows, double rate_hz) {
  const auto x = [&](std::size_t i) { return rows[i].row.position_m; };
  FingerPath path{{0}, {x(0)}};
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (x(i) == x(i - 1)) continue;
    path.time_s.push_back((static_cast<double>(i) - 0.5) / rate_hz);
    path.position_m.push_back(0.5 * (x(i - 1) + x(i)));
  }
  path.time_s.push_back(std::max(static_cast<double>(rows.size() - 1), 0.5) / rate_hz);
  path.position_m.push_back(path.position_m.back());
  if (path.position_m.size() > 2) path.position_m.front() = path.position_m[1];
  return path;
}

TextureMix mix_of(std::span<const JudgedRow> rows, const std::vector<bool>& known) {
  std::vector<MixRow> mix(rows.size());
  std::ranges::transform(rows, mix.begin(), &JudgedRow::mix);
  return texture_mix(mix, known);
}

// Marks also the rows that follow within the look-ahead, because they contain the drive of these rows.
std::vector<bool> at_finger(const std::vector<bool>& driven, double look_ahead_ticks) {
  const auto delay = static_cast<std::size_t>(std::ceil(look_ahead_ticks));
  std::vector<bool> unknown = driven;
  for (std::size_t row = 0; row < driven.size(); ++row)
    for (std::size_t later = 1; driven[row] && later <= delay && row + later < driven.size(); ++later)
      unknown[row + later] = true;
  return unknown;
}

}  // namespace

Result<schema::Texture> same_texture(const SessionTexture& played) {
  auto texture = schema::read_texture(played.file);
  if (!texture) return texture;
  const auto wav = schema::texture_wav(played.file);
  if (wav && wav->sha256 == played.sha256) return texture;
  return fail(ErrorKind::unsuitable, "has changed since it was played", played.file);
}

// The part of a set is linear between two rows.
class TargetReader::PartOfReadings {
 public:
  /// Delays in rows: `delay_rows` of the texture that is read for a tick, `drive_delay_rows` of its envelope.
  PartOfReadings(const MixedSet& set, std::span<const JudgedRow> rows, double delay_rows,
                 double drive_delay_rows, double per_row)
      : set_(set),
        rows_(rows),
        delay_rows_(delay_rows),
        drive_delay_rows_(drive_delay_rows),
        per_row_(per_row) {}

  /// Readings outside [first, last) do not contain the set.
  std::size_t first() const { return set_.first == 0 ? 0 : reading_of(static_cast<double>(set_.first) - 1); }
  std::size_t last(std::size_t readings) const {
    const std::size_t end = set_.first + set_.part.size();
    return end == rows_.size() ? readings : std::min(readings, reading_of(static_cast<double>(end) + 1));
  }
  double operator()(std::size_t reading) const {
    const double finger_rows = static_cast<double>(reading) / per_row_,
                 row = std::max(0.0, finger_rows - delay_rows_);
    return envelope(std::max(0.0, finger_rows - drive_delay_rows_)) *
           between(row, [this](std::size_t i) { return in_row(i); });
  }

 private:
  template <class Value>
  static double between(double row, Value value) {
    const auto whole = static_cast<std::size_t>(row);
    return std::lerp(value(whole), value(whole + 1), row - std::floor(row));
  }
  // The kernel applies the envelope to the drive itself, after the filter for which it looks ahead.
  double envelope(double row) const {
    return between(row, [this](std::size_t i) { return rows_[std::min(i, rows_.size() - 1)].envelope; });
  }
  std::size_t reading_of(double row) const {
    return static_cast<std::size_t>(std::max(0.0, (row + delay_rows_) * per_row_));
  }
  double in_row(std::size_t row) const {
    row = std::min(row, rows_.size() - 1);
    const bool has_part = row >= set_.first && row - set_.first < set_.part.size();
    return has_part ? rows_[row].followed_gain * double{set_.part[row - set_.first]} : 0;
  }

  const MixedSet& set_;
  std::span<const JudgedRow> rows_;
  double delay_rows_, drive_delay_rows_, per_row_;
};

TargetReader::TargetReader(const SessionOverview& overview) : overview_(overview) {
  sets_.push_back(&overview.header.textures);
  reaches_.push_back(overview.reach);
  for (const SteeringStep& step : overview.steps) {
    if (!step.turn) continue;
    sets_.push_back(step.turn->brings ? &step.turn->brings->textures : nullptr);
    reaches_.push_back(step.turn->reach);
  }
  set_notes_.resize(sets_.size());
  std::map<Key, std::string> faults;
  for (std::size_t set = 0; set < sets_.size(); ++set) known_.push_back(check_device(set, faults));
}

bool TargetReader::check_device(std::size_t set, std::map<Key, std::string>& faults) {
  if (sets_[set] == nullptr) return false;
  for (const SessionTexture& played : *sets_[set]) {
    const auto [seen, first] = faults.try_emplace({played.file, played.sha256});
    if (first)
      if (const auto texture = same_texture(played); !texture)
        seen->second = schema::message(texture.error());
    if (!seen->second.empty()) set_notes_[set].push_back(seen->second);
  }
  return set_notes_[set].empty();
}

void TargetReader::note(std::string words) {
  if (std::ranges::find(notes_, words) == notes_.end()) notes_.push_back(std::move(words));
}

// Consecutive changes without names give one note.
std::vector<std::string> TargetReader::notes(std::span<const TextureChange> turns) const {
  std::vector<std::string> all;
  const auto add = [&](const std::string& words) {
    if (std::ranges::find(all, words) == all.end()) all.push_back(words);
  };
  const auto is_named_again_after = [&](std::size_t set) {
    for (; set < turns.size(); ++set)
      if (turns[set].brings) return fmt::format(", up to the change at {:.3f} s", turns[set].time_s);
    return std::string();
  };
  for (std::size_t set = 0; set <= turns.size(); ++set) {
    for (const std::string& words : set_notes_[set]) add(words);
    const bool follows_another = set > 1 && !turns[set - 2].brings;
    if (sets_[set] == nullptr && !follows_another)
      add(fmt::format("the texture changes at {:.3f} s: strokes that end later are not judged{}",
                      turns[set - 1].time_s, is_named_again_after(set)));
  }
  for (const std::string& words : notes_) add(words);
  return all;
}

Result<const ReadAgain*> TargetReader::read_again(const SessionTexture& played) {
  const Key key{played.file, played.sha256};
  auto at = kept_.find(key);
  if (at == kept_.end()) {
    auto texture = same_texture(played);
    TACTO_TRY(texture);
    const double finest_per_m = highest_spatial_frequency(texture->signal);
    at = kept_.emplace(key, ReadAgain{std::move(*texture), finest_per_m, true}).first;
  }
  at->second.used = true;
  return &at->second;
}

void TargetReader::forget_unused() {
  for (auto at = kept_.begin(); at != kept_.end();)
    at = std::exchange(at->second.used, false) ? std::next(at) : kept_.erase(at);
}

double TargetReader::finest_in(const TextureMix& mix, bool& sound) {
  double finest_per_m = 0;
  for (std::size_t set = 0; set < mix.sets.size(); ++set) {
    if (mix.sets[set].part.empty()) continue;
    for (const SessionTexture& played : *sets_[set]) {
      const auto texture = read_again(played);
      sound = sound && texture;
      if (texture) finest_per_m = std::max(finest_per_m, (*texture)->finest_per_m);
      if (!texture) note(schema::message(texture.error()));
    }
  }
  return finest_per_m;
}

bool TargetReader::add(const SessionTexture& played, const PartOfReadings& part,
                       std::span<const double> places, std::span<double> readings) {
  const auto texture = read_again(played);
  if (!texture) return false;  // finest_in() has reported the error
  const auto [nearest, farthest] = std::ranges::minmax(places);
  const auto signal = as_played((*texture)->texture, played.at_m, {ends_of(played.ends), played.seam_m},
                                nearest, farthest, played.file);
  if (!signal) return note(schema::message(signal.error())), false;
  const TextureLookup lookup(signal->signal, signal->at_m);
  for (std::size_t i = part.first(), last = part.last(places.size()); i < last; ++i)
    readings[i] += part(i) * played.gain_m_per_n * lookup(places[i]);
  return true;
}

std::vector<double> TargetReader::mixed(std::span<const JudgedRow> rows, const TextureMix& mix,
                                        const ReadingGrid& grid, const FingerPath& path, bool& sound) {
  const std::vector<double> places = reading_places(path, grid);
  std::vector<double> readings(places.size(), 0.0);
  for (std::size_t set = 0; set < mix.sets.size(); ++set) {
    if (mix.sets[set].part.empty()) continue;
    const double drive_delay_rows = drive_delay_s(overview_.header) * overview_.header.rate_hz;
    const PartOfReadings part(mix.sets[set], rows, overview_.look_ahead_ticks, drive_delay_rows,
                              static_cast<double>(grid.oversampling));
    for (const SessionTexture& played : *sets_[set]) sound = add(played, part, places, readings) && sound;
  }
  return readings;
}

bool TargetReader::reaches(const JudgedRow& row) const {
  const bool fades = row.mix.leaving_part > 0;
  return reaches_[row.mix.playing].holds(row.row.encoder) &&
         (!fades || reaches_[row.mix.leaving].holds(row.row.encoder));
}

// A loop is endless in the scene; in a device it ends at the range of its numbers.
std::vector<bool> TargetReader::driven_by_unknown(std::span<const JudgedRow> rows, const TextureMix& mix) {
  std::vector<bool> unknown = mix.unknown;
  const JudgedRow* beyond = nullptr;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (reaches(rows[i])) continue;
    unknown[i] = true;
    beyond = &rows[i];
  }
  if (beyond != nullptr) note_reach(reaches_[beyond->mix.playing]);
  return unknown;
}

void TargetReader::note_reach(const ProfileReach& reach) {
  const double reach_m = std::abs(overview_.header.metres_per_count) * static_cast<double>(reach.counts);
  note(
      fmt::format("the finger moved farther than {:.4g} m from the encoder's zero, where the device reads no "
                  "texture and its drive is 0 V: strokes there are not judged",
                  reach_m));
}

SessionTarget TargetReader::target_in(std::span<const JudgedRow> rows) {
  const schema::SessionHeader& header = overview_.header;
  const TextureMix mix = mix_of(rows, known_);
  const FingerPath path = path_of(rows, header.rate_hz);
  bool sound = true;
  const double finest_hz = greatest_speed_mps(path) * finest_in(mix, sound);
  const spatial::Band band{header.low_hz, header.high_hz};
  const ReadingGrid grid = reading_grid(path.duration_s(), header.rate_hz, band, finest_hz);
  auto readings = mixed(rows, mix, grid, path, sound);
  Rests rests;
  if (begins_at_rest(rows)) rests.start = 0;
  if (ends_at_rest(rows)) rests.end = 0;
  forget_unused();
  SessionTarget target{signal_of(target_of_readings(std::move(readings), grid, band, 0, rests)),
                       at_finger(driven_by_unknown(rows, mix), overview_.look_ahead_ticks)};
  target.displacement_m.resize(rows.size());
  if (!sound) target.unknown.assign(rows.size(), true);
  return target;
}

}  // namespace tacto::playback
