// SPDX-License-Identifier: GPL-3.0-or-later
// Writes OUT.nc with one spectrogram, and OUT-two.nc with two, for spectrogram_netcdf_test.py, which contains
// the same formulas: at position p (from 0) and bin k the density is (1 + p + 100 k) 1e-6 N^2 m, in stroke 2
// twice that. The valid bins are 2.5 + p to 20.5.
#include <array>
#include <string>

#include "data-schema/spectrogram/spectrogram.hpp"

namespace {

using tacto::schema::Spectrogram;

Spectrogram sample(std::size_t positions, float factor) {
  Spectrogram s;
  s.name = factor == 1 ? "oak-01" : "oak-02";
  s.quantity = "tangential_force";
  s.unit = "N";
  s.window = "blackman";
  s.window_m = 10e-3;
  s.hop_m = 0.5e-3;
  s.pitch_m = 1e-6;
  s.padded_samples = 16384;
  s.bins = 40;
  s.frequency_step_per_m = 1e6 / 16384;
  s.simulated = "a formula";
  for (std::size_t p = 0; p < positions; ++p) {
    s.position_m.push_back(5e-3 + 0.5e-3 * static_cast<double>(p));
    s.known.push_back(
        {(2.5 + static_cast<double>(p)) * s.frequency_step_per_m, 20.5 * s.frequency_step_per_m});
    for (std::size_t k = 0; k < s.bins; ++k)
      s.cells.push_back(factor * 1e-6F * static_cast<float>(1 + p + 100 * k));
  }
  return s;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::string out = argv[1];
  const std::array both = {sample(30, 1), sample(20, 2)};
  const bool one = tacto::schema::write_spectrogram_nc(out + ".nc", std::span(both).first(1)).has_value();
  return one && tacto::schema::write_spectrogram_nc(out + "-two.nc", both).has_value() ? 0 : 1;
}
