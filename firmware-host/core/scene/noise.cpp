// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/scene/noise.hpp"

namespace tacto::core {
namespace {

struct Gradient {
  float x, y, z;
};

// The middles of a cube's edges, four of them twice, as in Perlin's grad().
constexpr Gradient kGradients[16] = {
    {1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {-1, -1, 0}, {1, 0, 1}, {-1, 0, 1}, {1, 0, -1}, {-1, 0, -1},
    {0, 1, 1}, {0, -1, 1}, {0, 1, -1}, {0, -1, -1}, {1, 1, 0}, {0, -1, 1}, {-1, 1, 0}, {0, -1, -1}};

// 6 t^5 - 15 t^4 + 10 t^3 for t up to a half; above it the same from the other end, because there the terms
// cancel.
float rising_half(float t) noexcept {
  return t * t * t * (t * (t * 6 - 15) + 10);
}

float fade(float t) noexcept {
  return t <= 0.5F ? rising_half(t) : 1 - rising_half(1 - t);
}

float fade_slope(float t) noexcept {
  const float product = t * (1 - t);
  return 30 * product * product;
}

// Interpolation of what varies along x, y or z: the corners are 0 and 1.
struct Mix {
  float at_0, at_1;  // weights

  explicit Mix(float part) noexcept : at_0(fade(1 - part)), at_1(fade(part)) {}
  float of(float a, float b) const noexcept { return at_0 * a + at_1 * b; }
};

// The contribution of one corner of the cell, at the place (x, y, z) relative to it.
NoiseSample corner(uint8_t hash, float x, float y, float z) noexcept {
  const Gradient& g = kGradients[hash & 15];
  return {g.x * x + g.y * y + g.z * z, g.x, g.y};
}

NoiseSample mixed(const Mix& mix, const NoiseSample& a, const NoiseSample& b) noexcept {
  return {mix.of(a.value, b.value), mix.of(a.by_x, b.by_x), mix.of(a.by_y, b.by_y)};
}

struct Hash {
  const NoiseTable& table;
  uint8_t operator()(uint32_t of) const noexcept { return table.order[of & 255]; }
};

// The four corners of a cell at one z.
NoiseSample slice(const Hash& hash, const uint8_t (&columns)[4], uint32_t z, const LatticePlace& x,
                  const LatticePlace& y, float z_part) noexcept {
  const float du = fade_slope(x.part), dv = fade_slope(y.part);
  const Mix along_x(x.part), along_y(y.part);
  const NoiseSample c00 = corner(hash(columns[0] + z), x.part, y.part, z_part),
                    c10 = corner(hash(columns[1] + z), x.part - 1, y.part, z_part),
                    c01 = corner(hash(columns[2] + z), x.part, y.part - 1, z_part),
                    c11 = corner(hash(columns[3] + z), x.part - 1, y.part - 1, z_part);
  const NoiseSample low = mixed(along_x, c00, c10), high = mixed(along_x, c01, c11);
  NoiseSample sample = mixed(along_y, low, high);
  sample.by_x += du * along_y.of(c10.value - c00.value, c11.value - c01.value);
  sample.by_y += dv * (high.value - low.value);
  return sample;
}

uint32_t next_random(uint32_t& state) noexcept {
  state ^= state << 13;
  state ^= state >> 17;
  state ^= state << 5;
  return state;
}

}  // namespace

const NoiseTable kPerlinNoise = {
    {151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,
     69,  142, 8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,
     94,  252, 219, 203, 117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136,
     171, 168, 68,  175, 74,  165, 71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122,
     60,  211, 133, 230, 220, 105, 92,  41,  55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161,
     1,   216, 80,  73,  209, 76,  132, 187, 208, 89,  18,  169, 200, 196, 135, 130, 116, 188, 159, 86,
     164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250, 124, 123, 5,   202, 38,  147, 118, 126,
     255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189, 28,  42,  223, 183, 170, 213,
     119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,   129, 22,  39,  253,
     19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,  242, 193,
     238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
     181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,
     222, 114, 67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180}};

NoiseTable shuffled_noise(uint32_t seed) noexcept {
  NoiseTable table = kPerlinNoise;
  if (seed == 0) return table;
  for (uint32_t last = 255; last > 0; --last) {
    const uint32_t other = next_random(seed) % (last + 1);
    const uint8_t kept = table.order[last];
    table.order[last] = table.order[other];
    table.order[other] = kept;
  }
  return table;
}

NoiseSample noise(const NoiseTable& table, Q32 x_place, Q32 y_place, Q32 z_place) noexcept {
  const Hash hash{table};
  const LatticePlace x = lattice_place(x_place), y = lattice_place(y_place), z = lattice_place(z_place);
  const auto cell_x = static_cast<uint32_t>(x.cell), cell_y = static_cast<uint32_t>(y.cell),
             cell_z = static_cast<uint32_t>(z.cell);
  const uint32_t a = hash(cell_x) + cell_y, b = hash(cell_x + 1) + cell_y;
  const uint8_t columns[4] = {hash(a), hash(b), hash(a + 1), hash(b + 1)};
  const NoiseSample low = slice(hash, columns, cell_z, x, y, z.part);
  if (z.part == 0) return low;
  return mixed(Mix(z.part), low, slice(hash, columns, cell_z + 1, x, y, z.part - 1));
}

NoiseSample fractal_noise(const NoiseTable& table, Q32 x, Q32 y, Q32 z, const float* weights,
                          uint32_t octaves) noexcept {
  NoiseSample sum;
  float finer_by = 1;
  for (uint32_t i = 0; i < octaves; ++i, finer_by *= 2) {
    if (weights[i] == 0) continue;
    const NoiseSample octave = noise(table, finer(x, i), finer(y, i), finer(z, i));
    sum.value += weights[i] * octave.value;
    sum.by_x += weights[i] * finer_by * octave.by_x;
    sum.by_y += weights[i] * finer_by * octave.by_y;
  }
  return sum;
}

}  // namespace tacto::core
