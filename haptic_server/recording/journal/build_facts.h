// What a replay must have in common with the session for the same bits: the program, the machine's library,
// and every file. It is for normal threads, at the start.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/files/require_apart.h"
#include "proto/journal.pb.h"

namespace bonemill {

// Of this process; `version` is what its --version prints.
journal::Build buildFacts(const std::string& version);

// The SHA-256 of a file, or of a folder's files in the order of their names; as 64 hexadecimal digits. Throws
// UserError.
std::string sha256Of(const std::filesystem::path& path);
std::vector<journal::File> hashedFiles(const std::vector<NamedFile>& files);

// Another 128 random bits, as hexadecimal digits. Throws UserError.
std::string newJournalId();

}  // namespace bonemill
