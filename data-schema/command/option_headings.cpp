// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/command/option_headings.hpp"

#include <algorithm>
#include <initializer_list>

namespace tacto::cli {
namespace {

constexpr std::size_t kUsual = 10;
using Names = std::initializer_list<std::string_view>;

struct UsualOptions {
  std::string_view verb;
  Names names;
};

// With --help and --json, which every verb has: ten.
const UsualOptions kUsualOptions[] = {
    {"import", {"output", "channel", "rate", "time-column", "pitch", "speed", "surface", "force"}},
    {"record", {"device", "output", "template", "time", "strokes", "subject", "finger", "surface"}},
    {"spatial", {"output", "list", "stroke", "from", "to", "band", "grid", "average"}},
    {"spectrogram",
     {"output", "window", "resolution", "min-frequency", "max-frequency", "formants", "dynamic-range"}},
    {"formants", {"output", "force", "prominence", "go-on", "shortest", "bridge", "window", "max-frequency"}},
    {"sheet",
     {"output", "title", "columns", "formants", "window", "min-frequency", "max-frequency", "dynamic-range"}},
    {"render", {"finger-path", "output", "transducer", "device", "gain", "rate", "at", "ends"}},
    {"explain",
     {"speed", "transducer", "device", "rate", "ends", "quality", "device-memory", "interpolation"}},
    {"play", {"device", "output", "transducer", "time", "gain", "at", "ends", "finger-path"}},
    {"ctl", {"socket", "at", "gain", "ends", "fade", "save", "time"}},
    {"compare", {"a", "b", "output", "tolerance", "align", "max-shift", "stroke-a", "stroke-b"}},
    {"design", {"device", "hand", "rate", "speed", "output", "table", "z-width", "force"}},
    {"fidelity", {"device", "transducer", "speed", "time", "gain", "output", "force", "rate"}},
    {"trade", {"output", "transducer", "stroke", "force", "calibrate", "device", "hand", "finger-path"}},
    {"identify",
     {"device", "output", "start-from", "method", "picture", "results", "second-mode", "replace"}},
};

struct Heading {
  std::string_view text;
  Names names;
};

// An option has the same meaning in every verb.
const Heading kHeadings[] = {
    {"Strokes and alignment",
     {"channel", "stroke", "from", "to", "finger-up", "both-ways", "align", "align-range", "max-shift"}},
    {"Filter and grid",
     {"band", "band-in", "low", "high", "filter", "order", "edges", "grid", "method", "equalise"}},
    {"Spectrum",
     {"window", "hop", "padding", "detrend", "scaling", "spectrum-window", "max-frequency", "min-frequency",
      "compress"}},
    {"Speed against accuracy", {"quality", "max-error", "explain", "max-tick"}},
    {"Drive computation",
     {"interpolation", "inverse", "reconstruction", "cutoff", "hold", "keep-hysteresis", "no-look-ahead",
      "engine", "encoder-step", "rate", "loop", "onset", "target", "displacement"}},
    {"Limits", {"energy-limit", "energy-window", "over-limit", "contact", "contact-off"}},
    {"Stored in the file", {"subject", "finger", "surface", "notes", "humidity", "date", "calibrated"}},
    {"Calibration", {"calibration", "no-calibration", "stale-after", "allow-gaps"}},
    {"Measuring and tables",
     {"amplitude", "frequencies", "lag", "fit-on", "amplitude-unit", "phase-unit", "phase-sign", "invert",
      "input", "output-channel"}},
};

bool holds(const Names& names, const CLI::Option& option) {
  return std::ranges::any_of(option.get_lnames(), [&](const std::string& name) {
    return std::ranges::find(names, name) != names.end();
  });
}

std::string heading_of(const CLI::Option& option) {
  for (const Heading& heading : kHeadings)
    if (holds(heading.names, option)) return std::string(heading.text);
  return "More options";
}

bool is_usual(std::string_view verb, const CLI::Option& option) {
  if (holds({"help", "json"}, option)) return true;
  const auto found = std::ranges::find(kUsualOptions, verb, &UsualOptions::verb);
  return found != std::end(kUsualOptions) && holds(found->names, option);
}

}  // namespace

void put_below_headings(std::string_view verb, CLI::App& app) {
  std::vector<CLI::Option*> named;
  for (CLI::Option* option : app.get_options())
    if (!option->get_positional() && !option->get_group().empty()) named.push_back(option);  // no hidden ones
  if (named.size() <= kUsual) return;
  for (CLI::Option* option : named)
    option->group(is_usual(verb, *option) ? "Usual options" : heading_of(*option));
}

}  // namespace tacto::cli
