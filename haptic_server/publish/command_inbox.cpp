#include "haptic_server/publish/command_inbox.h"

#include <google/protobuf/stubs/logging.h>

#include <algorithm>

namespace bonemill {
namespace {

// These are far more than a classroom has, and they bound what invented sender ids can take.
constexpr size_t kMaxSenders = 1024;
// It is many times what any command needs.
constexpr size_t kLongestPayload = 4096;

bool parse(std::span<const uint8_t> payload, topics::Command& command) {
    const google::protobuf::LogSilencer silencer;  // malformed commands are counted, not logged one by one
    if (payload.size() > kLongestPayload) return false;
    return command.ParseFromArray(payload.data(), static_cast<int>(payload.size()));
}

}  // namespace

CommandInbox::Sender& CommandInbox::senderState(uint64_t id) {
    if (senders_.size() >= kMaxSenders && !senders_.contains(id)) {
        const auto heard_before = [](const auto& a, const auto& b) {
            return a.second.last_heard < b.second.last_heard;
        };
        senders_.erase(std::min_element(senders_.begin(), senders_.end(), heard_before));
    }
    Sender& sender = senders_[id];
    sender.last_heard = ++received_count_;
    return sender;
}

CommandInbox::Decision CommandInbox::receive(uint64_t envelope_sender, std::span<const uint8_t> payload) {
    topics::Command command;
    if (!parse(payload, command) || command.sender() != envelope_sender || command.sequence() == 0) {
        ++malformed_count_;
        return {};
    }
    Sender& sender = senderState(envelope_sender);
    if (command.sequence() < sender.sequence) return {};
    if (command.sequence() == sender.sequence) {
        if (!sender.result) return {};
        return {std::nullopt, CommandAcknowledgement{envelope_sender, sender.sequence, *sender.result}};
    }
    sender.sequence = command.sequence();
    sender.result.reset();
    if (command.action_case() == topics::Command::ACTION_NOT_SET) {
        return {std::nullopt, finish(command, "refused: this server does not know the action")};
    }
    return {std::move(command), std::nullopt};
}

CommandAcknowledgement CommandInbox::finish(const topics::Command& command, const std::string& result) {
    Sender& sender = senderState(command.sender());
    if (command.sequence() >= sender.sequence) {
        sender.sequence = command.sequence();
        sender.result = result;
    }
    return {command.sender(), command.sequence(), result};
}

}  // namespace bonemill
