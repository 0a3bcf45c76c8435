// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "data-schema/base/quantity.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/json/json_document.hpp"
#include "data-schema/json/known_members.hpp"
#include "data-schema/json/named_document.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/wiring/wiring.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kWiringKind = "wiring";

WiredInput input_from(const Json& body) {
  WiredInput input;
  input.input = body["input"];
  input.quantity = body["quantity"];
  input.name = text_or(body, "name", input.quantity);
  input.range_from_v = body["range_v"][0];
  input.range_to_v = body["range_v"][1];
  input.reference = body["reference"];
  if (body.contains("per_volt")) input.per_volt = body["per_volt"].get<double>();
  input.at_zero_volt = number_or(body, "at_zero_volt", 0);
  return input;
}

std::optional<unsigned> count_in(const Json& body, const char* member) {
  return body.contains(member) ? std::optional(body[member].get<unsigned>()) : std::nullopt;
}

void read_played(const Json& body, Wiring& wiring) {
  if (body.contains("output")) {
    const Json& output = body["output"];
    wiring.output = {output["output"], output["range_v"][0], output["range_v"][1]};
  }
  if (body.contains("encoder")) {
    const Json& encoder = body["encoder"];
    wiring.encoder = {encoder["counter"], count_in(encoder, "subdevice"), encoder["step_m"],
                      count_in(encoder, "pfi_a"), count_in(encoder, "pfi_b")};
  }
  if (body.contains("watchdog"))
    wiring.watchdog = {body["watchdog"]["line"], count_in(body["watchdog"], "subdevice")};
}

// The drive is of both signs.
Result<void> check_output(const Wiring& wiring, const std::string& file) {
  if (!wiring.output) return {};
  if (!wiring.transducer)
    return fail(ErrorKind::unsuitable, "an output needs the transducer, whose limits its drive has",
                file + "#/output", "name it in the member transducer");
  const double reach_v = std::min(-wiring.output->range_from_v, wiring.output->range_to_v);
  if (wiring.transducer->drive_limit_v <= reach_v) return {};
  return fail(
      ErrorKind::unsuitable,
      fmt::format("the drive of '{}' may be -{:g} to {:g} V, but this output gives {:g} to {:g} V",
                  wiring.transducer->name, wiring.transducer->drive_limit_v, wiring.transducer->drive_limit_v,
                  wiring.output->range_from_v, wiring.output->range_to_v),
      file + "#/output/range_v",
      "use a larger range of the card, or a transducer file with a smaller drive_limit_v");
}

Result<void> check_input(const Wiring& wiring, std::size_t index, const std::string& file) {
  const WiredInput& input = wiring.inputs[index];
  const std::string where = fmt::format("{}#/inputs/{}", file, index);
  if (auto quantity = quantity_named(input.quantity); !quantity)
    return fail(ErrorKind::unsuitable, quantity.error().what, where + "/quantity", quantity.error().remedy);
  if (!(input.range_from_v < input.range_to_v))
    return fail(ErrorKind::unsuitable, "the range has no length", where + "/range_v",
                "give the lower end first, as in [-5, 5]");
  const bool of_transducer = input.quantity == "tangential_force" && !wiring.transducer_name.empty();
  if (!input.per_volt && !of_transducer)
    return fail(
        ErrorKind::unsuitable, "per_volt is missing", where,
        "give the SI units of the quantity for one volt; or, for the tangential force, the transducer");
  if (input.per_volt == 0)
    return fail(ErrorKind::unsuitable, "0 units per volt", where + "/per_volt", "give the sensor's scale");
  if (!input.per_volt && input.at_zero_volt != 0)
    return fail(ErrorKind::unsuitable, "at_zero_volt needs per_volt", where + "/at_zero_volt",
                "remove it: the transducer has no force at 0 V");
  if (std::ranges::any_of(input.name, [](unsigned char c) { return c < 0x20 || c == 0x7F; }))
    return fail(ErrorKind::unsuitable, "the name has a control character", where + "/name", "remove it");
  if (wiring.encoder && input.name == "position")
    return fail(ErrorKind::unsuitable, "'position' is the channel of the encoder", where + "/name",
                "give the input another name, for example lvdt, or remove the encoder");
  for (std::size_t earlier = 0; earlier < index; ++earlier) {
    if (wiring.inputs[earlier].name == input.name)
      return fail(ErrorKind::unsuitable, fmt::format("'{}' is the name of two channels", input.name),
                  where + "/name", "give one of them another name");
    if (wiring.inputs[earlier].input == input.input && wiring.inputs[earlier].quantity != input.quantity)
      return fail(ErrorKind::unsuitable, fmt::format("the input {} has two quantities", input.input),
                  where + "/input", "give each sensor an input of its own");
  }
  return {};
}

}  // namespace

Result<Wiring> read_wiring(const std::string& name) {
  const auto found = open_named(kWiringKind, name);
  TACTO_TRY(found);
  TACTO_TRY(check_document_known(found->document, kWiringKind, found->where));
  const Json& body = found->document.body;
  Wiring wiring;
  wiring.name = body["name"];
  wiring.card = body["card"];
  wiring.rate_hz = body["rate_hz"];
  wiring.transducer_name = text_or(body, "transducer");
  wiring.notes = text_or(body, "notes");
  for (const Json& input : body["inputs"]) wiring.inputs.push_back(input_from(input));
  read_played(body, wiring);
  for (std::size_t i = 0; i < wiring.inputs.size(); ++i) TACTO_TRY(check_input(wiring, i, found->where));
  if (!wiring.transducer_name.empty()) {
    const auto beside = (std::filesystem::path(found->where).parent_path() / wiring.transducer_name).string();
    wiring.transducer_file = is_file(path_of_kind("transducer", beside)) ? beside : wiring.transducer_name;
    auto transducer = read_transducer(wiring.transducer_file);
    TACTO_TRY(transducer);
    wiring.transducer = std::move(*transducer);
  }
  TACTO_TRY(check_output(wiring, found->where));
  keep_unknown(found->document, wiring);
  return wiring;
}

std::vector<std::pair<std::string, std::string>> wired_for_playback(const Wiring& wiring) {
  const auto of_subdevice = [](const std::optional<unsigned>& subdevice) {
    return subdevice ? fmt::format(" of subdevice {}", *subdevice) : "";
  };
  std::vector<std::pair<std::string, std::string>> wired;
  if (const auto& output = wiring.output)
    wired.emplace_back("drive", fmt::format("output {}, {:g} to {:g} V", output->output, output->range_from_v,
                                            output->range_to_v));
  if (const auto& encoder = wiring.encoder)
    wired.emplace_back("encoder", fmt::format("counter {}{}, {} per count", encoder->counter,
                                              of_subdevice(encoder->subdevice),
                                              for_people(encoder->step_m, Dimension::length)));
  if (const auto& watchdog = wiring.watchdog)
    wired.emplace_back("watchdog",
                       fmt::format("line {}{}", watchdog->line, of_subdevice(watchdog->subdevice)));
  return wired;
}

}  // namespace tacto::schema
