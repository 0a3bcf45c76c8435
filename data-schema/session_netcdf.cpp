// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/session_netcdf.hpp"

#include <algorithm>
#include <sstream>

#include "data-schema/netcdf_file.hpp"

namespace tacto::schema {
namespace {

constexpr std::size_t kSessionBlock = 65536;
constexpr const char* kSessionKind = "session";

void put_played(NetcdfWriter& file, const SessionHeader& header) {
  file.attribute("kind", kSessionKind);
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

}  // namespace

Result<void> write_session_netcdf(const std::string& path, const SessionHeader& header,
                                  const std::vector<SessionVariable>& variables,
                                  const std::vector<double>& time_s) {
  NetcdfWriter file(path);
  const int time = file.dimension("time", time_s.size());
  const int axis = file.axis("time", time, "s", "time since the first tick, by the device's clock");
  const Blocks blocks{{time}, {std::min(time_s.size(), kSessionBlock)}};
  std::vector<int> ids;
  for (const SessionVariable& variable : variables)
    ids.push_back(file.values(variable.name, blocks, variable.units, variable.long_name));
  put_played(file, header);
  file.put(axis, time_s);
  for (std::size_t i = 0; i < ids.size(); ++i) file.put(ids[i], *variables[i].values);
  return file.close(path);
}

bool is_session_netcdf(const std::string& path) {
  NetcdfReader file(path);
  return file.text("kind") == kSessionKind;
}

Result<SessionTable> read_session_table(const std::string& path) {
  NetcdfReader file(path);
  SessionTable table;
  table.created = file.text("created");
  table.creator = file.text("creator");
  table.device = file.text("device");
  table.transducer = file.text("transducer");
  table.simulated = file.text("simulated");
  std::istringstream names(file.text("textures"));
  for (std::string name; std::getline(names, name);) table.textures.push_back(name);
  table.rate_hz = file.number("rate_hz");
  const bool ours = file.text("kind") == kSessionKind;
  const std::vector<double> time_s = file.axis("time");
  if (const auto sound = file.status(path); !sound) return forward_error(sound);
  if (!ours) return fail(Fault::malformed, "is netCDF, but no session of tactograph", path);
  const auto stuck = std::ranges::adjacent_find(time_s, [](double a, double b) { return !(a < b); });
  if (time_s.empty() || stuck != time_s.end())
    return fail(Fault::malformed, time_s.empty() ? "has no times" : "its times must grow", path);
  table.times = time_s.size();
  table.duration_s = time_s.back() - time_s.front();
  return table;
}

}  // namespace tacto::schema
