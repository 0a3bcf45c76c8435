// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the textures of a request and places them.
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
  /// For prepare(): the weights are the layers' gains relative to gain(), with their signs. The result points
  /// into this.
  std::vector<PlacedTexture> placed() const;
  /// The greatest gain without sign; it is common to all layers.
  double gain() const;
  /// The same, with its sign.
  double signed_gain() const;
  /// signed_gain() without the gain of the request: what a factor of 1 stands for.
  double default_gain() const { return default_gain_; }
  Ends ends() const;
  double start_m() const;
  double end_m() const;
  /// The textures as they are written into a session.
  const std::vector<schema::SessionTexture>& rows() const { return rows_; }
  std::size_t file_count() const { return files_.size(); }
  const std::string& scene_path() const { return scene_path_; }  ///< empty for a single texture
  /// The gain stored with the texture, if that is used.
  const std::optional<schema::PlaybackGain>& kept_gain() const { return kept_gain_; }
  const schema::PlaybackChoices& choices() const { return choices_; }  ///< the scene's
  /// Notes for the user: which files are of a newer minor version.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  friend class TextureReader;
  struct File {
    schema::Texture texture;
    std::string sum;
  };
  const schema::Texture& texture(std::size_t layer) const { return files_.at(stems_[layer]).texture; }

  std::map<std::string, File> files_;  // by stem; layers with the same file share it
  std::vector<schema::TextureLayer> layers_;
  std::vector<schema::SessionTexture> rows_;  // of the layers
  std::vector<std::string> stems_;
  std::string scene_path_;
  std::optional<schema::PlaybackGain> kept_gain_;
  double default_gain_ = 0;
  schema::PlaybackChoices choices_;
  std::vector<std::string> notes_;
};

/// An absolute path, because a session may be read from another folder.
std::string full_path(const std::string& path);

/// Whether a name is that of a scene; otherwise it is a texture.
bool names_a_scene(const std::string& file);

/// Errors: as read_texture, read_scene, served_file; usage: a place, ends, or a gain in m/N for a scene;
/// unsuitable: a scene of several textures whose ends are not `stop`, that reach over 2^24 samples, without
/// any gain, or with force patches.
schema::Result<PlacedTextures> place_textures(const ProgramRequest& request);

}  // namespace tacto::playback
