// SPDX-License-Identifier: GPL-3.0-or-later
// The module tactograph-zip.so.
#include "data-schema/exchange/zip/zip_functions.hpp"

extern "C" __attribute__((visibility("default"))) const tacto::schema::ZipFunctions* tacto_zip_functions() {
  static constexpr tacto::schema::ZipFunctions kFunctions = {
      zip_open, zip_discard, zip_get_num_entries, zip_stat_index, zip_fopen_index, zip_fread, zip_fclose,
  };
  return &kFunctions;
}
