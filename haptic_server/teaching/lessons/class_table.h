// A class' attempts as a CSV file that a spreadsheet opens: one line per attempt that has ended, written at
// once.
//
// It belongs to one normal thread. Lines are whole or not there, whatever happens; a file that is there
// already is only added to, with the columns that it has.
#pragma once

#include <string>

#include "proto/topics.pb.h"

namespace bonemill {

class ClassTable {
  public:
    // Nothing is written with an empty path. Throws UserError if the file cannot be written, or is something
    // else than a class table.
    explicit ClassTable(std::string path);

    bool hasFile() const noexcept { return !path_.empty(); }
    const std::string& path() const noexcept { return path_; }
    // Returns why the line is not there (disk full, among others), or "".
    std::string append(const topics::Attempt& attempt, const std::string& scene) const;

    // Tells whether a class table lies there. Throws UserError if that cannot be read, or another program
    // keeps it locked.
    static bool isTable(const std::string& path);
    // Takes all lines of this trainee out of it, and returns how many. Throws UserError.
    static size_t forget(const std::string& path, const std::string& trainee);

  private:
    std::string path_;
};

}  // namespace bonemill
