// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/live/live_folder.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <set>

#include "data-schema/recording/recording.hpp"
#include "data-schema/texture/texture.hpp"
#include "playback/wasm/browser_board.hpp"

namespace tacto::analysis {
namespace {

namespace fs = std::filesystem;

using schema::Result;

constexpr std::string_view kTexture = ".texture", kJson = ".json", kWav = ".wav";

bool is_texture(const std::string& sidecar) {
  return fs::path(sidecar).stem().extension() == kTexture;
}

std::string name_of(const std::string& sidecar) {
  const fs::path name = fs::path(sidecar).filename().stem();
  return (is_texture(sidecar) ? name.stem() : name).string();
}

std::string wav_of(const std::string& sidecar) {
  return fs::path(sidecar).replace_extension(kWav).string();
}

// The earliest time if there is no such file.
fs::file_time_type time_of(const std::string& file) {
  std::error_code failed;
  const auto time = fs::last_write_time(file, failed);
  return failed ? fs::file_time_type::min() : time;
}

double unix_s(fs::file_time_type time) {
  return std::chrono::duration<double>(std::chrono::file_clock::to_sys(time).time_since_epoch()).count();
}

}  // namespace

void LiveFolder::read_again(Listed& listed, std::size_t index) const {
  listed.sidecar_time = time_of(listed.file);
  listed.wav_time = time_of(wav_of(listed.file));
  listed.row = cli::Report();
  listed.row.add("index", index).add("name", name_of(listed.file));
  listed.thumbnail.clear();
  const auto read = is_texture(listed.file) ? read_texture(listed) : read_recording(listed);
  if (!read)
    listed.row.add("reason", schema::message(read.error()));
  else
    listed.row.add("changed_s", unix_s(std::max(listed.sidecar_time, listed.wav_time)));
}

Result<void> LiveFolder::read_texture(Listed& listed) {
  const auto texture = schema::read_texture(listed.file);
  TACTO_TRY(texture);
  const schema::SpaceSignal& signal = texture->signal;
  listed.row.add("length_m", signal.pitch_m * static_cast<double>(signal.values.size()))
      .add("rms", rms_about_mean(signal.values))
      .add("unit", texture->unit)
      .add("surface", texture->surface);
  listed.thumbnail = texture_map(signal.values, kThumbnailColumns);
  return {};
}

Result<void> LiveFolder::read_recording(Listed& listed) {
  const auto recording = schema::open_recording(listed.file);
  TACTO_TRY(recording);
  const schema::RecordingHeader& header = recording->header;
  std::vector<std::string> channels;
  for (const schema::Channel& channel : header.channels) channels.push_back(channel.name);
  std::uint64_t missing = 0;
  for (const schema::Gap& gap : header.gaps) missing += gap.count;
  listed.row.add("duration_s", schema::duration_s(header))
      .add("sample_rate_hz", header.sample_rate_hz)
      .add("channels", std::move(channels))
      .add("strokes", header.strokes.size())
      .add("missing_frames", missing)
      .add("surface", header.surface);
  return {};
}

// A WAV without its sidecar is listed, too: as one that can't be read. Other JSON files are not.
void LiveFolder::refresh() {
  std::set<std::string> found;
  std::error_code failed;
  for (fs::directory_iterator at(folder_, failed), end; !failed && at != end; at.increment(failed)) {
    std::error_code ignored;
    fs::path path = at->path();
    if (!at->is_regular_file(ignored) || path.filename().string().starts_with(".")) continue;
    if (path.extension() == kWav)
      found.insert(path.replace_extension(kJson).string());
    else if (path.extension() == kJson && is_texture(path.string()))
      found.insert(path.string());
  }
  reason_ = failed ? failed.message() : std::string();
  for (const std::string& path : found)
    if (std::ranges::find(listed_, path, &Listed::file) == listed_.end())
      listed_.push_back({path, {}, {}, {}, {}, false});
  for (std::size_t i = 0; i < listed_.size(); ++i)
    if (Listed& one = listed_[i];
        one.sidecar_time != time_of(one.file) || one.wav_time != time_of(wav_of(one.file)) || one.row.empty())
      read_again(one, i);
}

std::string LiveFolder::list_json() const {
  std::vector<const Listed*> by_name;
  for (const Listed& one : listed_)
    if (!one.shape && std::max(one.sidecar_time, one.wav_time) > fs::file_time_type::min())
      by_name.push_back(&one);
  std::ranges::sort(by_name, {}, &Listed::file);
  std::vector<cli::Report> textures, recordings;
  for (const Listed* const one : by_name) (is_texture(one->file) ? textures : recordings).push_back(one->row);
  cli::Report list;
  list.add("textures", std::move(textures)).add("recordings", std::move(recordings));
  if (!reason_.empty()) list.add("reason", reason_);
  return list.json();
}

Result<std::vector<float>> LiveFolder::thumbnail(std::size_t index) const {
  if (index < listed_.size() && !listed_[index].thumbnail.empty()) return listed_[index].thumbnail;
  if (index < listed_.size() && !is_texture(listed_[index].file))
    if (const auto recording = schema::open_recording(listed_[index].file);
        recording && recording->header.frames > 0 && recording->header.frames <= kMostDrawn) {
      const auto drawn = schema::texture_channels(recording->header);
      const auto channel = schema::read_channel(*recording, drawn.empty() ? 0 : drawn.front());
      if (channel) return texture_map(channel->values, kThumbnailColumns);
    }
  return schema::fail(schema::ErrorKind::not_found, "there is no picture of this index",
                      std::to_string(index), "load the page again");
}

Result<std::string> LiveFolder::file(std::size_t index) const {
  const auto named = named_file(index);
  TACTO_TRY(named);
  return fs::absolute(*named).lexically_normal().string();
}

Result<std::string> LiveFolder::named_file(std::size_t index) const {
  if (index < listed_.size()) return listed_[index].file;
  return schema::fail(schema::ErrorKind::not_found, "there is no texture or recording of this index",
                      std::to_string(index), "load the page again");
}

Result<std::vector<float>> LiveFolder::map_of(const std::string& full_name) const {
  for (const Listed& listed : listed_) {
    const std::string& own = listed.file;
    std::error_code ignored;
    const std::string sidecar = schema::stem_of(full_name, kTexture) + ".texture.json";
    if (!fs::path(full_name).is_absolute() || !fs::equivalent(own, sidecar, ignored)) continue;
    const auto texture = schema::read_texture(own);
    TACTO_TRY(texture);
    return texture_map(texture->signal.values);
  }
  return schema::fail(schema::ErrorKind::not_found, "is no texture of this folder", full_name,
                      "start tactograph live with the folder of the daemon's textures");
}

Result<std::size_t> LiveFolder::make(std::size_t index, const std::optional<std::string>& inverse) {
  const auto own = file(index);
  TACTO_TRY(own);
  auto texture = make_live_texture(*own, transducer_, inverse);
  TACTO_TRY(texture);
  texture->session_stem = fs::absolute(fs::path(folder_) / name_of(*own)).lexically_normal().string();
  return made_.add(std::move(*texture));
}

Result<std::shared_ptr<const LiveTexture>> LiveFolder::made(std::size_t number) {
  if (auto found = made_.find(number)) return found;
  return schema::fail(schema::ErrorKind::not_found, "this texture is not prepared any more",
                      std::to_string(number), "choose it again");
}

Result<LiveChange> LiveFolder::change(std::size_t playing, std::size_t next, double times) {
  const auto from = made(playing);
  TACTO_TRY(from);
  const auto to = made(next);
  TACTO_TRY(to);
  return make_change(**from, **to, times);
}

Result<std::size_t> LiveFolder::make_spectrogram(std::size_t index) {
  const auto own = file(index);
  TACTO_TRY(own);
  auto spectrogram = make_live_spectrogram(*own);
  TACTO_TRY(spectrogram);
  return spectrograms_.add(std::move(*spectrogram));
}

Result<std::shared_ptr<const LiveSpectrogram>> LiveFolder::spectrogram(std::size_t number) {
  if (auto found = spectrograms_.find(number)) return found;
  return schema::fail(schema::ErrorKind::not_found, "this spectrogram is not there any more",
                      std::to_string(number), "choose its texture again");
}

LiveFolder::~LiveFolder() {
  std::error_code ignored;
  if (!shapes_.empty()) fs::remove_all(shapes_, ignored);
}

Result<ShapedTexture> LiveFolder::make_shape(std::string_view source, const std::string& query) const {
  const auto shape = parse_shape(query);
  TACTO_TRY(shape);
  if (source == "grating") return grating_texture(*shape);
  if (source == "noise") return noise_texture(*shape);
  std::size_t index = listed_.size();
  const auto [end, failed] = std::from_chars(source.data(), source.data() + source.size(), index);
  if (failed != std::errc() || end != source.data() + source.size() || index >= listed_.size() ||
      listed_[index].shape)
    return schema::fail(schema::ErrorKind::not_found, "there is no texture of this index",
                        std::string(source), "load the page again");
  auto shaped = shaped_texture(listed_[index].file, *shape);
  if (shaped) shaped->ending = name_of(listed_[index].file) + shaped->ending;
  return shaped;
}

Result<std::string> LiveFolder::folder_of_shapes() {
  if (!shapes_.empty()) return shapes_;
  std::error_code ignored;
  for (const fs::path& within : {fs::absolute(folder_), fs::temp_directory_path(ignored)}) {
    std::string made = (within / ".tactograph-live-XXXXXX").string();
    if (mkdtemp(made.data()) == nullptr) continue;
    fs::permissions(made, fs::perms(0755), ignored);
    return shapes_ = made;
  }
  return schema::fail(schema::ErrorKind::cannot_write, "no folder can be made here", folder_,
                      "free some space, or get the permission to write");
}

Result<std::string> LiveFolder::shape(std::string_view source, const std::string& query) {
  const auto shaped = make_shape(source, query);
  TACTO_TRY(shaped);
  const auto within = folder_of_shapes();
  TACTO_TRY(within);
  const std::size_t index = listed_.size();
  const auto folder_of = [&](std::size_t one) { return fs::path(*within) / std::to_string(one); };
  const std::string stem = (folder_of(index) / shaped->ending).string();
  schema::PendingFiles pending;
  TACTO_TRY(schema::add_texture(pending, stem, shaped->texture));
  TACTO_TRY(pending.commit(schema::Existing::replace, schema::Sync::by_caller));  // it is temporary
  listed_.push_back({stem + ".texture.json", {}, {}, {}, {}, true});
  shaped_.push_back(index);
  if (shaped_.size() > kMostShapes) {
    std::error_code ignored;
    fs::remove_all(folder_of(shaped_.front()), ignored);
    shaped_.pop_front();
  }
  cli::Report row = shaped->effective;
  return row.add("index", index).add("name", shaped->ending).json();
}

Result<std::string> LiveFolder::save(std::size_t index) const {
  const auto own = file(index);
  TACTO_TRY(own);
  if (!listed_[index].shape) return schema::fail(schema::ErrorKind::usage, "is in the folder already", *own);
  const auto texture = schema::read_texture(*own);
  TACTO_TRY(texture);
  const auto stem = free_stem(
      name_of(*own), [](const std::string& one) { return schema::check_texture_free(one).has_value(); });
  TACTO_TRY(stem);
  schema::PendingFiles pending;
  TACTO_TRY(schema::add_texture(pending, *stem, *texture));
  TACTO_TRY(pending.commit(schema::Existing::keep));
  return *stem + ".texture.json";
}

Result<std::string> LiveFolder::free_stem(const std::string& name,
                                          const std::function<bool(const std::string& stem)>& is_free) const {
  constexpr int kTried = 1000;
  for (int i = 1; i <= kTried; ++i) {
    std::string stem = (fs::path(folder_) / (i == 1 ? name : name + "-" + std::to_string(i))).string();
    if (is_free(stem)) return stem;
  }
  return schema::fail(schema::ErrorKind::cannot_write, "all such names are taken", name,
                      "remove or rename some of these files");
}

std::string figures_json(std::size_t made, const LiveTexture& texture) {
  const playback::Program& program = texture.program;
  const schema::Transducer& transducer = program.session.transducer;
  cli::Report figures;
  figures.add("made", made)
      .add("name", name_of(texture.file))
      .add("start_m", program.start_m)
      .add("length_m", program.length_m)
      .add("rms", texture.rms)
      .add("gain_m_per_n", double{program.prepared.gain_m_per_n})
      .add("tray_peak_m", program.tray_peak_m)
      .add("displacement_limit_m", transducer.displacement_limit_m)
      .add("drive_limit_v", double{program.prepared.limits.drive_v})
      .add("transducer", transducer.name)
      .add("rate_hz", std::int64_t{browser::kRateHz})
      .add("metres_per_count", browser::kMetresPerCount)
      .add("delay_left_s", program.prepared.delay_left_s)
      .add("passes_to_hz", program.prepared.passes_to_hz)
      .add("notes", program.prepared.notes);
  return figures.json();
}

}  // namespace tacto::analysis
