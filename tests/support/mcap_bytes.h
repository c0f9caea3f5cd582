// Makes MCAP files for tests, and reads them from memory.
#pragma once

#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "common/mcap/mcap_reader.h"
#include "common/mcap/mcap_writer.h"

namespace bonemill::test {

struct McapFile {
    std::string bytes;
    std::vector<std::string> messages;  // "topic sequence time data", in their order
    // By chunk: where it ends in the file, and how many messages there are up to there.
    std::vector<std::pair<size_t, size_t>> chunks;
};

// Two topics in turns, in `chunks` chunks; without an end if it is not finished.
inline McapFile mcapFile(int chunks, bool is_finished, uint32_t seed = 2026) {
    std::mt19937 random(seed);
    McapFile file;
    mcap::Writer writer("bonemill", "bonemill test");
    writer.addSchema({1, "bonemill.Thing", "protobuf", "not looked at"});
    writer.addChannel({7, 1, "things", "protobuf"});
    writer.addChannel({8, 1, "others", "protobuf"});
    uint32_t sequences[2] = {};
    for (int n = 0; n < chunks; ++n) {
        for (int m = 0; m < 5; ++m) {
            const int other = m % 2;
            const uint64_t time_ns = 1'000'000'000ull + uint64_t(10 * n + m);
            std::string data(random() % 60, '\0');
            for (char& byte : data) byte = char(random() % 7);
            writer.addMessage(uint16_t(7 + other), time_ns, data);
            file.messages.push_back((other ? "others " : "things ") + std::to_string(sequences[other]++) +
                                    ' ' + std::to_string(time_ns) + ' ' + data);
        }
        writer.closeChunk();
        file.bytes += writer.take();
        constexpr size_t kIndexes = 2 * (9 + 2 + 4) + 5 * 16;  // two records of five places in all follow it
        file.chunks.emplace_back(file.bytes.size() - kIndexes, file.messages.size());
    }
    if (is_finished) writer.finish();
    file.bytes += writer.take();
    return file;
}

struct McapContent {
    mcap::Reading reading;
    std::vector<std::string> messages;  // as in McapFile
};

inline McapContent readMcap(const std::string& bytes) {
    McapContent content;
    std::istringstream stream(bytes);
    content.reading = mcap::read(stream, [&](const mcap::Channel& channel, const mcap::Message& message) {
        content.messages.push_back(channel.topic + ' ' + std::to_string(message.sequence) + ' ' +
                                   std::to_string(message.time_ns) + ' ' + std::string(message.data));
    });
    return content;
}

}  // namespace bonemill::test
