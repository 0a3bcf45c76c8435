// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of the library matio that tactograph calls. matio depends on HDF5, and loading that takes
// longer than most commands; so they are linked to a module, which is loaded at its first use.
#pragma once

#include <matio.h>

#include <cstddef>

namespace tacto::schema {

/// How a file of version 7.3 stores the numbers of an array. `bytes` is 0 if they are no numbers.
struct StoredNumbers {
  bool floating = false, has_sign = false;
  std::size_t bytes = 0;
};

/// Each member but the last two is a function Mat_... of matio.
struct MatioFunctions {
  decltype(&::Mat_Open) open;
  decltype(&::Mat_CreateVer) create;
  decltype(&::Mat_Close) close;
  decltype(&::Mat_VarReadNextInfo) next_info;
  decltype(&::Mat_VarReadInfo) info;
  decltype(&::Mat_VarReadDataAll) read_all;
  decltype(&::Mat_VarCreate) variable;
  decltype(&::Mat_VarCreateStruct2) structure;
  decltype(&::Mat_VarSetStructFieldByName) set_field;
  decltype(&::Mat_VarWrite) write;
  decltype(&::Mat_VarFree) free;
  decltype(&::Mat_VarGetNumberOfFields) fields;
  decltype(&::Mat_VarGetStructFieldnames) field_names;
  decltype(&::Mat_VarGetStructFieldByIndex) field;
  /// The number of members of a group of a file of version 7.3: variables of "/", fields of "/data". -1 if
  /// HDF5 cannot open it, as after the file was cut. matio opens such a file without an error and finds no
  /// variables; of a struct without the attribute MATLAB_fields it leaves fields out.
  long (*hdf5_members)(const char* path, const char* group);
  /// Of an array as "/data/force". matio converts to the class that the array's attribute names, whatever is
  /// stored.
  StoredNumbers (*hdf5_numbers)(const char* path, const char* array);
};

inline constexpr const char* kMatioModule = "tactograph-matio.so";
inline constexpr const char* kMatioEntry = "tacto_matio_functions";
using MatioEntry = const MatioFunctions* (*)();

}  // namespace tacto::schema
