// SPDX-License-Identifier: Apache-2.0
// The tick: read the inputs, decide, drive, record.
#pragma once

#include "firmware-host/core/firmware/drive_supervisor.hpp"
#include "firmware-host/core/firmware/encoder_watch.hpp"
#include "firmware-host/core/firmware/hal.hpp"
#include "firmware-host/core/firmware/sweep_generator.hpp"
#include "firmware-host/core/kernel/ring.hpp"
#include "firmware-host/core/kernel/tick_kernel.hpp"
#include "firmware-host/core/scene/scene_kernel.hpp"
#include "firmware-host/core/wire/message_types.hpp"

namespace tacto::core {

// The data of one tick that the device streams.

inline constexpr uint32_t kRingRecords = 256;  ///< 12.8 ms at 20 kHz
inline constexpr uint32_t kDriveQueue = 1024;  ///< samples

struct Record {
  uint64_t clock = 0, frame = 0, tick = 0;
  int32_t encoder = 0;
  float drive_v = 0;
  uint32_t flags = 0;  ///< wire::TickFlag
  uint8_t run = 0;     ///< the number of the stream's start
  bool sampled = false, driven = false;
  uint8_t axes = 0;  ///< of a scene; 0: the tick has a drive
  int32_t codes[wire::kMaxChannels] = {};
  int32_t counts[wire::kMaxAxes] = {};
  float force_n[wire::kMaxAxes] = {};
};

/// Counters of the tick; the main loop reads them.
struct TickCounts {
  uint32_t late = 0, lost_records = 0, underruns = 0, amplitude_limited = 0, slew_limited = 0;
};

/// A scene to arm. `limits` are those of the supervisor.
struct SceneArm {
  SceneView scene;
  ForceSetup setup;
  float* live = nullptr;
  wire::Limits limits;
  uint32_t counts_per_tick = 0;
};

inline constexpr uint32_t kSceneChanges = 16;

/// A command that changes the scene that plays: `type` says which.
struct SceneChange {
  wire::MessageType type = wire::MessageType::set;
  wire::Set set;
  wire::Move move;
  wire::Raise raise;
};

/// tick() is called by the timer's interrupt and does not wait, allocate, lock or throw; the main loop calls
/// the other functions.
class Ticker {
 public:
  explicit Ticker(const Hal& hal) noexcept : hal_(hal) {}

  void tick() noexcept;

  /// Call before the first tick at a rate. `clocks`: clock ticks per period.
  void set_period(float clocks) noexcept {
    late_clocks_ = static_cast<uint32_t>(1.5F * clocks), ticked_ = false;
  }
  /// Frames begin at 0 with the next tick. The records of this run contain the returned number.
  uint8_t start_stream() noexcept;
  void stop_stream() noexcept { stream_.store(Stream::off); }
  bool streaming() const noexcept { return stream_.load() != Stream::off; }

  /// Only in idle; all data of the source must be set.
  void arm(wire::DriveSource source, const KernelSetup& setup, uint32_t rate_millihertz) noexcept;
  /// The same for the forces of a scene.
  void arm(const SceneArm& scene, uint32_t rate_millihertz) noexcept;
  /// Changes the scene, from the tick that first counts it. False if kSceneChanges wait already.
  /// Preconditions: those of SceneKernel::change() and move(); the scene has the patch.
  bool steer(const SceneChange& change) noexcept;
  /// Before arm(): the channel of the normal force.
  void watch_force(const wire::Contact& contact) noexcept { contact_ = contact; }
  /// In effect from the tick that first counts it.
  void set_gain(float gain) noexcept { gain_.store(gain), steered(); }
  /// Cross-fades to another texture over fade_s, from the tick that first counts it. Only if armed with a
  /// profile and not fading().
  void change(const TextureSetup& texture, float fade_s) noexcept;
  /// Whether a change is still fading and the old texture is still read. Valid until the drive is idle.
  bool fading() const noexcept { return change_.load() != kNoChange; }
  wire::DriveSource source() const noexcept { return source_; }
  /// Call after a command has changed the drive.
  void steered() noexcept { steered_.store(static_cast<uint8_t>(steered_.load() + 1)); }
  TickKernel& kernel() noexcept { return kernel_; }
  const SceneKernel& scene() const noexcept { return scene_; }
  SweepGenerator& sweep() noexcept { return sweep_; }
  DriveSupervisor& supervisor() noexcept { return supervisor_; }
  const DriveSupervisor& supervisor() const noexcept { return supervisor_; }
  Ring<float, kDriveQueue>& drive_queue() noexcept { return drive_queue_; }
  Ring<Record, kRingRecords>& records() noexcept { return records_; }

  const TickCounts& counts() const noexcept { return counts_; }
  void forget_counts() noexcept { counts_ = {}; }
  /// Returns the stream's fault, once; none if there is none.
  wire::FaultCode take_stream_fault() noexcept;
  uint64_t fault_clock() const noexcept { return fault_clock_; }

 private:
  enum class Stream : uint8_t { off, starting, on };
  void look(Record& record) noexcept;
  void sample(Record& record) noexcept;
  void drive(Record& record) noexcept;
  void drive_tray(Record& record) noexcept;
  void drive_forces(Record& record) noexcept;
  void begin_arm(wire::DriveSource source) noexcept;
  void rest() noexcept;
  void take_scene_changes() noexcept;
  void take_steering(Record& record) noexcept;
  void take_change() noexcept;
  void end_change() noexcept;
  int32_t follow(Record& record) noexcept;
  float target(int32_t count, bool& lacks) noexcept;
  float normal_force(Record& record) noexcept;
  void count(uint32_t flags) noexcept;
  void keep(bool there, const Record& record) noexcept;
  void tell(wire::FaultCode code) noexcept { stream_fault_.store(code); }

  Hal hal_;
  TickKernel kernel_;
  struct CountedChange {
    SceneChange change;
    uint8_t count = 0;  // of the command
  };
  SweepGenerator sweep_;
  SceneKernel scene_;
  EncoderWatch axis_watch_[wire::kMaxAxes];
  uint8_t axes_ = 0;  // of the scene
  Ring<CountedChange, kSceneChanges> scene_changes_;
  DriveSupervisor supervisor_;
  EncoderWatch watch_;
  Ring<float, kDriveQueue> drive_queue_;
  Ring<Record, kRingRecords> records_;
  Record spare_;
  wire::DriveSource source_ = wire::DriveSource::profile;
  wire::Contact contact_;
  Shared<float> gain_{1.0F};
  Shared<uint8_t> steered_;
  // The main loop writes this word if it is kNoChange, the tick if it is not.
  static constexpr uint16_t kNoChange = 0, kChangeAsked = 0x100;  // plus the count of the command
  Shared<uint16_t> change_{kNoChange};
  TextureSetup next_texture_;
  float fade_s_ = 0;
  float gain_taken_ = 1;
  uint8_t steered_taken_ = 0;
  bool change_taken_ = false;
  Shared<Stream> stream_{Stream::off};
  Shared<wire::FaultCode> stream_fault_{wire::FaultCode::none};
  Shared<uint8_t> run_;
  uint64_t frame_ = 0, tick_ = 0, last_clock_ = 0, fault_clock_ = 0;
  uint32_t late_clocks_ = 0;
  bool ticked_ = false, losing_ = false;
  TickCounts counts_;
};

}  // namespace tacto::core
