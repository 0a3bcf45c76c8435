// SPDX-License-Identifier: GPL-3.0-or-later
// The textures and recordings of a folder and their spectrograms, by index: the page never names a path.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "analysis/live/live_spectrogram.hpp"
#include "analysis/live/live_texture.hpp"
#include "data-schema/report/report.hpp"

namespace tacto::analysis {

/// The newest values, by numbers that are not used again.
template <class Value, std::size_t most>
class NewestValues {
 public:
  std::size_t add(Value value) {
    values_.emplace(next_, std::make_shared<const Value>(std::move(value)));
    if (values_.size() > most) values_.erase(values_.begin());
    return next_++;
  }
  /// Null if there is none of this number, or none any more.
  std::shared_ptr<const Value> find(std::size_t number) const {
    const auto found = values_.find(number);
    return found == values_.end() ? nullptr : found->second;
  }

 private:
  std::map<std::size_t, std::shared_ptr<const Value>> values_;
  std::size_t next_ = 0;
};

class LiveFolder {
 public:
  LiveFolder(std::string folder, std::string transducer)
      : folder_(std::move(folder)), transducer_(std::move(transducer)) {}

  const std::string& folder() const { return folder_; }
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
  schema::Result<std::size_t> make(std::size_t index);
  /// One of the last kMostMade textures that were made. Errors: not_found.
  schema::Result<std::shared_ptr<const LiveTexture>> made(std::size_t number) const;
  /// As make_change(), by the numbers of both. Errors: as made() and make_change().
  schema::Result<LiveChange> change(std::size_t playing, std::size_t next, double times) const;
  /// Makes the spectrogram of a texture from its files as they are now, under a new number. Errors:
  /// not_found; as make_live_spectrogram.
  schema::Result<std::size_t> make_spectrogram(std::size_t index);
  /// One of the last kMostSpectrograms. Errors: not_found.
  schema::Result<std::shared_ptr<const LiveSpectrogram>> spectrogram(std::size_t number) const;

 private:
  static constexpr std::size_t kMostMade = 4, kMostSpectrograms = 2, kThumbnailColumns = 96;
  static constexpr std::uint64_t kMostDrawn = std::uint64_t{1} << 22;
  // A texture or recording of the list, as its files were at these times.
  struct Listed {
    std::string file;  // the sidecar
    std::filesystem::file_time_type sidecar_time, wav_time;
    cli::Report row;
    std::vector<float> thumbnail;
  };
  void read_again(Listed& listed, std::size_t index) const;
  static schema::Result<void> read_texture(Listed& listed);
  static schema::Result<void> read_recording(Listed& listed);

  std::string folder_, transducer_, reason_;
  std::vector<Listed> listed_;  // by index
  NewestValues<LiveTexture, kMostMade> made_;
  NewestValues<LiveSpectrogram, kMostSpectrograms> spectrograms_;
};

/// The figures of a texture, for the page: a JSON object.
std::string figures_json(std::size_t made, const LiveTexture& texture);

}  // namespace tacto::analysis
