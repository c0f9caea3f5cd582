// Counts how many bytes of voxels a file really holds: some libraries take a short file for a whole one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace bonemill {

struct StoredData {
    enum class Packing {
        kPlain,
        kDeflate,
        kOther
    };  // deflate: with a zlib or gzip head; other: cannot be counted

    std::filesystem::path file;
    uint64_t begin = 0;  // first byte of the data (of the packed data) in the file
    Packing packing = Packing::kPlain;
    uint64_t packed_bytes = 0;  // as many belong to them; 0: all to the end of the file
};

// These are the bytes of voxels that can be read, counted up to `needed`. Throws UserError when the packed
// data are damaged.
uint64_t countStoredBytes(const StoredData& data, uint64_t needed);

// Headers name several files by a list or a pattern where the name of one would stand: these are not counted.
bool namesSeveralFiles(const std::string& data_file);

}  // namespace bonemill
