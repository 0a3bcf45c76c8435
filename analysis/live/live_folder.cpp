// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/live/live_folder.hpp"

#include <algorithm>
#include <filesystem>

#include "data-schema/report/report.hpp"
#include "data-schema/texture/texture.hpp"
#include "playback/wasm/browser_board.hpp"

namespace tacto::analysis {
namespace {

namespace fs = std::filesystem;

using schema::Result;

constexpr std::string_view kEnding = ".texture.json";

std::string name_of(const std::string& file) {
  const std::string name = fs::path(file).filename().string();
  return name.substr(0, name.size() - kEnding.size());
}

cli::Report row_of(std::size_t index, const std::string& file) {
  cli::Report row;
  row.add("index", index).add("name", name_of(file));
  const auto texture = schema::read_texture(file);
  if (!texture) return std::move(row.add("reason", schema::message(texture.error())));
  const schema::SpaceSignal& signal = texture->signal;
  row.add("length_m", signal.pitch_m * static_cast<double>(signal.values.size()));
  return row;
}

}  // namespace

void LiveFolder::refresh() {
  std::vector<std::string> found;
  std::error_code ended;
  for (fs::directory_iterator at(folder_, ended), end; !ended && at != end; at.increment(ended)) {
    std::error_code ignored;
    if (std::string path = at->path().string(); path.ends_with(kEnding) && at->is_regular_file(ignored))
      found.push_back(std::move(path));
  }
  std::ranges::sort(found);
  for (std::string& path : found)
    if (std::ranges::find(files_, path) == files_.end()) files_.push_back(std::move(path));
}

std::string LiveFolder::list_json() const {
  std::vector<std::pair<std::string, std::size_t>> by_name;
  for (std::size_t i = 0; i < files_.size(); ++i)
    if (schema::is_file(files_[i])) by_name.emplace_back(files_[i], i);
  std::ranges::sort(by_name);
  std::vector<cli::Report> rows;
  for (const auto& [file, index] : by_name) rows.push_back(row_of(index, file));
  cli::Report list;
  list.add("textures", std::move(rows));
  return list.json();
}

Result<std::string> LiveFolder::file(std::size_t index) const {
  if (index < files_.size()) return fs::absolute(files_[index]).lexically_normal().string();
  return schema::fail(schema::ErrorKind::not_found, "there is no texture of this index",
                      std::to_string(index), "load the page again");
}

Result<std::vector<float>> LiveFolder::map_of(const std::string& full_name) const {
  for (const std::string& own : files_) {
    std::error_code ignored;
    const std::string sidecar = schema::stem_of(full_name, ".texture") + std::string(kEnding);
    if (!fs::path(full_name).is_absolute() || !fs::equivalent(own, sidecar, ignored)) continue;
    const auto texture = schema::read_texture(own);
    TACTO_TRY(texture);
    return texture_map(texture->signal.values);
  }
  return schema::fail(schema::ErrorKind::not_found, "is no texture of this folder", full_name,
                      "start tactograph live with the folder of the daemon's textures");
}

Result<std::size_t> LiveFolder::make(std::size_t index) {
  const auto own = file(index);
  TACTO_TRY(own);
  auto texture = make_live_texture(*own, transducer_);
  TACTO_TRY(texture);
  made_.emplace(next_, std::make_shared<const LiveTexture>(std::move(*texture)));
  if (made_.size() > kMostMade) made_.erase(made_.begin());
  return next_++;
}

Result<std::shared_ptr<const LiveTexture>> LiveFolder::made(std::size_t number) const {
  if (const auto found = made_.find(number); found != made_.end()) return found->second;
  return schema::fail(schema::ErrorKind::not_found, "this texture is not prepared any more",
                      std::to_string(number), "choose it again");
}

std::string figures_json(std::size_t made, const LiveTexture& texture) {
  const playback::Program& program = texture.program;
  const schema::Transducer& transducer = program.session.transducer;
  cli::Report figures;
  figures.add("made", made)
      .add("name", name_of(texture.file))
      .add("start_m", program.start_m)
      .add("length_m", program.length_m)
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
