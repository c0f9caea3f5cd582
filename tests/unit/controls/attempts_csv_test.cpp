#include "render_client/controls/attempts_csv.h"

#include <gtest/gtest.h>

#include "tests/support/class_lesson.h"

namespace bonemill {
namespace {

TEST(AttemptsCsv, HasALinePerAttemptAndUnitsInTheHeader) {
    const std::string text = attemptsCsv(test::makeLesson());
    EXPECT_EQ(text,
              "attempt,trainee,scene,start_utc,time_s,removed_mm3,max_force_n,structures_touched,damaged_mm3,"
              "least_distance_mm,max_protected_force_n,necrotic_mm3,max_temperature_c\n"
              "1,\"Anna\",\"cavity\",2026-11-23T19:00:00Z,151,12.34,5.1,\"\",,,,0.2,48.5\n"
              "2,\"'=Ben\",\"cavity\",2026-11-23T19:00:00Z,151,12.34,5.1,\"pulp\",,,,0.2,48.5\n");
}

TEST(AttemptsCsv, NoNameIsAFormulaOrBreaksItsCell) {
    topics::Lesson lesson;
    for (const char* name : {"=1+1", "+1", "-1", "@a", "\tx", "a\"b,c\nd"})
        lesson.add_attempts()->set_trainee(name);
    const std::string text = attemptsCsv(lesson);
    for (const char* cell : {"\"'=1+1\"", "\"'+1\"", "\"'-1\"", "\"'@a\"", "\"'\tx\"", "\"a\"\"b,c\nd\""})
        EXPECT_NE(text.find(cell), std::string::npos) << cell;
    EXPECT_EQ(attemptsCsv({}), text.substr(0, text.find('\n') + 1)) << "without attempts the header";
}

}  // namespace
}  // namespace bonemill
