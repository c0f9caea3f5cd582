// Reads journals, whoever had them in between: nothing is believed unchecked, and memory is bounded by the
// file's size. What is whole before a torn end is read. It is for normal threads.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/mcap/mcap_reader.h"
#include "haptic_server/recording/journal/input_columns.h"
#include "haptic_server/recording/journal/journal_topics.h"
#include "proto/journal.pb.h"

namespace bonemill {

// All of a journal but bones, cameras and results: with its inputs some 70 bytes per tick.
struct JournalContent {
    journal::Manifest manifest;
    std::vector<journal::Inputs> inputs;  // as they were written
    std::vector<journal::StateHash> hashes;
    std::vector<journal::Order> orders;
    std::map<uint64_t, uint32_t> put_backs;     // PutBack.bone_order -> checkpoint
    std::map<uint32_t, scene::Tuning> tunings;  // by Tuned.number
    std::vector<journal::Event> events;
    uint64_t ticks = 0;                     // whose input is there, from tick 0 on without a gap
    std::string problem;                    // why the file is not whole, for people; empty if it is
    uint64_t lost_bytes = 0;                // behind what is whole
    std::string incomplete;                 // why the session could not record all; empty if it could
    uint64_t incomplete_from = UINT64_MAX;  // tick
    bool has_ended = false;                 // in order
};

// One message, as it stands in the file; parse() with its type. Its data is good until the visit returns.
using JournalVisit = std::function<void(JournalTopic topic, const mcap::Message& message)>;

// The message as its type; false if it is none of it.
template <class Message>
bool parse(const mcap::Message& bytes, Message& out) {
    return bytes.data.size() <= INT32_MAX && out.ParseFromArray(bytes.data.data(), int(bytes.data.size()));
}

// Both throw UserError if it is no journal, or one of a newer format. The first hands all messages to the
// visit, in the file's order; the second does, too, after it has taken what it keeps. Without inputs it keeps
// little.
mcap::Reading readJournal(const std::filesystem::path& path, const JournalVisit& visit);
enum class KeepInputs { kNo, kYes };
JournalContent readJournalContent(const std::filesystem::path& path, KeepInputs keep,
                                  const JournalVisit& visit_also = {});

}  // namespace bonemill
