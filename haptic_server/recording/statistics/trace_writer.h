// Writes one CSV line per tick: the same file from a live session and from `simulate`, so that plots
// and checks compare.
//
// W is the world frame (the volume file's physical frame); force and torque act on the hand; removed_* are of
// that tick; faults is the TickFault mask as a decimal number. Where the scene has effects that say
// something, their columns follow, events as a decimal number (TickEvent mask). Doubles round-trip. It
// belongs to one normal thread.
#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include "haptic_server/core/telemetry/recorded_effects.h"
#include "haptic_server/core/telemetry/tick_record.h"

namespace bonemill {

inline constexpr char kTraceHeader[] =
    "t_s,spo_px_m,spo_py_m,spo_pz_m,spo_qw,spo_qx,spo_qy,spo_qz,dev_px_m,dev_py_m,dev_pz_m,dev_qw,dev_qx,dev_"
    "qy,dev_qz,"
    "fx_n,fy_n,fz_n,tx_nm,ty_nm,tz_nm,contacts,max_penetration_m,removed_voxels,removed_mm3,faults,tick_us";

// With all effects these follow kTraceHeader, one for each part of RecordedEffects, and the last of all.
inline constexpr char kBurrColumns[] =
    ",spin_rpm,burr_force_n,axis_torque_nm,cutting_power_w,removal_power_w,removed_energy_j";
inline constexpr char kHeatColumns[] = ",temperature_c,necrotic_mm3";
inline constexpr char kProtectionColumns[] =
    ",protected_id,protected_distance_mm,protected_force_n,damaged_mm3";
inline constexpr char kEventColumn[] = ",events";

class TraceWriter {
  public:
    // Creates or empties the file and writes the header. Throws UserError when it cannot be written.
    explicit TraceWriter(const std::string& path, const RecordedEffects& recorded = {});

    // It is false from then on once the file could not be written (disk full): the session goes
    // on without it.
    bool write(const TickRecord& record);

    // Flushes and closes; false if anything was lost. Without it the destructor closes silently.
    bool close();

  private:
    struct Close {
        void operator()(std::FILE* file) const noexcept { std::fclose(file); }
    };
    void appendEffects(const EffectRecord& effects);

    RecordedEffects recorded_;
    std::unique_ptr<std::FILE, Close> file_;
    std::string line_;
    bool is_good_ = true;
};

}  // namespace bonemill
