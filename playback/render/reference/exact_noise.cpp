// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/render/reference/exact_noise.hpp"

#include <cmath>

namespace tacto::playback {
namespace {

double smooth_step(double t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}

double gradient_part(int hash, double x, double y, double z) {
  const int h = hash & 15;
  const double u = h < 8 ? x : y;
  double v = z;
  if (h < 4) v = y;
  if (h == 12 || h == 14) v = x;
  return ((h & 1) == 0 ? u : -u) + ((h & 2) == 0 ? v : -v);
}

}  // namespace

double exact_noise(const core::NoiseTable& table, double x, double y, double z) {
  const auto p = [&](int i) { return static_cast<int>(table.order[i & 255]); };
  const auto cell = [](double at) { return static_cast<int>(std::fmod(std::floor(at), 256)); };
  const int cx = cell(x), cy = cell(y), cz = cell(z);
  x -= std::floor(x), y -= std::floor(y), z -= std::floor(z);
  const double u = smooth_step(x), v = smooth_step(y), w = smooth_step(z);
  const int a = p(cx) + cy, aa = p(a) + cz, ab = p(a + 1) + cz;
  const int b = p(cx + 1) + cy, ba = p(b) + cz, bb = p(b + 1) + cz;
  const auto slice = [&](int up, double dz) {
    return std::lerp(
        std::lerp(gradient_part(p(aa + up), x, y, dz), gradient_part(p(ba + up), x - 1, y, dz), u),
        std::lerp(gradient_part(p(ab + up), x, y - 1, dz), gradient_part(p(bb + up), x - 1, y - 1, dz), u),
        v);
  };
  return std::lerp(slice(0, z), slice(1, z - 1), w);
}

}  // namespace tacto::playback
