#include "device_daemon/ares/emulator/emulator_statistics.h"

#include <nlohmann/json.hpp>

#include "common/base/units.h"

namespace bonemill {

std::string jsonLineOf(const EmulatorStatistics& s) {
    return nlohmann::ordered_json{{"ticks", s.ticks},
                                  {"missed_periods", s.missed_periods},
                                  {"wall_s", s.wall_time},
                                  {"scenario_s", s.scenario_time},
                                  {"max_tracking_mm", kPerMillimetre * s.max_tracking_error},
                                  {"stop_ticks", s.stop_ticks},
                                  {"packets_sent", s.packets_sent},
                                  {"packets_received", s.commands.accepted},
                                  {"packets_rejected", s.commands.rejected},
                                  {"packets_old", s.commands.old},
                                  {"packets_lost", s.commands.lost},
                                  {"packets_late", s.commands.late},
                                  {"watchdog_trips", s.watchdog_trips},
                                  {"final_phase", s.final_phase}}
        .dump();
}

}  // namespace bonemill
