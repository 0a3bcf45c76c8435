// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/control/stay_watch.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tacto::playback {
namespace {

constexpr double kLongestStepS = 0.1;

}  // namespace

StayRules stay_rules(const schema::ControlRequest& arm, std::optional<double> configured_s) {
  StayRules rules;
  if (arm.while_connected) rules.client = arm.client;
  rules.dead_man_s = arm.dead_man_s ? arm.dead_man_s : configured_s;
  if (rules.dead_man_s && configured_s) rules.dead_man_s = std::min(*rules.dead_man_s, *configured_s);
  return rules;
}

void StayWatch::begin(const StayRules& rules) {
  end();
  rules_ = rules;
}

std::optional<std::string> StayWatch::why_to_fall(const LinesReceived& heard, double passed_s) {
  if (rules_.client && !heard.connected) return "the client that armed has closed its connection";
  if (!rules_.dead_man_s) return std::nullopt;
  silent_s_ = heard.lines == lines_ ? silent_s_ + std::min(passed_s, kLongestStepS) : 0;
  lines_ = heard.lines;
  if (silent_s_ <= *rules_.dead_man_s) return std::nullopt;
  return fmt::format("no line came from {} for {:g} s (dead_man_s)",
                     rules_.client ? "the client that armed" : "any client", *rules_.dead_man_s);
}

}  // namespace tacto::playback
