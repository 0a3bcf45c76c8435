// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel's input for tests of its bits and for counting its ticks: on this machine, and on a Cortex-M4F
// in QEMU. Freestanding, and without arithmetic whose result depends on compiler or processor.
#pragma once

#include "firmware-host/core/kernel/tick_kernel.hpp"
#include "firmware-host/core/scene/scene_kernel.hpp"

namespace tacto::tests {

inline constexpr uint32_t kWorkloadSamples = 2000;
inline constexpr uint32_t kWorkloadTicks = 20000;
inline constexpr uint32_t kWorkloadSections = 8;
/// Hash of all its drives, equal on every machine. It changes only with the kernel or the workload.
inline constexpr uint32_t kWorkloadFingerprint = 765930658;

/// Whole numbers of 16 bits, signed: a linear congruential generator.
class WorkloadRandom {
 public:
  explicit WorkloadRandom(uint32_t seed) noexcept : state_(seed) {}
  int32_t operator()() noexcept {
    state_ = state_ * 1664525U + 1013904223U;
    return static_cast<int32_t>(state_ >> 16) - 32768;
  }
  /// Of the next numbers, scaled. Once in the program whose flash is counted.
  template <uint32_t kCount>
  void fill(float (&values)[kCount], float scale) noexcept {
    fill(values, kCount, scale);
  }

 private:
  [[gnu::noinline]] void fill(float* values, uint32_t count, float scale) noexcept {
#pragma GCC unroll 1
    for (uint32_t i = 0; i < count; ++i) values[i] = static_cast<float>((*this)()) * scale;
  }

  uint32_t state_;
};

class KernelWorkload {
 public:
  /// A profile of smoothed noise, 10 um apart, with an encoder of 1 um; eight sections of an actuator's
  /// inverse between 15 and 500 Hz at 20 kHz; a drive that sometimes reaches both limits.
  KernelWorkload() noexcept {
    float smooth = 0;
    for (float& value : profile_)
      value = smooth = 0.6F * smooth + static_cast<float>(next_()) * (1.0F / 32768);
    core::KernelSetup setup;
    setup.texture.profile = {
        profile_, {kWorkloadSamples, -500, INT64_C(1) << 30, 429496730, wire::ProfileEnds::mirror}};
    setup.limits = {5, 15708, 0.05F, 0.01F, 100, 200};
    setup.rate_hz = 20000;
    constexpr wire::Section kPeak{1.05F, -1.92F, 0.95F, -1.9F, 0.98F},
        kHigh{0.9967F, -1.9934F, 0.9967F, -1.9933F, 0.9934F};
    constexpr wire::Section kLow{0.0055F, 0.0111F, 0.0055F, -1.7786F, 0.8008F};
    const wire::Section sections[kWorkloadSections] = {kPeak, kHigh, kLow,  kPeak,
                                                       kHigh, kPeak, kHigh, {1.3F, -0.4F, 0, -0.1F, 0}};
    setup.sections = sections, setup.section_count = kWorkloadSections;
    kernel_.set(setup);
  }

  /// One tick: the finger moves by 0 to 3 counts, and sometimes reverses.
  float tick() noexcept {
    const int32_t draw = next_();
    if (draw % 500 == 0) way_ = -way_;
    count_ += way_ * (draw & 3);
    const auto output = kernel_.tick({count_, 40, ++ticks_ < kWorkloadTicks - 400, core::kNoForce});
    flags_ |= output.flags;
    return output.drive_v;
  }
  uint32_t flags() const noexcept { return flags_; }

