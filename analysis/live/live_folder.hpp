// SPDX-License-Identifier: GPL-3.0-or-later
// The textures and recordings of a folder and their spectrograms, by index: the page never names a path.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/live/live_shape.hpp"
#include "analysis/live/live_spectrogram.hpp"
#include "analysis/live/live_texture.hpp"
#include "data-schema/report/report.hpp"

namespace tacto::analysis {

/// The values that were used last, by numbers that are not used again.
template <class Value, std::size_t most>
class LastUsed {
 public:
  std::size_t add(Value value) {
    values_.emplace_back(next_, std::make_shared<const Value>(std::move(value)));
    if (values_.size() > most) values_.erase(values_.begin());
    return next_++;
  }
  /// Null if there is none of this number, or none any more.
  std::shared_ptr<const Value> find(std::size_t number) {
    const auto found = std::ranges::find(values_, number, &Numbered::first);
    if (found == values_.end()) return nullptr;
    std::rotate(found, found + 1, values_.end());
    return values_.back().second;
  }

 private:
  using Numbered = std::pair<std::size_t, std::shared_ptr<const Value>>;
  std::vector<Numbered> values_;
  std::size_t next_ = 0;
};

class LiveFolder {
 public:
  LiveFolder(std::string folder, std::string transducer)
      : folder_(std::move(folder)), transducer_(std::move(transducer)) {}
  LiveFolder(const LiveFolder&) = delete;
  LiveFolder& operator=(const LiveFolder&) = delete;
  /// Removes the shapes.
  ~LiveFolder();

  const std::string& folder() const { return folder_; }
  /// A stem in the folder: NAME, or NAME-2, NAME-3 ..., the first one that is free. Errors: cannot_write.
  schema::Result<std::string> free_stem(const std::string& name,
                                        const std::function<bool(const std::string& stem)>& is_free) const;
  /// Reads the folder again, and the textures and recordings in it that are new or have changed. What was
  /// listed before keeps its index.
  void refresh();
  /// JSON: `textures`, by name: index, name, length, RMS, unit, surface, time of the file; `recordings`:
  /// duration, rate, channels, strokes and missing frames instead of length, RMS and unit; one that can't be
  /// read has the reason. `reason`: why the folder can't be read.
  std::string list_json() const;
  /// A small picture: as LiveTexture::map, in kThumbnailColumns; of a recording along time, of the first
  /// channel of which a texture can be made. Errors: not_found, also for what can't be read and for a
  /// recording of more than kMostDrawn frames.
  schema::Result<std::vector<float>> thumbnail(std::size_t index) const;
  /// The full name of a sidecar. Errors: not_found.
  schema::Result<std::string> file(std::size_t index) const;
  /// The same as the folder was named, for a command line. Errors: not_found.
  schema::Result<std::string> named_file(std::size_t index) const;
  /// The texture with this full name, by its stem or a file, if it is of this folder: its map, as
  /// LiveTexture::map. Errors: not_found; as read_texture.
  schema::Result<std::vector<float>> map_of(const std::string& full_name) const;
  /// Prepares a texture from its files as they are now, under a new number. Errors: not_found; as
  /// make_live_texture.
  schema::Result<std::size_t> make(std::size_t index, const std::optional<std::string>& inverse);
  /// One of the last kMostMade textures that were made. Errors: not_found.
  schema::Result<std::shared_ptr<const LiveTexture>> made(std::size_t number);
  /// As make_change(), by the numbers of both. Errors: as made() and make_change().
  schema::Result<LiveChange> change(std::size_t playing, std::size_t next, double times);
  /// Makes the spectrogram of a texture from its files as they are now, under a new number. Errors:
  /// not_found; as make_live_spectrogram.
  schema::Result<std::size_t> make_spectrogram(std::size_t index);
  /// One of the last kMostSpectrograms. Errors: not_found.
  schema::Result<std::shared_ptr<const LiveSpectrogram>> spectrogram(std::size_t number);
  /// Makes a texture of `source`, an index, "grating" or "noise", by a query of parse_shape(). It has an
  /// index like any other one, but is not listed; the last kMostShapes are kept, in a hidden folder within
  /// this one (the daemon may read there), or, if nothing can be written there, in that for temporary files.
  /// JSON: index, name, and the numbers that hold. Errors: not_found; as of parse_shape() and
  /// shaped_texture(); cannot_write.
  schema::Result<std::string> shape(std::string_view source, const std::string& query);
  /// Writes a shape into the folder, under a name that is free, and returns its sidecar. Errors: not_found;
  /// usage, for a texture that is there already; cannot_write.
  schema::Result<std::string> save(std::size_t index) const;

 private:
  static constexpr std::size_t kMostMade = 8, kMostSpectrograms = 2, kMostShapes = 8, kThumbnailColumns = 96;
  static constexpr std::uint64_t kMostDrawn = std::uint64_t{1} << 22;
  // A texture or recording of the list, as its files were at these times.
  struct Listed {
    std::string file;  // the sidecar
    std::filesystem::file_time_type sidecar_time, wav_time;
    cli::Report row;
    std::vector<float> thumbnail;
    bool shape = false;  // not of the folder
  };
  void read_again(Listed& listed, std::size_t index) const;
  static schema::Result<void> read_texture(Listed& listed);
  static schema::Result<void> read_recording(Listed& listed);

  schema::Result<ShapedTexture> make_shape(std::string_view source, const std::string& query) const;
  schema::Result<std::string> folder_of_shapes();

  std::string folder_, transducer_, reason_;
  std::string shapes_;              // their folder, once there are some
  std::deque<std::size_t> shaped_;  // their indices
  std::vector<Listed> listed_;      // by index
  LastUsed<LiveTexture, kMostMade> made_;
  LastUsed<LiveSpectrogram, kMostSpectrograms> spectrograms_;
};

/// The figures of a texture, for the page: a JSON object.
std::string figures_json(std::size_t made, const LiveTexture& texture);

}  // namespace tacto::analysis
