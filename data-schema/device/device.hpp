// SPDX-License-Identifier: GPL-3.0-or-later
// A force device of one to three axes: what moves, what it measures and what force it gives. Forces are
// newtons on the hand.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// One axis: mass x'' = force + hand - viscous x' - coulomb sign(x'). All members are required.
struct DeviceAxis {
  std::string name;              ///< x, y or z
  double mass_kg = 0;            ///< that the hand moves along this axis
  double viscous_n_s_per_m = 0;  ///< friction that grows with the speed
  double coulomb_n = 0;          ///< friction that does not depend on the speed
  double encoder_step_m = 0;     ///< displacement of one encoder count
  double travel_from_m = 0;      ///< where the axis ends
  double travel_to_m = 0;
  double peak_force_n = 0;        ///< largest absolute force, for a short time
  double continuous_force_n = 0;  ///< largest RMS force, for any time
};

struct Device {
  std::string name;
  std::vector<DeviceAxis> axes;   ///< one to three
  double peak_force_n = 0;        ///< largest absolute value of the force vector
  double continuous_force_n = 0;  ///< largest RMS of the force vector
  double slew_n_per_s = 0;        ///< largest rate of change of the force of each axis
  double delay_s = 0;             ///< from reading the encoders to the change of the force
  std::vector<double> rates_hz;   ///< tick rates that the device can run, increasing
  /// The transducer of a tray beside the axes: a preset, or a stem from the folder of the device's file.
  /// Empty if the device has none.
  std::string transducer;
  std::string source;  ///< paper and equation, datasheet, identification
  std::string notes;
  std::string extra_json;     ///< members that the schema does not name
  std::string newer_version;  ///< with which it is written again
  std::vector<std::string> unknown_members = {};
};

/// Checks what the schema cannot: that each number can belong to a force device (the ranges and their origins
/// are in the .cpp), that axes have different names, that a travel is longer than an encoder step, that no
/// continuous force is above its peak, that rates increase. `where` is the file. Errors: unsuitable, at
/// `where`#/member, with value and range.
Result<void> check_device(const Device& device, const std::string& where);

/// The names of the devices that come with tactograph.
std::vector<std::string_view> device_preset_names();

/// Mass, friction or encoder step of an axis, where the file has none.
struct AssumedNumber {
  std::string place;   ///< of the axis, "axes/0"
  std::string member;  ///< "mass_kg"
  double value = 0;
};

/// By preset name, stem or file (NAME.device.json). Errors: not_found (with the presets), malformed (also an
/// unknown member, with the nearest known one; in a newer minor version it is kept),
/// unsupported_version; unsuitable: by check_device. With `assumed`, mass, friction and encoder step may be
/// absent: they get the values that are listed there.
Result<Device> read_device(const std::string& name, std::vector<AssumedNumber>* assumed = nullptr);

/// NAME.device.json of a stem or file name; replaces an existing file. Errors: cannot_write; unsuitable: by
/// check_device and by the schema.
Result<void> write_device(const std::string& stem, const Device& device);

}  // namespace tacto::schema
