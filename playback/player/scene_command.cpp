// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/player/scene_command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>

#include "data-schema/base/column_unit.hpp"
#include "data-schema/base/nearest_word.hpp"
#include "data-schema/files/files.hpp"
#include "playback/prepare/scene/scene_device.hpp"

namespace tacto::playback {

using schema::Dimension;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

constexpr double kLongestRampS = 10;  // limit of the wire
constexpr std::string_view kForm =
    "write 'set PATCH.LAYER.MEMBER VALUE', of a piece in space 'set PIECE.MEMBER VALUE', 'move PATCH X,Y' or "
    "'raise PATCH'; 'set' and 'move' may end in 'over 10ms'";
constexpr std::string_view kPlaceForm = "write the place of its centre with units, as in 10mm,20mm";
constexpr std::string_view kHeaderForm =
    "write a header line such as 'time_s,command', then one row per command";

using Words = std::vector<std::string>;

Words words_in(std::string_view text, std::string_view separators) {
  Words words;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find_first_of(separators, at), text.size());
    if (end > at) words.emplace_back(text.substr(at, end - at));
    at = end + 1;
  }
  return words;
}

// The place of a name among those that exist.
Result<std::size_t> place_of(std::string_view kind, const std::string& name, const Words& names) {
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  return fail(ErrorKind::usage,
              fmt::format("there is no {} '{}'{}", kind, name, schema::did_you_mean(name, names)), {},
              fmt::format("it has: {}", fmt::join(names, ", ")));
}

Result<std::size_t> patch_place(const std::string& name, const PreparedScene& scene) {
  if (!scene.pieces.empty())
    return fail(ErrorKind::usage, fmt::format("there is no patch '{}' in a scene of pieces", name), {},
                "pieces do not move; 'set PIECE.MEMBER VALUE' changes a number of a piece");
  Words patches;
  for (const schema::Patch& patch : scene.patches) patches.push_back(patch.name);
  return place_of("patch", name, patches);
}

Result<void> check_ramp(double ramp_s) {
  if (ramp_s >= 0 && ramp_s <= kLongestRampS) return {};
  return fail(ErrorKind::usage, fmt::format("the ramp is {:g} s", ramp_s), {}, "use 0 s to 10 s");
}

// From its place in the block, along one axis.
Result<std::int32_t> counts_to(double to_m, double from_m, double step_m) {
  const double counts = std::round((to_m - from_m) / step_m);
  if (std::abs(counts) <= core::kFarthestMove) return static_cast<std::int32_t>(counts);
  return fail(ErrorKind::usage, fmt::format("{:g} m is too far to move a patch", to_m), {},
              fmt::format("choose a place within {:g} m of its place in the scene, {:g} m",
                          step_m * core::kFarthestMove, from_m));
}

Result<std::size_t> layer_place(const schema::Patch& patch, const std::string& name) {
  Words types;
  for (const schema::ForceLayer& layer : patch.layers)
    if (!is_added(layer)) types.emplace_back(type_of(layer));
  for (std::size_t i = 0; i < types.size(); ++i)
    if (name == std::to_string(i)) return i;
  if (std::ranges::count(types, name) > 1)
    return fail(ErrorKind::usage,
                fmt::format("the patch '{}' has several layers of the type {}", patch.name, name), {},
                fmt::format("name one by its index, from 0 to {}", types.size() - 1));
  return place_of(fmt::format("layer in the patch '{}' named", patch.name), name, types);
}

// What a scene's file has of a range that was scaled; empty if it was not.
std::string range_in_file(const ForceProgram& forces, const Words& path, std::size_t layer,
                          const schema::SliderRange& scaled) {
  const auto held = std::ranges::find_if(forces.held, [&](const HeldLayer& each) {
    return each.patch == path[0] && each.index == layer && each.member == path[2];
  });
  if (held == forces.held.end()) return {};
  const double factor = held->to_n_per_m / held->from_n_per_m;
  return fmt::format(
      "; in the scene's file the slider is from {:g} to {:g}, --hold-stable scaled it by {:.4g}",
      scaled.from / factor, scaled.to / factor, factor);
}

Result<void> check_value(const schema::NamedLayerNumber& member, double value, const Words& path,
                         std::size_t layer, const ForceProgram& forces) {
  const auto& slider = member.number.slider;
  if (!slider)
    return fail(ErrorKind::usage, fmt::format("{} has no slider in the scene", member.name), {},
                "give it one, as in {\"value\": 3, \"slider\": {\"from\": 1, \"to\": 5}}");
  if (value >= slider->from && value <= slider->to) return {};
  return fail(ErrorKind::usage,
              fmt::format("{} {:g} is outside its slider{}", member.name, value,
                          range_in_file(forces, path, layer, *slider)),
              {}, fmt::format("set a value from {:g} to {:g}", slider->from, slider->to));
}

