// Whose commands the server carries out, and which: each (sender, sequence) once. It is for one thread and
// not RT-safe.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>

#include "common/commands/answer.h"
#include "common/security/people.h"
#include "proto/topics.pb.h"

namespace bonemill {

// Who really sends a command, where DDS Security proves it: what a command says of its sender counts only
// from a gateway, which speaks for its guests.
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

// Clients read this in Status about the last command.
struct CommandAcknowledgement {
    uint64_t sender = 0;
    uint32_t sequence = 0;
    Answer answer;
};

// Who has really written a command (dds::Reader): 0 for the participant of a writer that has gone already.
struct CommandOrigin {
    uint64_t participant = 0;
    uint64_t writer = 0;

    bool isSameAs(const CommandOrigin& other) const noexcept {
        return writer == other.writer || (participant != 0 && participant == other.participant);
    }
};

// A sender belongs to the participant that used it first, for as long as that lives.
class CommandInbox {
  public:
    // Says what to do with one received payload: carry out `command`, or tell the sender `acknowledgement`,
    // or nothing (both are empty: it is malformed, or it repeats a command that is still being carried out).
    struct Decision {
        std::optional<topics::Command> command;
        std::optional<CommandAcknowledgement> acknowledgement;
        bool is_foreign =
            false;  // the sender is another participant's; it is answered where no other client waits
    };

    // `is_there` says whether a writer that was an origin still lives.
    explicit CommandInbox(std::function<bool(uint64_t writer)> is_there) : is_there_(std::move(is_there)) {}

    // `envelope_sender` is the key of the sample. Bytes that are no command of that sender, or more than
    // 4 KiB, are counted and dropped.
    Decision receive(uint64_t envelope_sender, const CommandOrigin& origin, std::span<const uint8_t> payload);

    // Remembers how a command ended, for senders that repeat it because they missed the acknowledgement.
    CommandAcknowledgement finish(const topics::Command& command, const Answer& answer);

    uint64_t malformedCount() const noexcept { return malformed_count_; }

  private:
    struct Sender {
        CommandOrigin origin;
        uint32_t sequence = 0;         // the last one received
        std::optional<Answer> answer;  // of that one; nothing: it is still being carried out
        uint64_t last_heard = 0;       // receive counter, to forget the quietest
    };
    // Null if another participant has it.
    Sender* senderOf(const topics::Command& command, const CommandOrigin& origin);
    Decision refuseForeign(const topics::Command& command) const;

    std::function<bool(uint64_t)> is_there_;
    std::unordered_map<uint64_t, Sender> senders_;
    uint64_t received_count_ = 0;
    uint64_t malformed_count_ = 0;
};

}  // namespace bonemill
