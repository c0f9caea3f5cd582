// Makes a digest of everything a run decided: FNV-1a, 64 bit, over bytes. Equal runs give equal digests
// on every compiler.
#pragma once

#include <cstddef>
#include <cstdint>

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

}  // namespace bonemill
