// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/cli/play_options.hpp"

#include "data-schema/base/playback_defaults.hpp"
#include "data-schema/base/quantity.hpp"

namespace tacto::playback {
namespace {

using schema::Dimension;
using schema::PlaybackChoices;

void add_word(CLI::App& app, const std::string& name, std::optional<std::string>& choice,
              const std::vector<std::string>& words, const std::string& help) {
  app.add_option_function<std::string>(
         name,
         [name, words, &choice](const std::string& word) { choice = words[cli::choose(name, word, words)]; },
         help)
      ->type_name(cli::words_of(words));
}

void declare_path(CLI::App& app, PlaybackChoices& c, const std::string& of) {
  add_word(app, "--interpolation", c.interpolation, {"nearest", "linear", "hermite", "sinc"},
           of + "Interpolation between the texture's samples; default: hermite");
  add_word(app, "--inverse", c.inverse, {"full", "magnitude", "gain", "none"},
           of +
               "What the drive inverts of the transducer: amplitude and phase (default), amplitude, the gain "
               "at rest, or nothing");
  add_word(app, "--reconstruction", c.reconstruction, {"none", "butterworth3"},
           of + "Analog filter behind the device's converter, inverted as well; default: that of the "
                "transducer's file, or none");
  cli::add_quantity(app, "--cutoff", c.cutoff_hz, Dimension::frequency,
                    of + "Cut-off of butterworth3 (needs --reconstruction); default: 600Hz, as in the paper");
  add_word(app, "--hold", c.hold, {"none", "zero-order"},
           of + "Whether the converter holds each sample until the next (default), inverted as well");
}

void declare_limits(CLI::App& app, PlaybackChoices& c, const std::string& of) {
  cli::add_quantity(
      app, "--energy-limit", c.energy_rms_v, Dimension::voltage,
      of + "Largest RMS of the drive at the amplifier's input; beyond it the drive is reduced; 0V: no limit");
  cli::add_quantity(app, "--energy-window", c.energy_window_s, Dimension::time,
                    of + "Time window of that RMS (needs --energy-limit); default: 1s");
  cli::add_quantity(
      app, "--contact", c.contact_on_n, Dimension::force,
      of + "Normal force from which there is a drive (the device has to report it); 0N: always");
  cli::add_quantity(
      app, "--contact-off", c.contact_off_n, Dimension::force,
      of + "Normal force below which the drive ends (needs --contact); default: 0.8 of --contact");
}

}  // namespace

schema::Result<FingerPath> FingerPathOption::read() const {
  auto path = read_finger_path(file);
  if (!path || repeats == 1) return path;
  return repeated(*path, repeats);
}

CLI::Option* declare_finger_path(CLI::App& app, FingerPathOption& option, const std::string& of_what) {
  CLI::Option* const path =
      app.add_option("--finger-path", option.file,
                     of_what +
                         "CSV with the columns time and position, with their units in the header, as "
                         "in time_s,position_mm; optionally normal_force_N");
  app.add_option("--repeat", option.repeats,
                 "How many times the finger follows the path: each time from its beginning if it ends where "
                 "it began (within 1um), else back and forth")
      ->check(cli::from_one())
      ->needs(path)
      ->capture_default_str();
  return path;
}

void declare_ends(CLI::App& app, std::optional<schema::TextureEnds>& ends, const std::string& of_what) {
  app.add_option_function<std::string>(
         "--ends",
         [&ends](const std::string& word) {
           ends = static_cast<schema::TextureEnds>(cli::choose("--ends", word, {"stop", "mirror", "loop"}));
         },
         of_what +
             "Beyond the ends of a texture: nothing (stop), its mirror image, or the texture again (loop: if "
             "the end does not meet the beginning, the last " +
             schema::length_for_people(schema::kSeamM) + " fades into the first)")
      ->type_name("stop|mirror|loop");
}

void declare_choices(CLI::App& app, PlaybackChoices& choices, const std::string& of_what) {
  declare_path(app, choices, of_what);
  declare_limits(app, choices, of_what);
}

}  // namespace tacto::playback
