// A scan out of an archive, in a folder that lives as long as this, and that nobody else can look into.
#pragma once

#include <filesystem>
#include <string>

#include "haptic_server/scans/confined/guarded_process.h"

namespace bonemill {

// It is made anew and locked; what it holds goes with it.
//
// A process that is killed leaves its folder behind; the next one that unpacks takes it away.
class PassingFolder {
  public:
    PassingFolder();
    ~PassingFolder();
    PassingFolder(const PassingFolder&) = delete;
    PassingFolder& operator=(const PassingFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
    int lock_ = -1;  // lives as long as this process
};

// It is the one volume file in the archive; where there is none, the outermost folder that holds more than
// another folder.
class UnpackedScan {
  public:
    // As unpackArchive(); throws UserError, too, where there are several volume files.
    UnpackedScan(const std::filesystem::path& archive, const StartReader& start);

    const std::filesystem::path& path() const { return scan_; }
    // What was said of a file, as people know it: "scan.zip: slices/1.dcm".
    std::string named(std::string text) const;

  private:
    std::filesystem::path archive_;
    PassingFolder folder_;
    std::filesystem::path scan_;
};

}  // namespace bonemill
