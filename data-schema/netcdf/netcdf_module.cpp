// SPDX-License-Identifier: GPL-3.0-or-later
// The module tactograph-netcdf.so.
#include "data-schema/netcdf/netcdf_functions.hpp"

#include <H5public.h>

/// The table of functions. The first call has to precede the first use of HDF5.
extern "C" __attribute__((visibility("default"))) const tacto::schema::NetcdfFunctions*
tacto_netcdf_functions() {
  static constexpr tacto::schema::NetcdfFunctions kFunctions = {
      nc_create,
      nc_open,
      nc_close,
      nc_abort,
      nc_strerror,
      nc_def_dim,
      nc_def_var,
      nc_def_var_chunking,
      nc_def_var_deflate,
      nc_def_var_fill,
      nc_set_var_chunk_cache,
      nc_put_att_text,
      nc_put_att_double,
      nc_put_att_longlong,
      nc_put_att_schar,
      nc_put_vara_double,
      nc_put_vara_float,
      nc_put_vara_schar,
      nc_inq_att,
      nc_inq_dimid,
      nc_inq_dimlen,
      nc_inq_varid,
      nc_inq_varndims,
      nc_get_att_text,
      nc_get_att_double,
      nc_get_var_double,
      nc_get_vara_double,
      nc_get_vara_float,
  };
  // HDF5's clean-up at exit uses files whose closing failed, and crashes (1.10.8, on a full disk).
  // NetcdfWriter closes every file itself.
  [[maybe_unused]] static const herr_t said = H5dont_atexit();
  return &kFunctions;
}