 private:
  WorkloadRandom next_{1};
  uint32_t flags_ = 0, ticks_ = 0;
  int32_t count_ = 0, way_ = 1;
  core::TickKernel kernel_;
  float profile_[kWorkloadSamples];
};

inline constexpr uint32_t kTextureFirst = 1025, kTextureSamples = 2 * (1025 + 513), kTextureTaps = 64;
inline constexpr uint32_t kTextureFingerprint = 3341721029;

/// What a workload of a texture has; the fingerprint is that of the defaults.
struct TextureParts {
  wire::Interpolation interpolation = wire::Interpolation::hermite;
  uint16_t taps = kTextureTaps;
  const wire::Section* sections = nullptr;
  uint8_t section_count = 0;
  const wire::Hysteresis* hysteresis = nullptr;
};

/// All features of a texture in a tick: position between counts, prediction, two levels at most speeds, 64
/// taps, an occasional change of gain, energy, touch, limits.
class TextureWorkload {
 public:
  explicit TextureWorkload(const TextureParts& parts = {}) noexcept {
    float smooth = 0;
    for (float& value : samples_)
      value = smooth = 0.8F * smooth + static_cast<float>(next_()) * (1.0F / 65536);
    next_.fill(taps_, 1.0F / 131072);
    core::KernelSetup setup;
    setup.texture = texture_ = {{samples_,
                                 {kTextureFirst, -500, INT64_C(3) << 30, 429496730, wire::ProfileEnds::mirror,
                                  4, parts.interpolation}},
                                {true, 40, 40},
                                1.25F};
    setup.taps = taps_;
    setup.tap_count = parts.taps;
    setup.sections = parts.sections, setup.section_count = parts.section_count;
    setup.hysteresis = parts.hysteresis;
    setup.limits = {5, 15708, 0.05F, 0.01F, 100, 200};
    setup.rate_hz = 20000;
    setup.energy_rms_v = 1.2F, setup.energy_window_s = 0.05F;
    setup.gate_on_n = 0.2F, setup.gate_off_n = 0.1F;
    kernel_.set(setup);
  }

  /// One tick: the finger's speed varies between rest and 4 counts per tick, and sometimes reverses.
  float tick() noexcept {
    const int32_t draw = next_();
    if (draw % 700 == 0) way_ = -way_;
    if (draw % 64 == 0) speed_ = (draw >> 6) & 7;
    part_ += speed_;
    count_ += way_ * (part_ >> 1);
    part_ &= 1;
    const bool raise = ++ticks_ < kWorkloadTicks - 400;
    const float gain = (ticks_ & 4096U) != 0 ? 3.0F : 8.0F;
    const auto output = kernel_.tick({count_, gain, raise, ticks_ % 3000 < 200 ? 0.0F : 0.3F});
    flags_ |= output.flags;
    return output.drive_v;
  }
  uint32_t flags() const noexcept { return flags_; }
  /// Changes to the same texture, which costs as much as another one.
  void change(float fade_s) noexcept { kernel_.change(texture_, fade_s); }

