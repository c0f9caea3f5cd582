// Deletes what is kept of one person in a class' folder of results. It waits for the disk; normal threads.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace bonemill {

struct Forgotten {
    std::vector<std::string> deleted;   // one line for people per file or entry
    std::vector<std::string> problems;  // what could not be deleted, with its reason
};

// Results, reports and statements of this pseudonym in the folders `results` and `experts` of a class'
// folder, whatever the files' names are.
Forgotten forgetResults(const std::filesystem::path& class_folder, const std::string& pseudonym);

}  // namespace bonemill
