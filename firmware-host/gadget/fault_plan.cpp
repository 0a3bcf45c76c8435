// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/gadget/fault_plan.hpp"

#include <fmt/format.h>

#include <charconv>

namespace tacto::firmware_host {
namespace {

using schema::ErrorKind;
using schema::Result;

struct Key {
  std::string_view name, words;
  std::optional<std::uint64_t> FaultPlan::*value;
};

constexpr Key kKeys[] = {
    {"corrupt-every", "each Nth message of samples has one inverted bit", &FaultPlan::corrupt_every},
    {"drop-every", "each Nth message of samples is not sent", &FaultPlan::drop_every},
    {"truncate-every", "each Nth message of samples lacks its second half", &FaultPlan::truncate_every},
    {"repeat-every", "each Nth message of samples is sent twice", &FaultPlan::repeat_every},
    {"packet", "no transfer is longer than N bytes", &FaultPlan::packet},
    {"stall-after", "the endpoint to the host stalls after N frames", &FaultPlan::stall_after},
    {"unplug-after", "the device disconnects in the middle of frame N+1", &FaultPlan::unplug_after},
    {"silent-after", "nothing is sent after N frames", &FaultPlan::silent_after},
    {"deaf-after", "nothing is received after N transfers from the host", &FaultPlan::stop_reading_after}};
constexpr std::string_view kVersion = "version";

bool read_number(std::string_view text, std::uint64_t& value) {
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc() && read.ptr == text.data() + text.size();
}

tl::unexpected<schema::Error> bad_value(std::string_view key, std::string_view value,
                                        std::string_view target) {
  return schema::fail(ErrorKind::usage, fmt::format("'{}' is not a {} for {}", value, target, key),
                      "--fault");
}

Result<void> read_version(std::string_view text, FaultPlan& plan) {
  const std::size_t point = text.find('.');
  std::uint64_t major = 0, minor = 0;
  const bool good = point != std::string_view::npos && read_number(text.substr(0, point), major) &&
                    read_number(text.substr(point + 1), minor) && major < 256 && minor < 256;
  if (!good) return bad_value(kVersion, text, "version (as 2.0)");
  plan.major = static_cast<std::uint8_t>(major);
  plan.minor = static_cast<std::uint8_t>(minor);
  return {};
}

// Zero is permitted only for faults that occur after a number of frames.
Result<void> read_count(const Key& key, std::string_view text, FaultPlan& plan) {
  std::uint64_t value = 0;
  const bool after = key.name.ends_with("-after");
  if (!read_number(text, value) || (value == 0 && !after)) return bad_value(key.name, text, "number");
  plan.*key.value = value;
  return {};
}

Result<void> read_pair(std::string_view pair, FaultPlan& plan) {
  const std::size_t equals = std::min(pair.find('='), pair.size());
  const std::string_view name = pair.substr(0, equals);
  const std::string_view value = pair.substr(std::min(equals + 1, pair.size()));
  if (name == kVersion) return read_version(value, plan);
  for (const Key& key : kKeys)
    if (key.name == name) return read_count(key, value, plan);
  return schema::fail(ErrorKind::usage, fmt::format("'{}' is not a known fault", name), "--fault",
                      "tactograph-gadget --help lists them");
}

}  // namespace

Result<FaultPlan> parse_fault_plan(std::string_view text) {
  FaultPlan plan;
  while (!text.empty()) {
    const std::size_t comma = std::min(text.find(','), text.size());
    TACTO_TRY(read_pair(text.substr(0, comma), plan));
    text.remove_prefix(std::min(comma + 1, text.size()));
  }
  return plan;
}

std::string fault_words() {
  std::string words =
      fmt::format("  {:<18}{}\n", "version=2.0", "the device reports that version of the protocol");
  for (const Key& key : kKeys) words += fmt::format("  {:<18}{}\n", fmt::format("{}=N", key.name), key.words);
  return words;
}

}  // namespace tacto::firmware_host
