// Writes how a class' attempts went as text for a spreadsheet, the same in the server's class table and in
// what a viewer saves. The functions are pure; any thread may call them.
#pragma once

#include <string>

#include "proto/topics.pb.h"

namespace bonemill {

inline constexpr char kAttemptsHeader[] =
    "number,start_utc,trainee,scene,time_s,removed_mm3,max_force_n,damaged_mm3,least_distance_mm,"
    "max_protected_force_n,necrotic_mm3,max_temperature_c,structures_touched,warnings";

// Makes one line without its end, as UTF-8: kAttemptsHeader has the columns. `scene` is what people call the
// scene. What the scene does not measure stays empty; what it measures and did not happen is 0 or "none".
std::string attemptLine(const topics::Attempt& attempt, const std::string& scene);

// Returns what people call the scene of this id: its title, or the id itself.
std::string sceneTitle(const topics::Lesson& lesson, const std::string& id);

// Makes the whole table, with its header.
std::string attemptsCsv(const topics::Lesson& lesson);

}  // namespace bonemill
