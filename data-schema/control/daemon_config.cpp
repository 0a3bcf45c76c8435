// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/control/daemon_config.hpp"

#include "data-schema/json/json_document.hpp"
#include "data-schema/json/json_schema.hpp"
#include "data-schema/json/known_members.hpp"
#include "data-schema/scene/playback_choices_json.hpp"

namespace tacto::schema {
namespace {

std::optional<double> number_in(const Json& body, const char* name) {
  if (!body.contains(name)) return std::nullopt;
  return body[name].get<double>();
}

// One of three words, as the schema has it.
std::optional<Quality> quality_in(const Json& body) {
  const std::string word = text_or(body, "quality");
  if (word.empty()) return std::nullopt;
  if (word == "fast") return Quality::fast;
  return word == "balanced" ? Quality::balanced : Quality::exact;
}

}  // namespace

Result<DaemonConfig> read_daemon_config(const std::string& path) {
  const auto document = open_document(path, "daemon");
  TACTO_TRY(document);
  const Json& body = document->body;
  // Also of a newer version: an ignored member may be a limit.
  TACTO_TRY(check_members_known(*schema_of("daemon"), body, path));
  DaemonConfig config;
  for (const auto& [name, member] :
       {std::pair{"device", &DaemonConfig::device}, std::pair{"transducer", &DaemonConfig::transducer},
        std::pair{"loop", &DaemonConfig::loop}, std::pair{"socket", &DaemonConfig::socket},
        std::pair{"socket_group", &DaemonConfig::socket_group},
        std::pair{"sessions", &DaemonConfig::sessions}, std::pair{"files", &DaemonConfig::files},
        std::pair{"tcp_token_file", &DaemonConfig::tcp_token_file},
        std::pair{"finger_path", &DaemonConfig::finger_path}})
    config.*member = text_or(body, name, config.*member);
  for (const auto& [name, member] : {std::pair{"rate_hz", &DaemonConfig::rate_hz},
                                     std::pair{"most_speed_mps", &DaemonConfig::most_speed_mps},
                                     std::pair{"onset_s", &DaemonConfig::onset_s},
                                     std::pair{"most_late_percent", &DaemonConfig::most_late_percent}})
    config.*member = number_or(body, name, config.*member);
  for (const auto& [name, member] : {std::pair{"most_clients", &DaemonConfig::most_clients},
                                     std::pair{"real_time_priority", &DaemonConfig::real_time_priority},
                                     std::pair{"watchdog_ms", &DaemonConfig::watchdog_ms}})
    config.*member = static_cast<int>(number_or(body, name, config.*member));
  if (const auto port = number_in(body, "tcp_port")) config.tcp_port = static_cast<int>(*port);
  config.undo_hysteresis = body.value("undo_hysteresis", config.undo_hysteresis);
  config.budget = {quality_in(body), number_in(body, "max_error")};
  config.playback = playback_choices_in(body);
  config.dead_man_s = number_in(body, "dead_man_s");
  config.max_tick_ns = number_in(body, "max_tick_ns");
  return config;
}

}  // namespace tacto::schema
