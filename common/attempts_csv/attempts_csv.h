// Writes how a class' attempts went as text for a spreadsheet, the same in the server's class table and in
// what a viewer saves. The functions are pure; any thread may call them.
#pragma once

#include <string>

#include "proto/topics.pb.h"

namespace bonemill {

inline constexpr char kAttemptsHeader[] =
    "number,start_utc,trainee,scene,time_s,removed_mm3,max_force_n,damaged_mm3,least_distance_mm,"
    "max_protected_force_n,necrotic_mm3,max_temperature_c,structures_touched,warnings,passed,failed_gates,"
    "score_percent,results,chain";
inline constexpr size_t kAttemptColumns = 19;

// The table's first line with its end, behind a byte order mark: without one a spreadsheet takes UTF-8 for
// something else.
std::string attemptsHeaderLine();

// How many columns a header, with or without a byte order mark, has if it is kAttemptsHeader, or the
// beginning of it that an earlier release wrote (it had kFirstColumns at least); else 0.
inline constexpr size_t kFirstColumns = 14;
size_t attemptColumns(const std::string& line);

// Makes one line without its end, as UTF-8: the first `columns` of kAttemptsHeader. `scene` is what people
// call the scene, `chain` the recording's link that covers the attempt, where that is known. What the scene
// does not measure stays empty; what it measures and did not happen is 0 or "none".
std::string attemptLine(const topics::Attempt& attempt, const std::string& scene,
                        const std::string& chain = {}, size_t columns = kAttemptColumns);

// Tells whether a line of a class table, as written here or by a spreadsheet, is of this trainee.
bool isAttemptOf(const std::string& line, const std::string& trainee);

// Returns what people call the scene of this id: its title, or the id itself.
std::string sceneTitle(const topics::Lesson& lesson, const std::string& id);

// Makes the whole table, with its header.
std::string attemptsCsv(const topics::Lesson& lesson);

}  // namespace bonemill
