// Chains a journal's messages (docs/reference/recording.md): each link is the SHA-256 of the link before and
// of all that was written since, so that who noted the last one sees whether anything was changed, added or
// left out. It is for one normal thread.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include "common/digest/digest.h"
#include "common/mcap/mcap_index.h"
#include "common/rt/clock.h"
#include "haptic_server/recording/journal/journal_topics.h"
#include "proto/journal.pb.h"

namespace bonemill {

class JournalChain {
  public:
    // The next message, which is no link.
    void add(JournalTopic topic, uint64_t time_ns, std::string_view data) {
        std::string head;
        mcap::append(head, uint16_t(topic)), mcap::append(head, time_ns),
            mcap::append(head, uint64_t(data.size()));
        hash_.add(head);
        hash_.add(data);
        is_empty_ = false;
    }
    bool isEmpty() const noexcept { return is_empty_; }  // since the link before
    // Closes a link, and returns its bytes.
    const std::string& close() {
        link_ = hash_.take();
        hash_.add(link_);
        is_empty_ = true;
        return link_;
    }
    // The newest link; empty before the first.
    const std::string& link() const noexcept { return link_; }

  private:
    Sha256 hash_;
    std::string link_;
    bool is_empty_ = true;
};

// Follows the chain through a journal.
class ChainCheck {
  public:
    // `noted` is a link that somebody has kept apart, as hexadecimal digits; empty: none.
    explicit ChainCheck(std::string noted = {}) : noted_(std::move(noted)) {}

    void take(JournalTopic topic, const mcap::Message& message) {
        if (first_ns_ == 0) first_ns_ = link_ns_ = message.time_ns;
        if (!problem_.empty()) return;
        if (topic == JournalTopic::kChain)
            takeLink(message);
        else
            chain_.add(topic, message.time_ns, message.data);
    }
    bool isBroken() const noexcept { return !problem_.empty(); }
    // The link that was noted is not in the chain as far as that is unbroken.
    bool lacksNoted() const noexcept { return !noted_.empty() && noted_ns_ == 0; }
    // For people: where it is broken first, or the last link, which proves something to who noted it before.
    std::string text() const {
        if (!problem_.empty()) return problem_;
        if (links_ == 0) return "there is none";
        return "unbroken, " + std::to_string(links_) + " links, the last is " + hexOf(chain_.link()) +
               (chain_.isEmpty() ? "" : "; what comes after it is not proven");
    }
    // For people; empty if none was noted.
    std::string textOfNoted() const {
        if (noted_.empty()) return {};
        if (lacksNoted())
            return "the link that was noted is not in it: this is another recording, or it was changed";
        char text[128];
        std::snprintf(text, sizeof text,
                      "the link that was noted is that of %.1f s: until then the recording is as it was when "
                      "that was noted",
                      secondsOfNs(int64_t(noted_ns_ - first_ns_)));
        return text;
    }

  private:
    void takeLink(const mcap::Message& message) {
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
        if (!noted_.empty() && hexOf(chain_.link()) == noted_) noted_ns_ = link_ns_;
    }

    std::string noted_;
    uint64_t noted_ns_ = 0;  // 0: it was not met
    JournalChain chain_;
    uint64_t links_ = 0;
    uint64_t first_ns_ = 0, link_ns_ = 0;  // of the first message, of the last good link
    std::string problem_;
};

}  // namespace bonemill
