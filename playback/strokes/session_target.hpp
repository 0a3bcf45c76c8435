// SPDX-License-Identifier: GPL-3.0-or-later
// What a session's finger was to receive.
#pragma once

#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "data-schema/texture/texture.hpp"
#include "playback/model/finger_path.hpp"
#include "playback/render/reference/exact_target.hpp"
#include "playback/strokes/judged_rows.hpp"

namespace tacto::playback {

struct SessionWanted {
  std::vector<double> displacement_m;  ///< one a row, in the session's band
  /// A row: a texture that is not known had a part in what was felt, or the finger was where the device reads
  /// none any more.
  std::vector<bool> unknown;
};

/// A texture that was played, read again.
struct ReadAgain {
  schema::Texture texture;
  double finest_per_m = 0;
  bool used = false;  ///< in the last stretch
};

/// Gain x textures along the path between the recorded counts (monotone cubics through the places where the
/// count changed), read exactly (reference/wanted.hpp). Gain and changes of texture are those that the kernel
/// follows and fades (texture_mix.hpp), felt when the drive that looked ahead is: look_ahead_ticks later. It
/// rises and falls as the drive does (core/envelope.hpp).
class WantedReader {
 public:
  /// Reads each texture that the session names once, to know which are there. The overview stays where it is.
  explicit WantedReader(const SessionOverview& overview);

  /// In consecutive rows of one rate, at least one. Holds the textures of this stretch in memory.
  SessionWanted target_in(std::span<const JudgedRow> rows);
  /// Of textures that are not known, and why; `turns` are the changes of all rows.
  std::vector<std::string> notes(std::span<const TextureTurn> turns) const;

 private:
  using Textures = std::vector<schema::SessionTexture>;
  using Key = std::pair<std::string, std::string>;  // file and SHA-256

  class PartOfReadings;

  bool look_at(std::size_t set, std::map<Key, std::string>& faults);
  schema::Result<const ReadAgain*> read_again(const schema::SessionTexture& played);
  double finest_in(const TextureMix& mix, bool& sound);
  bool add(const schema::SessionTexture& played, const PartOfReadings& part, std::span<const double> places,
           std::span<double> readings);
  std::vector<double> mixed(std::span<const JudgedRow> rows, const TextureMix& mix, const ReadingGrid& grid,
                            const FingerPath& path, bool& sound);
  void forget_unused();
  void note(std::string words);
  std::vector<bool> driven_by_unknown(std::span<const JudgedRow> rows, const TextureMix& mix);
  bool reaches(const JudgedRow& row) const;
  void note_reach(const ProfileReach& reach);

  const SessionOverview& overview_;
  std::vector<const Textures*> sets_;  // none: the session does not say
  std::vector<bool> known_;
  std::vector<ProfileReach> reaches_;  // of the sets
  std::vector<std::vector<std::string>> set_notes_;
  std::vector<std::string> notes_;
  std::map<Key, ReadAgain> kept_;
};

}  // namespace tacto::playback
