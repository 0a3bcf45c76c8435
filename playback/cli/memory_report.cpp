// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/cli/memory_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "data-schema/base/quantity.hpp"
#include "data-schema/texture/texture.hpp"
#include "firmware-host/link/hosted_board.hpp"
#include "playback/choose/budget_words.hpp"

namespace tacto::playback {
namespace {

using cli::Report;
using schema::Result;

constexpr std::size_t kRoomEnough = std::size_t{1} << 26;

Report item(std::string name, std::size_t count, std::size_t room, std::size_t bytes_each) {
  return Report()
      .add("item", std::move(name))
      .add("bytes", count * bytes_each)
      .add("room_bytes", room * bytes_each)
      .add("of_room_percent", 100 * static_cast<double>(count) / static_cast<double>(room));
}

struct Way {
  std::string words;
  std::size_t samples = 0;
  bool fits = false;
};

// A way that fails for another reason than memory is not listed.
void add_way(std::vector<Way>& ways, std::string way, const AskedProgram& asked) {
  const auto program = with_room_enough(asked);
  if (!program) return;
  const std::size_t samples = program->prepared.samples.size();
  ways.push_back({std::move(way), samples, samples <= asked.room()});
}

void add_sinc(std::vector<Way>& ways, AskedProgram asked, const Program& program) {
  if (program.prepared.scale.interpolation == wire::Interpolation::sinc) return;
  asked.request.choices.interpolation = std::string(to_string(wire::Interpolation::sinc));
  add_way(ways, "interpolate by sinc (--interpolation sinc)", asked);
}

void add_host(std::vector<Way>& ways, const AskedProgram& asked, const Program& program) {
  const std::size_t samples = program.prepared.samples.size(), room = firmware_host::HostedProfile::kSamples;
  if (asked.room() >= room) return;
  ways.push_back({"let this computer close the loop (--loop host)", samples, samples <= room});
}

std::optional<std::size_t> samples_of_beginning(schema::Texture texture, int hundredths,
                                                const Program& program, PrepareOptions options) {
  std::vector<double>& values = texture.signal.values;
  values.resize(std::max<std::size_t>(2, values.size() * static_cast<std::size_t>(hundredths) / 100));
  options.most_samples = kRoomEnough;
  const auto made = prepare(texture, program.session.transducer, options);
  if (!made) return std::nullopt;
  return made->samples.size();
}

struct Beginning {
  int hundredths = 0;  // 0: none fits
  std::size_t samples = 0;
};

// By bisection, each cut prepared: a cut may have finer content than the whole, so the number of samples is
// not proportional to the length.
Beginning longest_beginning(const schema::Texture& texture, std::size_t room, const Program& program,
                            const PrepareOptions& options) {
  Beginning longest;
  for (int too_long = 100; too_long - longest.hundredths > 1;) {
    const int middle = (longest.hundredths + too_long) / 2;
    const auto samples = samples_of_beginning(texture, middle, program, options);
    if (samples && *samples <= room)
      longest = {middle, *samples};
    else
      too_long = middle;
  }
  return longest;
}

// Returns whether at least a hundredth fits.
bool add_beginning(std::vector<Way>& ways, const AskedProgram& asked, const Program& program,
                   const PrepareOptions& options, const char* how) {
  const auto texture = schema::read_texture(program.session.textures.front().file);
  if (!texture) return false;
  const Beginning longest = longest_beginning(*texture, asked.room(), program, options);
  if (longest.hundredths == 0) return false;
  const double length_m = 0.01 * longest.hundredths * texture->signal.length_m();
  ways.push_back(
      {fmt::format("play its first {}{}", schema::length_for_people(length_m), how), longest.samples, true});
  return true;
}

void add_beginnings(std::vector<Way>& ways, const AskedProgram& asked, const Program& program) {
  if (program.session.textures.size() != 1) return;
  PrepareOptions options = program.options;
  if (add_beginning(ways, asked, program, options, "")) return;
  options.interpolation = wire::Interpolation::sinc;
  add_beginning(ways, asked, program, options, ", by sinc (--interpolation sinc)");
}

// The space between textures needs as many samples as a texture of that length.
void add_alone(std::vector<Way>& ways, const AskedProgram& asked, const Program& program) {
  if (program.session.textures.size() < 2) return;
  std::vector<std::string> seen;
  for (const schema::SessionTexture& texture : program.session.textures) {
    if (std::ranges::find(seen, texture.file) != seen.end()) continue;
    seen.push_back(texture.file);
    AskedProgram alone = asked;
    alone.request.file = texture.file;
    alone.request.at_m = texture.at_m;
    add_way(ways, "play only " + texture.file, alone);
  }
}

std::string words_of_fitting(const std::vector<Way>& ways) {
  std::string words;
  for (const Way& way : ways)
    if (way.fits) words += (words.empty() ? "" : ", or ") + way.words;
  return words;
}

std::vector<Report> rows_of(const std::vector<Way>& ways) {
  std::vector<Report> rows;
  for (const Way& way : ways)
    rows.push_back(Report().add("way", way.words).add("samples", way.samples).add("fits", way.fits));
  return rows;
}

}  // namespace

Result<Program> with_room_enough(const AskedProgram& asked) {
  PrepareOptions options = asked.options;
  options.most_samples = std::max(kRoomEnough, asked.room());
  return make_program(asked.request, asked.transducer, options);
}

void add_room(Report& report, const Prepared& made, std::size_t device_samples) {
  const std::size_t needed = made.samples.size();
  report.add("device_samples", device_samples).add("needed_samples", needed);
  report.add("fits", needed <= device_samples);
  std::vector<Report> items;
  for (std::uint8_t level = 0; level < made.scale.levels; ++level)
    items.push_back(item(fmt::format("samples of level {}", level + 1),
                         core::level_samples(made.scale, level), device_samples, sizeof(float)));
  items.push_back(item("samples of all levels", needed, device_samples, sizeof(float)));
  items.push_back(item("filter's taps", made.built.taps, wire::kMaxTaps, sizeof(float)));
  items.push_back(item("play operators of the hysteresis", made.built.play_operators, wire::kMaxPlays,
                       sizeof(wire::HysteresisPlay)));
  items.push_back(item("sections", made.built.sections, wire::kMaxSections, sizeof(wire::Section)));
  report.add("memory", std::move(items));
}

std::string add_ways_to_fit(Report& report, const AskedProgram& asked, const Program& program) {
  std::vector<Way> ways;
  add_sinc(ways, asked, program);
  add_beginnings(ways, asked, program);
  add_alone(ways, asked, program);
  const bool on_device = !words_of_fitting(ways).empty();
  add_host(ways, asked, program);
  report.add("ways_to_fit", rows_of(ways));
  const std::string fitting = words_of_fitting(ways);
  if (on_device) return fitting;
  return "no tested alternative fits on the device, neither sinc nor a part of the texture" +
         (fitting.empty() ? "" : "; " + fitting);
}

}  // namespace tacto::playback
