#include "haptic_server/recording/journal/journal_chain.h"

#include <cstdio>

#include "common/mcap/mcap_index.h"
#include "common/rt/clock.h"
#include "proto/journal.pb.h"

namespace bonemill {

void JournalChain::add(JournalTopic topic, uint64_t time_ns, std::string_view data) {
    std::string head;
    mcap::append(head, uint16_t(topic)), mcap::append(head, time_ns),
        mcap::append(head, uint64_t(data.size()));
    hash_.add(head);
    hash_.add(data);
    is_empty_ = false;
}

const std::string& JournalChain::close() {
    link_ = hash_.take();
    hash_.add(link_);
    is_empty_ = true;
    return link_;
}

void ChainCheck::take(JournalTopic topic, const mcap::Message& message) {
    if (first_ns_ == 0) first_ns_ = link_ns_ = message.time_ns;
    if (!problem_.empty()) return;
    if (topic == JournalTopic::kChain)
        takeLink(message);
    else
        chain_.add(topic, message.time_ns, message.data);
}

void ChainCheck::takeLink(const mcap::Message& message) {
    journal::Link link;
    const bool is_link = link.ParseFromArray(message.data.data(), int(message.data.size()));
    const auto seconds = [this](uint64_t time_ns) { return secondsOfNs(int64_t(time_ns - first_ns_)); };
    if (!is_link || link.sha256() != chain_.close()) {
        char text[96];
        std::snprintf(text, sizeof text, "broken between %.1f s and %.1f s of the recording",
                      seconds(link_ns_), seconds(message.time_ns));
        problem_ = text;
        return;
    }
    ++links_;
    link_ns_ = message.time_ns;
}

std::string ChainCheck::text() const {
    if (!problem_.empty()) return problem_;
    if (links_ == 0) return "there is none";
    return "unbroken, " + std::to_string(links_) + " links, the last is " + hexOf(chain_.link()) +
           (chain_.isEmpty() ? "" : "; what comes after it is not proven");
}

}  // namespace bonemill
