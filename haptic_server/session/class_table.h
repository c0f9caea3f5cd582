// A class' attempts as a CSV file that a spreadsheet opens: one line per attempt that has ended, written at
// once.
//
// It belongs to one normal thread. Lines are whole or not there, whatever happens; a file that is there
// already is only added to.
#pragma once

#include <string>

#include "proto/topics.pb.h"

namespace bonemill {

// Makes one field of it. A spreadsheet takes what begins with = + - or @ for a formula, so an apostrophe goes
// before.
std::string csvText(const std::string& text);

// Makes one line without its end: kClassTableHeader has the columns.
std::string classTableLine(const topics::Attempt& attempt);

inline constexpr char kClassTableHeader[] =
    "number,start_utc,trainee,scene,time_s,removed_mm3,max_force_n,damaged_mm3,least_distance_mm,"
    "max_protected_force_n,necrotic_mm3,max_temperature_c,structures_touched,warnings";

class ClassTable {
  public:
    // Nothing is written with an empty path. Throws UserError if the file cannot be written, or is something
    // else than a class table.
    explicit ClassTable(std::string path);

    // Returns why the line is not there (disk full, among others), or "".
    std::string append(const topics::Attempt& attempt) const;

  private:
    std::string path_;
};

}  // namespace bonemill
