// Reads what mcap::Writer makes, whoever had the file in between: every length is checked before it is
// believed, every chunk against its CRC before anything in it is told, and memory is bounded. Where a file is
// torn or changed, all that is whole before that place is read, and what was lost is said. Files that another
// program has written, or written anew, are read as the specification allows them (foreign_reader.h). It is
// for normal threads.
#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <string_view>

#include "common/mcap/mcap_index.h"

namespace bonemill::mcap {

// Schemas and channels are kept to the end of the file, whoever made it: no more of them are taken.
constexpr uint64_t kMaxRecordBytes = uint64_t(1) << 20, kMaxRecords = 1024;

// What our programs call themselves in a file begins so. Of such a file every byte is known beforehand but
// what is in its chunks, and is compared.
constexpr std::string_view kOurs = "bonemill ";

struct Reading {
    bool is_whole = false;    // from the first byte to the last, with its end
    std::string problem;      // for people; empty if whole
    uint64_t lost_bytes = 0;  // in the file, after the last that is whole
    // Nothing is lost but what the writer had begun to write when it was stopped.
    bool is_torn_chunk = false;
    std::string profile, library;
    // Another program has written it: what it does not promise by a CRC cannot be proven to be as it was.
    bool is_foreign = false;
    // Of what is whole: its size() is that of the file up to there.
    Index index;
    // These records belong at the end of that, and are not there whole.
    std::string missing;
};

// `visit` is called for each message, in the file's order; its data is good until it returns. What it throws
// goes through. Nothing else is thrown; a stream that cannot be read counts as torn there.
using Visit = std::function<void(const Channel&, const Message&)>;
Reading read(std::istream& input, const Visit& visit);

}  // namespace bonemill::mcap
