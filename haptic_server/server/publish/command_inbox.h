// Whose commands the server carries out, and which: each (sender, sequence) once. It is for one thread and
// not RT-safe.
#pragma once

#include <google/protobuf/stubs/logging.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>

#include "common/base/make_room.h"
#include "common/commands/answer.h"
#include "common/security/people.h"
#include "proto/topics.pb.h"

namespace bonemill {

// Returns the role that stands in a certificate; VIEWER if it is none that commands.
inline topics::Viewer::Role roleOfIdentity(const std::string& role) {
    if (role == "operator") return topics::Viewer::OPERATOR;
    if (role == "instructor") return topics::Viewer::INSTRUCTOR;
    if (role == "examiner") return topics::Viewer::EXAMINER;
    return topics::Viewer::VIEWER;
}

// Who really sends a command, where DDS Security proves it: what a command says of its sender counts only
// from a gateway, which speaks for its guests.
class ProvenSenders {
  public:
    // `find` returns whose participant it is; nothing if the session does not know it.
    explicit ProvenSenders(std::function<std::optional<Identity>(const GuidPrefix&)> find)
        : find_(std::move(find)) {}

    // Returns false if this sender id is another participant's: who comes first has it. The participant is
    // that of the sample's writer.
    bool mayUse(uint64_t sender, const GuidPrefix& participant) {
        const auto found = senders_.find(sender);
        if (found != senders_.end()) return found->second.participant == participant;
        if (senders_.size() >= kMaxProvenSenders) return false;
        senders_.emplace(sender, Sender{participant, "unknown"});
        return true;
    }
    // Writes the participant's role and name into the command; an unknown one may only look.
    void identify(topics::Command& command, const GuidPrefix& participant) {
        const std::optional<Identity> identity = find_(participant);
        std::string& proof = senders_[command.sender()].proof;
        if (identity && identity->role == "gateway") {
            proof = "says gateway " + identity->name;
            return;
        }
        command.set_role(identity ? roleOfIdentity(identity->role) : topics::Viewer::VIEWER);
        command.set_name(identity ? identity->name : "");
        proof = identity ? "proven" : "not in people.pem";
    }
    // Returns how it was proven who sent the command: "proven", or "says gateway NAME".
    std::string proofOf(const topics::Command& command) const {
        const auto found = senders_.find(command.sender());
        return found == senders_.end() ? "" : found->second.proof;
    }

  private:
    // Far more than a classroom has. Only people of the session fill it, and beyond it only new sender ids
    // are refused.
    static constexpr size_t kMaxProvenSenders = 4096;

    std::function<std::optional<Identity>(const GuidPrefix&)> find_;
    struct Sender {
        GuidPrefix participant;
        std::string proof;
    };
    std::unordered_map<uint64_t, Sender> senders_;
};

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
    Decision receive(uint64_t envelope_sender, const CommandOrigin& origin,
                     std::span<const uint8_t> payload) {
        topics::Command command;
        if (!parse(payload, command) || command.sender() != envelope_sender || command.sequence() == 0) {
            ++malformed_count_;
            return {};
        }
        Sender* const its = senderOf(command, origin);
        if (!its) return refuseForeign(command);
        Sender& sender = *its;
        sender.last_heard = ++received_count_;
        if (command.sequence() < sender.sequence) return {};
        if (command.sequence() == sender.sequence) {
            if (!sender.answer) return {};
            return {std::nullopt, CommandAcknowledgement{envelope_sender, sender.sequence, *sender.answer}};
        }
        sender.sequence = command.sequence();
        sender.answer.reset();
        if (command.action_case() == topics::Command::ACTION_NOT_SET) {
            return {std::nullopt, finish(command, Answer::refused("this server does not know the action"))};
        }
        return {std::move(command), std::nullopt};
    }

    // Remembers how a command ended, for senders that repeat it because they missed the acknowledgement.
    CommandAcknowledgement finish(const topics::Command& command, const Answer& answer) {
        const auto known = senders_.find(command.sender());
        if (known != senders_.end() && command.sequence() >= known->second.sequence) {
            known->second.sequence = command.sequence();
            known->second.answer = answer;
        }
        return {command.sender(), command.sequence(), answer};
    }

    uint64_t malformedCount() const noexcept { return malformed_count_; }

  private:
    // These are far more than a classroom has, and they bound what invented sender ids can take.
    static constexpr RoomLimits kSenders{1024, 128};
    // It is many times what any command needs.
    static constexpr size_t kLongestPayload = 4096;

    static bool parse(std::span<const uint8_t> payload, topics::Command& command) {
        const google::protobuf::LogSilencer
            silencer;  // malformed commands are counted, not logged one by one
        if (payload.size() > kLongestPayload) return false;
        return command.ParseFromArray(payload.data(), static_cast<int>(payload.size()));
    }

    struct Sender {
        CommandOrigin origin;
        uint32_t sequence = 0;         // the last one received
        std::optional<Answer> answer;  // of that one; nothing: it is still being carried out
        uint64_t last_heard = 0;       // receive counter, to forget the quietest
    };
    // Null if another participant has it.
    // Who comes again with another participant, its first one gone, goes on counting; a lower number is of
    // a new sender.
    Sender* senderOf(const topics::Command& command, const CommandOrigin& origin) {
        const auto known = senders_.find(command.sender());
        if (known == senders_.end()) {
            makeRoomFor(
                origin.participant, senders_, kSenders,
                [](const auto& s) { return s.second.origin.participant; },
                [](const auto& s) { return s.second.last_heard; });
            Sender& sender = senders_[command.sender()];
            sender.origin = origin;
            return &sender;
        }
        Sender& sender = known->second;
        if (!sender.origin.isSameAs(origin)) {
            if (is_there_(sender.origin.writer)) return nullptr;
            if (command.sequence() < sender.sequence) sender = {};
        }
        sender.origin = origin;
        return &sender;
    }
    // The rightful one must not take the answer for its own: it waits for a newer number than those that are
    // done.
    Decision refuseForeign(const topics::Command& command) const {
        Decision decision;
        decision.is_foreign = true;
        if (command.sequence() < senders_.at(command.sender()).sequence)
            decision.acknowledgement = {
                command.sender(), command.sequence(),
                Answer::refused("another client of this session has this sender number; start anew")};
        return decision;
    }

    std::function<bool(uint64_t)> is_there_;
    std::unordered_map<uint64_t, Sender> senders_;
    uint64_t received_count_ = 0;
    uint64_t malformed_count_ = 0;
};

}  // namespace bonemill
