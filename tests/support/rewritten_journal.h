// A journal with some of its messages changed, as an attacker could who knows the format: its sums are right.
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "common/mcap/mcap_writer.h"
#include "haptic_server/recording/journal/journal_reader.h"
#include "haptic_server/recording/journal/journal_topics.h"

namespace bonemill::test {

struct JournalMessage {
    JournalTopic topic;
    uint64_t time_ns;
    std::string data;

    template <class Message>
    Message as() const {
        Message message;
        message.ParseFromString(data);
        return message;
    }
};

inline std::vector<JournalMessage> journalMessages(const std::filesystem::path& journal) {
    std::vector<JournalMessage> messages;
    readJournal(journal, [&](JournalTopic topic, const mcap::Message& message) {
        messages.push_back({topic, message.time_ns, std::string(message.data)});
    });
    return messages;
}

inline void writeJournal(const std::filesystem::path& path, const std::vector<JournalMessage>& messages,
                         bool is_finished) {
    mcap::Writer writer(kJournalProfile, "bonemill test");
    for (const JournalTopicName& topic : kJournalTopics) addTopic(topic, writer);
    for (const JournalMessage& message : messages)
        writer.addMessage(uint16_t(message.topic), message.time_ns, message.data);
    is_finished ? writer.finish() : writer.closeChunk();
    std::ofstream(path, std::ios::binary) << writer.take();
}

}  // namespace bonemill::test
