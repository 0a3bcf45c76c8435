// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of the library libzip that tactograph calls. libzip depends on libraries of cryptography and
// compression; so they are linked to a module, which is loaded at its first use.
#pragma once

#include <zip.h>

namespace tacto::schema {

/// Each member is a function zip_... of libzip.
struct ZipFunctions {
  decltype(&::zip_open) open;
  decltype(&::zip_discard) close;
  decltype(&::zip_get_num_entries) entries;
  decltype(&::zip_stat_index) stat;
  decltype(&::zip_fopen_index) open_entry;
  decltype(&::zip_fread) read;
  decltype(&::zip_fclose) close_entry;
};

inline constexpr const char* kZipModule = "tactograph-zip.so";
inline constexpr const char* kZipEntry = "tacto_zip_functions";
using ZipEntry = const ZipFunctions* (*)();

}  // namespace tacto::schema