 private:
  core::TextureSetup texture_;
  WorkloadRandom next_{7};
  uint32_t flags_ = 0, ticks_ = 0;
  int32_t count_ = 0, way_ = 1, speed_ = 3, part_ = 0;
  core::TickKernel kernel_;
  float samples_[kTextureSamples], taps_[kTextureTaps];
};

inline constexpr uint32_t kSceneFingerprint = 2099010648;

/// A scene of four overlapping patches with springs, dampers, grooves, noise, a height map, a body with
/// friction, a lasso, a mover, a field of atoms and a force map, which move and change their order, and a
/// hand in the plane whose speed varies between rest and 60 counts per tick; all limits are reached.
class SceneWorkload {
 public:
  static constexpr uint16_t kKinds[12] = {10, 0, 1, 0, 2, 3, 4, 5, 6, 7, 8, 9};
  SceneWorkload() noexcept {
    block_.header.patches = 4, block_.header.layers = 12, block_.header.numbers = kNumbers;
    block_.header.table_words = (sizeof block_.grooves + sizeof block_.noise + sizeof block_.relief +
                                 sizeof block_.bodies + sizeof block_.field + sizeof block_.forces) /
                                sizeof(uint32_t);
    block_.patches[0] = {0.01F, 0, 0.8F, 0.6F, 0.02F, 0.01F, 0, 1, 0};
    block_.patches[1] = {0, 0, 1, 0, 0.1F, 0.1F, 1, 2, 0};
    block_.patches[2] = {0, 0.01F, 0.6F, -0.8F, 0.1F, 0.03F, 3, 4, 1};
    block_.patches[3] = {-0.01F, 0, 0.8F, -0.6F, 0.03F, 0.1F, 7, 5, 1};
    const uint16_t firsts[12] = {0, 1, 4, 5, 8, 10, 12, 13, 26, 37, 39, 41};
    for (int i = 0; i < 12; ++i) block_.layers[i] = {kKinds[i], firsts[i], 0};
    block_.layers[5].table = sizeof block_.grooves / sizeof(uint32_t);
    block_.layers[6].table = (sizeof block_.grooves + sizeof block_.noise) / sizeof(uint32_t);
    constexpr uint32_t kBodies =
        (sizeof block_.grooves + sizeof block_.noise + sizeof block_.relief) / sizeof(uint32_t);
    constexpr uint32_t kTable = sizeof(core::BodyTable) / sizeof(uint32_t);
    for (uint32_t i = 0; i < 3; ++i) block_.layers[7 + i].table = kBodies + i * kTable;
    block_.layers[10].table = kBodies + sizeof block_.bodies / sizeof(uint32_t);
    block_.layers[11].table = block_.layers[10].table + sizeof block_.field / sizeof(uint32_t);
    // At 4 kHz: a body of 0.2 kg with friction, a mass of 0.1 kg with a damping of 1 N s/m, 5 cm/s.
    block_.bodies.brick = {0, 2.5e-4F, 1.25e-3F, 1.5625e-7F};
    block_.bodies.lasso = {-2.4968776e-3F, 2.4968776e-4F, 2.4968776e-3F, 3.1223966e-7F};
    block_.bodies.mover = {0.6F, 0.8F};
    block_.numbers[13] = 900, block_.numbers[14] = 2, block_.numbers[15] = 0.5F, block_.numbers[16] = 0.4F;
    block_.numbers[26] = 700, block_.numbers[27] = 0.004F;
    block_.numbers[37] = 3, block_.numbers[38] = 0.05F;
    block_.numbers[39] = 3, block_.numbers[40] = 0.002F;
    block_.numbers[41] = -1.5F;
    const float numbers[13] = {3.3F, 400, 0.003F, -0.002F, 7.7F, 60, 0.01F, 0, 1e-4F, 2, 2e-4F, 1, 2};
    for (int i = 0; i < 13; ++i) block_.numbers[i] = numbers[i];
    // 1 mm across the axis x of its patch: 0.006 and -0.008 periods per count.
    block_.grooves.table = {
        {-3, 1U << 31, {{0, 25769804, 3435973837U}, {-1, 4260607557U, 858993459}}}, 1000, 0, 9};
    const float amplitudes[9] = {0.63F, 0, -0.2F, 0, 0.11F, 0, -0.06F, 0, 0.03F};
    for (int i = 0; i < 9; ++i) block_.grooves.amplitudes[i] = amplitudes[i];
    // 2 mm along both axes of the patch, four octaves.
    block_.noise.table.along[0] = {7, 1U << 20, {{0, 12884902, 0}, {-1, 4277787426U, 0}}};
    block_.noise.table.along[1] = {-9, 1U << 30, {{0, 17179869, 0}, {0, 12884902, 0}}};
    block_.noise.table.periods_per_m = 500, block_.noise.table.octaves = 4;
    block_.noise.table.gradients = core::shuffled_noise(5);
    for (int i = 0; i < 4; ++i) block_.noise.amplitudes[i] = 0.25F / static_cast<float>(1 << i);
    // 16 x 12 samples 0.5 mm apart, and 8 x 6 of the level that a faster hand feels.
    block_.relief.table = {1000, 2, 1, 0};
    block_.relief.levels[0] = {{{7, 1U << 31, {{0, 51539607, 0}, {-1, 4226247819U, 0}}},
                                {5, 1U << 31, {{0, 68719477, 0}, {0, 51539607, 0}}}},
                               {2000, 2000},
                               16,
                               12,
                               0};
    block_.relief.levels[1] = {{{3, 1U << 31, {{0, 25769804, 0}, {-1, 4260607557U, 0}}},
                                {2, 1U << 31, {{0, 34359738, 0}, {0, 25769804, 0}}}},
                               {1000, 1000},
                               8,
                               6,
                               192};
    WorkloadRandom heights{7};
    heights.fill(block_.relief.coefficients, 1e-4F / 32768);
    // A unit is 2^-32 of 0.5 m; 16 atoms of 3 mm within 0.06 m, 9 mm around the section.
    block_.field.table = {{{0, 0, {{0, 51539, 2611340115U}, {-1, 4294898576U, 0}}},
                           {0, 0, {{0, 68719, 2052994367U}, {0, 51539, 2611340115U}}}},
                          8.589934592e9F,
                          1,
                          16};
    for (core::FieldAtom& atom : block_.field.atoms) {
      atom.x = heights() * 16384, atom.y = heights() * 16384;
      atom.z = static_cast<float>(heights()) * 2400;
      atom.squared_sigma = 6.64e14F;
      atom.lennard_jones = 4e-10F, atom.coulomb = static_cast<float>(heights()) * 1e-14F;
    }
    // As the height map, with forces up to 1 N in both components.
    block_.forces.table = block_.relief.table;
    for (int i = 0; i < 2; ++i) block_.forces.levels[i] = block_.relief.levels[i];
    heights.fill(block_.forces.coefficients, 1.0F / 32768);
    block_.header.check = core::scene_check(&block_, sizeof block_);
    core::SceneView view;
    core::read_scene_block(&block_, sizeof block_, view);
    core::ForceSetup setup;
    setup.axes[0] = {core::AxisAlong::x, 1e-5F, 20, 5};
    setup.axes[1] = {core::AxisAlong::y, 1e-5F, 20, 5};
    setup.axis_count = 2;
    setup.peak_n = 20, setup.continuous_n = 5;
    setup.slew_n_per_s = 8000, setup.rate_hz = 4000;
    setup.onset_s = setup.release_s = 0.02F;
    kernel_.set(view, setup, live_);
  }

