// Who really sends a command, where DDS Security proves it: what a command says of its sender counts only
// from a gateway, which speaks for its guests. It is for one thread and not RT-safe.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <unordered_map>

#include "common/security/people.h"
#include "proto/topics.pb.h"

namespace bonemill {

class ProvenSenders {
  public:
    // `find` returns whose participant it is; nothing if the session does not know it.
    explicit ProvenSenders(std::function<std::optional<Identity>(const GuidPrefix&)> find)
        : find_(std::move(find)) {}

    // Returns false if this sender id is another participant's: who comes first has it. The participant is
    // that of the sample's writer.
    bool mayUse(uint64_t sender, const GuidPrefix& participant);
    // Writes the participant's role and name into the command; an unknown one may only look.
    void identify(topics::Command& command, const GuidPrefix& participant);
    // Returns how it was proven who sent the command: "proven", or "says gateway NAME".
    std::string proofOf(const topics::Command& command) const;

  private:
    std::function<std::optional<Identity>(const GuidPrefix&)> find_;
    struct Sender {
        GuidPrefix participant;
        std::string proof;
    };
    std::unordered_map<uint64_t, Sender> senders_;
};

// Returns the role that stands in a certificate; VIEWER if it is none that commands.
topics::Viewer::Role roleOfIdentity(const std::string& role);

}  // namespace bonemill
