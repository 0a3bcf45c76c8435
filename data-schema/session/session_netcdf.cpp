// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/session/session_netcdf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "data-schema/base/format_version.hpp"
#include "data-schema/spectrogram/netcdf_file.hpp"

namespace tacto::schema {
namespace {

constexpr std::size_t kSessionBlock = 65536;
constexpr const char* kSessionKind = "session";

void put_played(NetcdfWriter& file, const SessionHeader& header) {
  file.attribute("kind", kSessionKind);
  file.attribute("version", std::string(kFormatVersion));
  file.attribute("created", header.created);
  file.attribute("creator", header.creator);
  file.attribute("device", header.device_uri);
  file.attribute("transducer", header.transducer.name);
  if (!header.simulated.empty()) file.attribute("simulated", header.simulated);
  file.attribute("rate_hz", header.rate_hz);
  file.attribute("metres_per_count", header.metres_per_count);
  std::string names;
  for (const SessionTexture& texture : header.textures)
    names.append(names.empty() ? "" : "\n").append(texture.file);
  file.attribute("textures", names);
}

void put_turns(NetcdfWriter& file, const std::vector<SessionTurn>& turns) {
  std::string lines;
  const auto add = [&](const SessionTurn& turn, std::string_view name) {
    lines += fmt::format("{}from {:.6g} s on, over {:.6g} s: {}", lines.empty() ? "" : "\n", turn.from_s,
                         turn.fade_s, name);
  };
  for (const SessionTurn& turn : turns) {
    if (turn.textures.empty()) add(turn, "not in the session");
    for (const SessionTexture& texture : turn.textures) add(turn, texture.file);
  }
  if (!lines.empty()) file.attribute("changes", lines);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace

SessionNetcdf::SessionNetcdf(const std::string& path, const SessionHeader& header, std::uint64_t times,
                             const std::vector<SessionVariable>& variables)
    : path_(path), file_(std::make_unique<NetcdfWriter>(path)), values_(variables.size()) {
  const int time = file_->dimension("time", times);
  axis_ = file_->axis("time", time, "s", "time since the first tick, by the device's clock");
  const Blocks blocks{{time}, {std::min<std::size_t>(times, kSessionBlock)}};
  for (const SessionVariable& variable : variables)
    ids_.push_back(file_->values(variable.name, blocks, variable.units, variable.long_name));
  put_played(*file_, header);
}

SessionNetcdf::~SessionNetcdf() = default;

void SessionNetcdf::add(double time_s, std::span<const double> values) {
  time_s_.push_back(time_s);
  for (std::size_t i = 0; i < values_.size(); ++i) values_[i].push_back(values[i]);
  if (time_s_.size() == kSessionBlock) put_block();
}

void SessionNetcdf::put_block() {
  const Part part{{put_}, {time_s_.size()}};
  if (time_s_.empty()) return;
  put_ += time_s_.size();
  file_->put(axis_, part, time_s_);
  time_s_.clear();
  for (std::size_t i = 0; i < values_.size(); ++i) {
    file_->put(ids_[i], part, values_[i]);
    values_[i].clear();
  }
}

Result<void> SessionNetcdf::close(const std::vector<SessionTurn>& turns) {
  put_block();
  put_turns(*file_, turns);
  return file_->close(path_);
}

bool is_session_netcdf(const std::string& path) {
  NetcdfReader file(path);
  return file.text("kind") == kSessionKind;
}

Result<SessionTable> read_session_table(const std::string& path) {
  NetcdfReader file(path);
  TACTO_TRY(file.status(path));
  if (file.text("kind") != kSessionKind)
    return fail(ErrorKind::malformed, "is netCDF, but not a session of tactograph", path);
  auto newer = newer_version(file.text("version"), path, path);
  TACTO_TRY(newer);
  SessionTable table;
  table.newer_version = std::move(*newer);
  table.created = file.text("created");
  table.creator = file.text("creator");
  table.device = file.text("device");
  table.transducer = file.text("transducer");
  table.simulated = file.text("simulated");
  table.textures = lines_of(file.text("textures"));
  table.changes = lines_of(file.text("changes"));
  table.rate_hz = file.number("rate_hz");
  const std::vector<double> time_s = file.axis("time");
  TACTO_TRY(file.status(path));
  const auto stuck = std::ranges::adjacent_find(time_s, [](double a, double b) { return !(a < b); });
  if (time_s.empty() || stuck != time_s.end())
    return fail(ErrorKind::malformed, time_s.empty() ? "has no times" : "its times must increase", path);
  table.times = time_s.size();
  table.duration_s = time_s.back() - time_s.front();
  return table;
}

}  // namespace tacto::schema
