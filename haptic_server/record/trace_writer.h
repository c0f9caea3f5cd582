// One CSV line per tick: the same file from a live session and from `simulate`, so that plots and checks
// compare.
//
// W is the world frame (the volume file's physical frame); force and torque act on the hand; removed_* are of
// that tick; faults is the TickFault mask as a decimal number. Doubles round-trip. One normal thread.
#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include "haptic_server/tick/tick_record.h"

namespace bonemill {

inline constexpr char kTraceHeader[] =
    "t_s,spo_px_m,spo_py_m,spo_pz_m,spo_qw,spo_qx,spo_qy,spo_qz,dev_px_m,dev_py_m,dev_pz_m,dev_qw,dev_qx,dev_"
    "qy,dev_qz,"
    "fx_n,fy_n,fz_n,tx_nm,ty_nm,tz_nm,contacts,max_penetration_m,removed_voxels,removed_mm3,faults,tick_us";

class TraceWriter {
  public:
    // Creates or empties the file and writes the header. Throws UserError when it cannot be written.
    explicit TraceWriter(const std::string& path);

    // False, from then on, once the file could not be written (disk full): the session goes on without it.
    bool write(const TickRecord& record);

    // Flushes and closes; false if anything was lost. Without it the destructor closes silently.
    bool close();

  private:
    struct Close {
        void operator()(std::FILE* file) const noexcept { std::fclose(file); }
    };
    std::unique_ptr<std::FILE, Close> file_;
    std::string line_;
    bool is_good_ = true;
};

}  // namespace bonemill
