// SPDX-License-Identifier: GPL-3.0-or-later
// The textures that a request names, read and laid where they are to be felt.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "playback/player/program.hpp"

namespace tacto::playback {

class PlacedTextures {
 public:
  /// For prepare(): weights are the layers' parts of gain_m_per_n(), with their signs. They point into this.
  std::vector<PlacedTexture> placed() const;
  /// The greatest of all, without sign: the gain that they share.
  double gain() const;
  /// The same, with its sign.
  double signed_gain() const;
  Ends ends() const;
  double start_m() const;
  double end_m() const;
  /// What a session says of each.
  const std::vector<schema::SessionTexture>& rows() const { return rows_; }
  std::size_t file_count() const { return files_.size(); }
  const std::string& scene_path() const { return scene_path_; }  ///< empty for a texture by itself
  /// The texture's own gain, where it is played with that.
  const std::optional<schema::PlaybackGain>& kept_gain() const { return kept_gain_; }
  const schema::PlaybackChoices& choices() const { return choices_; }  ///< the scene's
  /// What to tell the user: which files are of a newer minor version.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  friend class TextureReader;
  struct File {
    schema::Texture texture;
    std::string sum;
  };
  const schema::Texture& texture(std::size_t layer) const { return files_.at(stems_[layer]).texture; }

  std::map<std::string, File> files_;  // by stem: layers that share one share it here
  std::vector<schema::TextureLayer> layers_;
  std::vector<schema::SessionTexture> rows_;  // of the layers
  std::vector<std::string> stems_;
  std::string scene_path_;
  std::optional<schema::PlaybackGain> kept_gain_;
  schema::PlaybackChoices choices_;
  std::vector<std::string> notes_;
};

/// From the root on: a session is read in other folders too.
std::string full_path(const std::string& path);

/// Whether a name means a scene; else it means a texture.
bool names_a_scene(const std::string& file);

/// Errors: as read_texture, read_scene, served_file; usage: a place, gain or ends for a scene; unsuitable: a
/// scene of several textures whose ends are not `stop`, that reach over 2^24 samples, or without any gain.
schema::Result<PlacedTextures> lay_textures(const ProgramRequest& request);

}  // namespace tacto::playback