  /// One tick; the sum of both forces.
  float tick() noexcept {
    for (int i = 0; i < 2; ++i) {
      const int32_t draw = next_();
      if (draw % 200 == 0) speed_[i] = (draw >> 4) % 61;
      if (draw % 333 == 0) speed_[i] = draw % 2;
      if (counts_[i] > 5000) speed_[i] = -speed_[i] < 0 ? -speed_[i] : speed_[i];
      if (counts_[i] < -5000) speed_[i] = -speed_[i] > 0 ? -speed_[i] : speed_[i];
      counts_[i] += speed_[i];
    }
    if (ticks_ % 701 == 700) kernel_.move(ticks_ % 4, {next_() / 16, next_() / 16}, 40);
    if (ticks_ % 901 == 900) kernel_.raise(ticks_ % 4);
    const auto output = kernel_.tick(counts_, ++ticks_ < kWorkloadTicks - 400);
    flags_ |= output.flags;
    return output.force_n[0] + output.force_n[1];
  }
  uint32_t flags() const noexcept { return flags_; }
  const auto& block() const noexcept { return block_; }

 private:
  static constexpr uint32_t kNumbers = 13 + 13 + 11 + 2 + 2 + 1;
  struct Block {
    core::SceneHeader header;
    core::ScenePatch patches[4];
    core::SceneLayer layers[12];
    float numbers[kNumbers] = {};
    struct {
      core::GroovesTable table;
      float amplitudes[9];
    } grooves;
    struct {
      core::NoiseSurfaceTable table;
      float amplitudes[4];
    } noise;
    struct {
      core::ReliefTable table;
      core::ReliefLevelTable levels[2];
      float coefficients[16 * 12 + 8 * 6];
    } relief;
    struct {
      core::BodyTable brick, lasso;
      core::MoverTable mover;
    } bodies;
    struct {
      core::FieldTable table;
      core::FieldAtom atoms[16];
    } field;
    struct {
      core::ReliefTable table;
      core::ReliefLevelTable levels[2];
      float coefficients[2 * (16 * 12 + 8 * 6)];
    } forces;
  } block_;
  WorkloadRandom next_{1990};
  uint32_t flags_ = 0, ticks_ = 0;
  int32_t counts_[2] = {}, speed_[2] = {};
  float live_[kNumbers + 4 * core::kPatchWords];
  core::SceneKernel kernel_;
};

/// FNV-1a over the bits of the drives.
class DriveFingerprint {
 public:
  void add(float drive_v) noexcept {
    uint32_t bits;
    __builtin_memcpy(&bits, &drive_v, sizeof bits);
    for (int shift = 0; shift < 32; shift += 8) hash_ = (hash_ ^ ((bits >> shift) & 0xFFU)) * 16777619U;
  }
  uint32_t value() const noexcept { return hash_; }

 private:
  uint32_t hash_ = 2166136261U;
};

}  // namespace tacto::tests
