// Digests of everything a run decided: FNV-1a, 64 bit, over bytes. Equal runs give equal digests on every
// compiler. For normal threads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "haptic_server/core/telemetry/effect_record.h"
#include "haptic_server/core/telemetry/tick_record.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

class StateHash {
  public:
    void addBytes(const void* data, size_t size) noexcept;
    // Adds poses, wrench, contacts, removal and faults of a tick, and what its effects told if that is
    // recorded, but not its measured times.
    void addRecord(const TickRecord& record, const RecordedEffects& recorded = {}) noexcept;
    // Adds what effects told, as far as it is recorded.
    void addEffects(const EffectRecord& effects, const RecordedEffects& recorded) noexcept;
    // Adds all densities without the border of air.
    void addVolume(const VoxelVolume& volume);
    uint64_t value() const noexcept { return value_; }

  private:
    uint64_t value_ = 14695981039346656037ull;  // FNV-1a offset basis
};

// Makes digests of what the ticks of a session decided, one for each part of it, so that a replay that
// differs says where. What the clock measured and what hangs on it is not in them.
class TickHash {
  public:
    static constexpr size_t kParts = 6;
    // Names of the parts, for people.
    static constexpr std::array<std::string_view, kParts> kNames = {
        "the hand's pose", "the tool's pose", "the force on the hand", "contact", "removal", "effects"};

    explicit TickHash(const RecordedEffects& recorded = {}) : recorded_(recorded) {}

    void add(const TickRecord& record) noexcept;
    // So far, in the order of kNames.
    std::array<uint64_t, kParts> parts() const noexcept;
    // Of all parts so far: two that have once differed agree in 1 of 65,536 ticks.
    uint16_t check() const noexcept;

  private:
    RecordedEffects recorded_;
    std::array<StateHash, kParts> parts_;
};

}  // namespace bonemill
