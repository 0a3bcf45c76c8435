// SPDX-License-Identifier: GPL-3.0-or-later
// The module tactograph-matio.so.
#include "data-schema/exchange/matio/matio_functions.hpp"

#include <H5Dpublic.h>
#include <H5Epublic.h>
#include <H5Fpublic.h>
#include <H5Lpublic.h>
#include <H5Ppublic.h>
#include <H5Tpublic.h>
#include <H5public.h>

namespace {

void say_nothing(int /*level*/, char* /*message*/) {}

// MATLAB's own groups begin with '#'.
herr_t count_link(hid_t /*group*/, const char* name, const H5L_info_t* /*info*/, void* count) {
  *static_cast<long*>(count) += name[0] == '#' ? 0 : 1;
  return 0;
}

long hdf5_members(const char* path, const char* group) {
  const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) return -1;
  long count = 0;
  const herr_t done = H5Literate_by_name(file, group, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, count_link,
                                         &count, H5P_DEFAULT);
  H5Fclose(file);
  return done < 0 ? -1 : count;
}

tacto::schema::StoredNumbers hdf5_numbers(const char* path, const char* array) {
  tacto::schema::StoredNumbers stored;
  const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t set = file < 0 ? -1 : H5Dopen2(file, array, H5P_DEFAULT);
  const hid_t type = set < 0 ? -1 : H5Dget_type(set);
  if (type >= 0) {
    const H5T_class_t kind = H5Tget_class(type);
    stored.floating = kind == H5T_FLOAT;
    stored.has_sign = kind == H5T_FLOAT || H5Tget_sign(type) == H5T_SGN_2;
    stored.bytes = kind == H5T_FLOAT || kind == H5T_INTEGER ? H5Tget_size(type) : 0;
    H5Tclose(type);
  }
  if (set >= 0) H5Dclose(set);
  if (file >= 0) H5Fclose(file);
  return stored;
}

}  // namespace

/// The table of functions. After the first call matio and HDF5 print nothing: their failures are returned.
extern "C" __attribute__((visibility("default"))) const tacto::schema::MatioFunctions*
tacto_matio_functions() {
  static constexpr tacto::schema::MatioFunctions kFunctions = {
      Mat_Open,
      Mat_CreateVer,
      Mat_Close,
      Mat_VarReadNextInfo,
      Mat_VarReadInfo,
      Mat_VarReadDataAll,
      Mat_VarCreate,
      Mat_VarCreateStruct2,
      Mat_VarSetStructFieldByName,
      Mat_VarWrite,
      Mat_VarFree,
      Mat_VarGetNumberOfFields,
      Mat_VarGetStructFieldnames,
      Mat_VarGetStructFieldByIndex,
      hdf5_members,
      hdf5_numbers,
  };
  // As in the module of netCDF: HDF5's clean-up at exit crashes after a full disk.
  [[maybe_unused]] static const herr_t no_cleanup = H5dont_atexit();
  [[maybe_unused]] static const herr_t no_printing = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  [[maybe_unused]] static const int no_log = Mat_LogInitFunc("tactograph", say_nothing);
  return &kFunctions;
}