// The layer's index in the block, and the number's index in the layer.
Result<wire::Set> target_of(const Words& path, double value, const ForceProgram& forces) {
  const PreparedScene& scene = forces.scene;
  const auto at_patch = patch_place(path[0], scene);
  TACTO_TRY(at_patch);
  const schema::Patch& patch = scene.patches[*at_patch];
  const auto at_layer = layer_place(patch, path[1]);
  TACTO_TRY(at_layer);
  const schema::ForceLayer& layer = patch.layers[*at_layer];
  Words members;
  const auto numbers = numbers_of(layer);
  for (const auto& [name, number, changes, whole] : numbers) members.emplace_back(name);
  const auto at_member = place_of(fmt::format("member in the {} named", type_of(layer)), path[2], members);
  TACTO_TRY(at_member);
  TACTO_TRY(check_value(numbers[*at_member], value, path, *at_layer, forces));
  const auto in_block = numbers_in_block(layer);
  const auto number = std::ranges::find(in_block, path[2]);
  if (number == in_block.end())
    return fail(ErrorKind::usage, fmt::format("{} cannot change during playback", path[2]), {},
                fmt::format("of this layer these can: {}", fmt::join(in_block, ", ")));
  std::size_t before = *at_layer;
  for (std::size_t i = 0; i < *at_patch; ++i) before += scene.patches[i].layers.size();
  return wire::Set{static_cast<std::uint16_t>(before), static_cast<std::uint16_t>(number - in_block.begin()),
                   static_cast<float>(value), 0};
}

// Of a piece, which is a layer of the block.
Result<wire::Set> target_in_piece(const Words& path, double value, const ForceProgram& forces) {
  const std::vector<schema::Piece>& pieces = forces.scene.pieces;
  Words names, members;
  for (const schema::Piece& piece : pieces) names.push_back(piece.name);
  for (const schema::PieceNumber& number : schema::kWallNumbers) members.emplace_back(number.name);
  const auto at_piece = place_of("piece", path[0], names);
  TACTO_TRY(at_piece);
  const auto number = place_of("member of a piece named", path[1], members);
  TACTO_TRY(number);
  if (!schema::kWallNumbers[*number].changes) {
    std::erase_if(members, [](const std::string& name) {
      return !std::ranges::find(schema::kWallNumbers, name, &schema::PieceNumber::name)->changes;
    });
    return fail(ErrorKind::usage, fmt::format("{} cannot change during playback", path[1]), {},
                fmt::format("of a piece these can: {}", fmt::join(members, ", ")));
  }
  TACTO_TRY(check_value(named_number(pieces[*at_piece], schema::kWallNumbers[*number]), value, path,
                        *at_piece, forces));
  return wire::Set{static_cast<std::uint16_t>(*at_piece), static_cast<std::uint16_t>(*number),
                   static_cast<float>(value), 0};
}

// Up to the first comma, and after it.
struct ScriptLine {
  std::string where, time, command;
};

// A cell in quotes as in RFC 4180, where a quote in it is doubled; any other cell as it is.
std::string cell_in(std::string_view text) {
  const std::string_view cell = schema::without_blanks(text);
  if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') return std::string(cell);
  std::string inside;
  for (std::size_t i = 1; i + 1 < cell.size(); ++i) {
    inside += cell[i];
    if (cell[i] != '"') continue;
    if (i + 2 >= cell.size() || cell[++i] != '"') return std::string(cell);
  }
  return std::string(schema::without_blanks(inside));
}

// Without the empty ones.
std::vector<ScriptLine> lines_of_script(std::string_view text, const std::string& file) {
  std::vector<ScriptLine> lines;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const std::size_t comma = std::min(line.find(','), line.size());
    if (schema::without_blanks(line).empty()) continue;
    lines.push_back({fmt::format("{}, line {}", file, number), cell_in(line.substr(0, comma)),
                     cell_in(line.substr(std::min(comma + 1, line.size())))});
  }
  return lines;
}

Result<double> time_unit_of(const ScriptLine& header) {
  const auto [name, unit_name] = schema::split_unit(header.time);
  const auto unit = schema::known_unit(unit_name, Dimension::time);
  if (name == "time" && unit && unit->dimension == Dimension::time && header.command == "command")
    return unit->si;
  return fail(ErrorKind::malformed, "this is not the header of a script", header.where,
              std::string(kHeaderForm));
}

Result<double> time_in(const ScriptLine& line, double unit_s, double last_s) {
  const auto time = number_in_text(line.time);
  if (!time || *time < 0)
    return fail(ErrorKind::malformed, fmt::format("'{}' is not a time", line.time), line.where,
                "write a number from 0 on, in the unit of the header");
  if (*time * unit_s > last_s) return *time * unit_s;
  return fail(ErrorKind::malformed,
              fmt::format("the time does not increase: {:g} s after {:g} s", *time * unit_s, last_s),
              line.where, "each row must be later than the one before");
}

}  // namespace

