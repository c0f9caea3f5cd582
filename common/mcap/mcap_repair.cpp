#include "common/mcap/mcap_repair.h"

#include <fstream>

#include "common/base/user_error.h"
#include "common/files/require_file.h"
#include "common/files/whole_file.h"
#include "common/text/foreign_text.h"

namespace bonemill::mcap {
namespace {

namespace fs = std::filesystem;

// One that is there is what a repair that was stopped has kept.
fs::path keepBeside(const fs::path& path) {
    fs::path kept = path;
    kept.replace_extension(kDamagedEnding);
    std::error_code error;
    if (fs::exists(fs::symlink_status(kept, error))) return kept;
    WholeFile copy(kept, 0600);
    fs::copy_file(path, copy.part(), fs::copy_options::overwrite_existing, error);
    if (error) throw UserError(kept.string() + ": cannot be written: " + error.message());
    copy.finish();
    return kept;
}

}  // namespace

Repair repair(const std::filesystem::path& path) {
    requireFile(path);
    std::ifstream input(path, std::ios::binary);
    if (!input) throw UserError(path.string() + ": cannot be opened");
    Repair reading{read(input, [](const Channel&, const Message&) {}), {}};
    if (reading.is_whole) return reading;
    if (reading.index.size() == 0) throw UserError(path.string() + ": " + reading.problem);
    if (reading.is_foreign)
        throw UserError(path.string() + ": another program has written it (" +
                        printableLine(reading.library) + "), which must mend it: " + reading.problem);
    input.close();
    if (!reading.is_torn_chunk) reading.kept = keepBeside(path);
    Index index = reading.index;
    index.addBytes(reading.missing);
    std::error_code error;
    std::filesystem::resize_file(path, reading.index.size(), error);
    if (error) throw UserError(path.string() + ": cannot be shortened: " + error.message());
    std::ofstream output(path, std::ios::binary | std::ios::app);
    output << reading.missing << index.ending() << std::flush;
    if (!output) throw UserError(path.string() + ": cannot be written; is the disk full?");
    return reading;
}

}  // namespace bonemill::mcap
