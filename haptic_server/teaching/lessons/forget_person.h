// `bonemill_lab session forget`: deletes what a class' folder holds of one person. It waits for the disk.
#pragma once

#include <ostream>
#include <string>

namespace bonemill {

struct ForgetOptions {
    std::string pseudonym;
    std::string folder;      // of the class table
    std::string recordings;  // folder of recordings; empty: that of the class table, too
};

// Takes the person's lines out of every class table in the folder, deletes results, reports and statements,
// and the recordings that hold no other person's attempts, and says on `out` what was deleted and what must
// still be looked at. Returns the exit code: 1 if something is left. Throws UserError if the folder is none.
int forgetPerson(const ForgetOptions& options, std::ostream& out);

}  // namespace bonemill
