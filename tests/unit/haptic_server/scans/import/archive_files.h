// Writes archives, those that do harm too.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace bonemill {

struct PackedFile {
    std::string name, bytes;
    std::string link_to = {};  // a symbolic link; empty: a file
    bool is_hard_link = false;
};

// What the name's ending says: .zip, .tar, .tar.gz, .tgz or .tar.xz. A zip with a password is encrypted.
void writeArchive(const std::filesystem::path& path, const std::vector<PackedFile>& files,
                  const std::string& password = {});

}  // namespace bonemill
