// Chains a journal's messages (docs/lab/recording.md): each link is the SHA-256 of the link before and of all
// that was written since, so that who noted the last one sees whether anything was changed, added or left
// out. It is for one normal thread.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/digest/digest.h"
#include "common/mcap/mcap_index.h"
#include "haptic_server/recording/journal/journal_topics.h"

namespace bonemill {

class JournalChain {
  public:
    // The next message, which is no link.
    void add(JournalTopic topic, uint64_t time_ns, std::string_view data);
    bool isEmpty() const noexcept { return is_empty_; }  // since the link before
    // Closes a link, and returns its bytes.
    const std::string& close();
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
    void take(JournalTopic topic, const mcap::Message& message);
    bool isBroken() const noexcept { return !problem_.empty(); }
    // For people: where it is broken first, or the last link, which proves something to who noted it before.
    std::string text() const;

  private:
    void takeLink(const mcap::Message& message);

    JournalChain chain_;
    uint64_t links_ = 0;
    uint64_t first_ns_ = 0, link_ns_ = 0;  // of the first message, of the last good link
    std::string problem_;
};

}  // namespace bonemill
