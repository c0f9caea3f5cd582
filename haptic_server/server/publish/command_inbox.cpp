#include "haptic_server/server/publish/command_inbox.h"

#include <google/protobuf/stubs/logging.h>

#include <algorithm>

#include "common/base/make_room.h"
#include "common/dds/topic_traits.h"

namespace bonemill {
namespace {

// Far more than a classroom has. Only people of the session fill it, and beyond it only new sender ids are
// refused.
constexpr size_t kMaxProvenSenders = 4096;

// These are far more than a classroom has, and they bound what invented sender ids can take.
constexpr RoomLimits kSenders{1024, 128};

bool parse(std::span<const uint8_t> payload, topics::Command& command) {
    const google::protobuf::LogSilencer silencer;  // malformed commands are counted, not logged one by one
    if (payload.size() > dds::kLongestCommand) return false;
    return command.ParseFromArray(payload.data(), static_cast<int>(payload.size()));
}

}  // namespace

bool ProvenSenders::mayUse(uint64_t sender, const GuidPrefix& participant) {
    const auto found = senders_.find(sender);
    if (found != senders_.end()) return found->second.participant == participant;
    if (senders_.size() >= kMaxProvenSenders) return false;
    senders_.emplace(sender, Sender{participant, "unknown"});
    return true;
}

void ProvenSenders::identify(topics::Command& command, const GuidPrefix& participant) {
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

std::string ProvenSenders::proofOf(const topics::Command& command) const {
    const auto found = senders_.find(command.sender());
    return found == senders_.end() ? "" : found->second.proof;
}

topics::Viewer::Role roleOfIdentity(const std::string& role) {
    if (role == "operator") return topics::Viewer::OPERATOR;
    if (role == "instructor") return topics::Viewer::INSTRUCTOR;
    if (role == "examiner") return topics::Viewer::EXAMINER;
    return topics::Viewer::VIEWER;
}

// Who comes again with another participant, its first one gone, goes on counting; a lower number is of
// a new sender.
CommandInbox::Sender* CommandInbox::senderOf(const topics::Command& command, const CommandOrigin& origin) {
    const auto known = senders_.find(command.sender());
    if (known == senders_.end()) {
        makeRoomFor(
            origin.participant, senders_, kSenders, [](const auto& s) { return s.second.origin.participant; },
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

CommandInbox::Decision CommandInbox::receive(uint64_t envelope_sender, const CommandOrigin& origin,
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

// The rightful one must not take the answer for its own: it waits for a newer number than those that are
// done.
CommandInbox::Decision CommandInbox::refuseForeign(const topics::Command& command) const {
    Decision decision;
    decision.is_foreign = true;
    if (command.sequence() < senders_.at(command.sender()).sequence)
        decision.acknowledgement = {
            command.sender(), command.sequence(),
            Answer::refused("another client of this session has this sender number; start anew")};
    return decision;
}

CommandAcknowledgement CommandInbox::finish(const topics::Command& command, const Answer& answer) {
    const auto known = senders_.find(command.sender());
    if (known != senders_.end() && command.sequence() >= known->second.sequence) {
        known->second.sequence = command.sequence();
        known->second.answer = answer;
    }
    return {command.sender(), command.sequence(), answer};
}

}  // namespace bonemill
