#include "common/mcap/mcap_repair.h"

#include <fstream>

#include "common/require_file.h"
#include "common/user_error.h"

namespace bonemill::mcap {

Reading repair(const std::filesystem::path& path) {
    requireFile(path);
    std::ifstream input(path, std::ios::binary);
    if (!input) throw UserError(path.string() + ": cannot be opened");
    Reading reading = read(input, [](const Channel&, const Message&) {});
    if (reading.is_whole) return reading;
    if (reading.index.size() == 0) throw UserError(path.string() + ": " + reading.problem);
    input.close();
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
