// SPDX-License-Identifier: GPL-3.0-or-later
// How what is played is read, undone and held back: what a scene, the daemon's configuration and a `load` may
// say of it, all in the same members.
#pragma once

#include <optional>
#include <string>

namespace tacto::schema {

/// Words and bounds are those of the schemas' definition `playback`. What nobody says is for the one below
/// to say: a request before the scene, the scene before the configuration.
struct PlaybackChoices {
  std::optional<std::string> interpolation;   ///< nearest, linear, hermite, sinc
  std::optional<std::string> inverse;         ///< full, magnitude, gain, none
  std::optional<std::string> reconstruction;  ///< none, butterworth3: the filter behind the converter
  std::optional<double> cutoff_hz;            ///< of butterworth3
  std::optional<std::string> hold;            ///< none, zero-order
  std::optional<double> energy_rms_v;         ///< most RMS of the drive, V; 0: no such limit
  std::optional<double> energy_window_s;      ///< over which
  std::optional<double> contact_on_n;         ///< normal force from which on there is a drive, N; 0: always
  std::optional<double> contact_off_n;        ///< below it there is none any more
  std::string extra_json;                     ///< members of a newer version

  /// These, and what they leave open as `base` has it. A contact_on_n here leaves base's contact_off_n out.
  PlaybackChoices over(const PlaybackChoices& base) const;
  bool operator==(const PlaybackChoices&) const = default;
};

/// The members by their names in files.
struct ChosenWord {
  const char* name;
  std::optional<std::string> PlaybackChoices::*member;
};
inline constexpr ChosenWord kChosenWords[] = {{"interpolation", &PlaybackChoices::interpolation},
                                              {"inverse", &PlaybackChoices::inverse},
                                              {"reconstruction", &PlaybackChoices::reconstruction},
                                              {"hold", &PlaybackChoices::hold}};

struct ChosenNumber {
  const char* name;
  std::optional<double> PlaybackChoices::*member;
};
inline constexpr ChosenNumber kChosenNumbers[] = {{"cutoff_hz", &PlaybackChoices::cutoff_hz},
                                                  {"energy_rms_v", &PlaybackChoices::energy_rms_v},
                                                  {"energy_window_s", &PlaybackChoices::energy_window_s},
                                                  {"contact_on_n", &PlaybackChoices::contact_on_n},
                                                  {"contact_off_n", &PlaybackChoices::contact_off_n}};

}  // namespace tacto::schema