Result<SceneCommand> set_command(const std::string& number, double value, double ramp_s,
                                 const ForceProgram& forces) {
  const Words path = words_in(number, ".");
  const bool in_space = !forces.scene.pieces.empty();
  if (path.size() != (in_space ? 2 : 3))
    return fail(ErrorKind::usage,
                fmt::format("'{}' does not name a number of a {}", number, in_space ? "piece" : "layer"), {},
                in_space ? "name it as PIECE.MEMBER" : "name it as PATCH.LAYER.MEMBER");
  auto set = in_space ? target_in_piece(path, value, forces) : target_of(path, value, forces);
  TACTO_TRY(set);
  TACTO_TRY(check_ramp(ramp_s));
  set->ramp_s = static_cast<float>(ramp_s);
  return SceneCommand{*set, fmt::format("set {} {} over {} s", number, value, ramp_s), {}};
}

Result<double> number_in_text(std::string_view text) {
  double value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault == std::errc() && end == text.data() + text.size() && std::isfinite(value)) return value;
  return fail(ErrorKind::usage, fmt::format("'{}' is not a number", text), {},
              "write a plain number; its unit is in the name of the member");
}

Result<PatchPlace> parse_place(const std::string& text) {
  const Words words = words_in(text, ",");
  if (words.size() != 2)
    return fail(ErrorKind::usage, fmt::format("'{}' is not a place", text), {}, std::string(kPlaceForm));
  const auto x_m = schema::parse_quantity(words[0], Dimension::length);
  TACTO_TRY(x_m);
  const auto y_m = schema::parse_quantity(words[1], Dimension::length);
  TACTO_TRY(y_m);
  return PatchPlace{*x_m, *y_m};
}

Result<SceneCommand> move_command(const std::string& patch, const PatchPlace& to, double ramp_s,
                                  const ForceProgram& forces) {
  const PreparedScene& scene = forces.scene;
  const auto at = patch_place(patch, scene);
  TACTO_TRY(at);
  schema::Patch moved = scene.patches[*at];
  const auto x = counts_to(to.x_m, moved.x_m, scene.steps.x_m),
             y = counts_to(to.y_m, moved.y_m, scene.steps.y_m);
  TACTO_TRY(x);
  TACTO_TRY(y);
  TACTO_TRY(check_ramp(ramp_s));
  moved.x_m = to.x_m, moved.y_m = to.y_m;
  schema::Device device;
  device.axes = forces.session.forces->axes;
  return SceneCommand{wire::Move{static_cast<std::uint16_t>(*at), 0, *x, *y, static_cast<float>(ramp_s)},
                      fmt::format("move {} {} m,{} m over {} s", patch, to.x_m, to.y_m, ramp_s),
                      note_of_travel(moved, device)};
}

Result<SceneCommand> raise_command(const std::string& patch, const PreparedScene& scene) {
  const auto at = patch_place(patch, scene);
  TACTO_TRY(at);
  return SceneCommand{wire::Raise{static_cast<std::uint16_t>(*at)}, "raise " + patch, {}};
}

Result<SceneCommand> parse_scene_command(std::string_view text, const ForceProgram& forces) {
  const Words words = words_in(text, " \t");
  if (words.size() == 2 && words[0] == "raise") return raise_command(words[1], forces.scene);
  const bool over = words.size() == 5 && words[3] == "over";
  if ((words.size() != 3 && !over) || (words[0] != "set" && words[0] != "move"))
    return fail(ErrorKind::usage, fmt::format("'{}' is not a command", text), {}, std::string(kForm));
  const auto ramp_s = over ? schema::parse_quantity(words[4], Dimension::time) : kUsualRampS;
  TACTO_TRY(ramp_s);
  if (words[0] == "move") {
    const auto place = parse_place(words[2]);
    TACTO_TRY(place);
    return move_command(words[1], *place, *ramp_s, forces);
  }
  const auto value = number_in_text(words[2]);
  TACTO_TRY(value);
  return set_command(words[1], *value, *ramp_s, forces);
}

Result<std::vector<TimedSceneCommand>> read_scene_script(const std::string& file,
                                                         const ForceProgram& forces) {
  const auto text = schema::read_file(file);
  TACTO_TRY(text);
  const std::vector<ScriptLine> lines = lines_of_script(*text, file);
  const auto unit_s = time_unit_of(lines.empty() ? ScriptLine{file, {}, {}} : lines.front());
  TACTO_TRY(unit_s);
  if (lines.size() < 2)
    return fail(ErrorKind::malformed, "the script has no commands", file, std::string(kHeaderForm));
  std::vector<TimedSceneCommand> script;
  for (const ScriptLine& line : std::span(lines).subspan(1)) {
    const auto time_s = time_in(line, *unit_s, script.empty() ? -1 : script.back().time_s);
    TACTO_TRY(time_s);
    auto command = parse_scene_command(line.command, forces);
    if (!command) return fail(ErrorKind::malformed, command.error().what, line.where, command.error().remedy);
    script.push_back({*time_s, std::move(*command)});
  }
  return script;
}

}  // namespace tacto::playback
