// `bonemill_lab session verify` runs the ticks of a journal again and holds them against what it says of
// them: hashes of every second, a check of every tick, the bone's states.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "proto/journal.pb.h"

namespace bonemill {

// What keeps this program from promising the same bits: it is another build. For people; empty: nothing.
std::vector<std::string> reasonsAgainstSameBits(const journal::Manifest& manifest,
                                                const std::string& version);

struct JournalVerdict {
    uint64_t ticks = 0, hashes = 0, bones = 0;  // that were held against each other
    double seconds = 0;                         // of the session
    bool is_same = true;
    uint64_t first_tick = 0;  // that differs
    std::string part;         // in which it differs, of TickHash::kNames or the bone; empty: not known
    // The largest deviation of the simulated tool, and of the force on the hand, at 25 ticks of each second.
    double position = 0;               // m
    double force = 0;                  // N
    std::vector<std::string> reasons;  // as above: then this is a comparison, no proof
    std::string not_whole;             // what the journal lacks, for people; empty: nothing
    bool is_chain_broken = false;
    std::string chain;  // of the journal's messages, for people
    bool lacks_noted_link = false;
    std::string noted_link;  // for people; empty: none was noted

    bool isProven() const noexcept {
        return ticks > 0 && is_same && reasons.empty() && !is_chain_broken && !lacks_noted_link;
    }
    std::string text() const;  // for people: some lines
};

// `version` is what this program's --version prints, `noted_link` a link of the chain that was kept apart, as
// 64 hexadecimal digits, or empty. Throws UserError if it is no journal, or its scene cannot be loaded, or
// reads a file that is another one now.
JournalVerdict verifyJournal(const std::filesystem::path& path, const std::string& version,
                             const std::string& noted_link = {});

}  // namespace bonemill
