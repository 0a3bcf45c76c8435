// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of the netCDF library that tactograph calls. netCDF depends on 40 libraries, and loading them
// takes longer than most commands; so they are linked to a module, which is loaded at its first use.
#pragma once

#include <netcdf.h>

namespace tacto::schema {

/// Each member is the netCDF function nc_<member>.
struct NetcdfFunctions {
  decltype(&::nc_create) create;
  decltype(&::nc_open) open;
  decltype(&::nc_close) close;
  decltype(&::nc_abort) abort;
  decltype(&::nc_strerror) strerror;
  decltype(&::nc_def_dim) def_dim;
  decltype(&::nc_def_var) def_var;
  decltype(&::nc_def_var_chunking) def_var_chunking;
  decltype(&::nc_def_var_deflate) def_var_deflate;
  decltype(&::nc_def_var_fill) def_var_fill;
  decltype(&::nc_set_var_chunk_cache) set_var_chunk_cache;
  decltype(&::nc_put_att_text) put_att_text;
  decltype(&::nc_put_att_double) put_att_double;
  decltype(&::nc_put_att_longlong) put_att_longlong;
  decltype(&::nc_put_att_schar) put_att_schar;
  decltype(&::nc_put_vara_double) put_vara_double;
  decltype(&::nc_put_vara_float) put_vara_float;
  decltype(&::nc_put_vara_schar) put_vara_schar;
  decltype(&::nc_inq_att) inq_att;
  decltype(&::nc_inq_dimid) inq_dimid;
  decltype(&::nc_inq_dimlen) inq_dimlen;
  decltype(&::nc_inq_varid) inq_varid;
  decltype(&::nc_inq_varndims) inq_varndims;
  decltype(&::nc_get_att_text) get_att_text;
  decltype(&::nc_get_att_double) get_att_double;
  decltype(&::nc_get_var_double) get_var_double;
  decltype(&::nc_get_vara_double) get_vara_double;
  decltype(&::nc_get_vara_float) get_vara_float;
};

inline constexpr const char* kNetcdfModule = "tactograph-netcdf.so";
inline constexpr const char* kNetcdfEntry = "tacto_netcdf_functions";
using NetcdfEntry = const NetcdfFunctions* (*)();

}  // namespace tacto::schema
