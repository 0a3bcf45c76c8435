// SPDX-License-Identifier: GPL-3.0-or-later
// The target displacement of a session.
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

struct SessionTarget {
  std::vector<double> displacement_m;  ///< one per row, in the session's band
  /// Whether a texture that is unknown has a part in the row, or the finger was outside the range that the
  /// device reads.
  std::vector<bool> unknown;
};

/// A texture of the session, read from its file again.
struct ReadAgain {
  schema::Texture texture;
  double finest_per_m = 0;
  bool used = false;  ///< in the last section
};

/// A texture of the session from its file. Errors: as read_texture; unsuitable: it has changed (by SHA-256).
schema::Result<schema::Texture> same_texture(const schema::SessionTexture& played);

/// Gain x textures along the path between the recorded counts (monotone cubics through the places where the
/// count changed), read exactly (render/reference/exact_target.hpp). Gain and changes of texture follow the
/// kernel's ramps and fades (judged_rows.hpp), and are delayed like the drive that looked ahead: by
/// look_ahead_ticks. The envelope is that of the drive (core/kernel/envelope.hpp).
class TargetReader {
 public:
  /// Reads each texture of the session once, to find those that exist. The overview must outlive this.
  explicit TargetReader(const SessionOverview& overview);

  /// For consecutive rows of one rate, at least one. Holds the textures of this section in memory.
  SessionTarget target_in(std::span<const JudgedRow> rows);
  /// Which textures are unknown, and why; `turns` are the changes of all rows.
  std::vector<std::string> notes(std::span<const TextureChange> turns) const;

 private:
  using Textures = std::vector<schema::SessionTexture>;
  using Key = std::pair<std::string, std::string>;  // file and SHA-256

  class PartOfReadings;

  bool check_device(std::size_t set, std::map<Key, std::string>& faults);
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
  std::vector<const Textures*> sets_;  // none: the session does not name them
  std::vector<bool> known_;
  std::vector<ProfileReach> reaches_;  // of the sets
  std::vector<std::vector<std::string>> set_notes_;
  std::vector<std::string> notes_;
  std::map<Key, ReadAgain> kept_;
};

}  // namespace tacto::playback
