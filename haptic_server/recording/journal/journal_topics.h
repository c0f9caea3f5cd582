// The topics of a journal, one for each type of message (proto/journal.proto, proto/foxglove.proto).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/mcap/mcap_writer.h"

namespace google::protobuf {
class Descriptor;
}

namespace bonemill {

// Also the ids of channel and schema in the file, which start at 1.
enum class JournalTopic : uint16_t {
    kManifest = 1,
    kInputs,
    kStateHash,
    kBone,
    kOrder,
    kPutBack,
    kEvent,
    kCamera,
    kResults,
    kTool,    // where the simulated tool is; for viewers of recordings, some 25 times per second
    kHand,    // where the hand is, likewise
    kWrench,  // on the hand, likewise
    kChain,   // per second and at the end: what was written until then
    kTuned,   // numbers of tunings, and what they stand for
};

struct JournalTopicName {
    JournalTopic topic;
    std::string_view name;
    std::string_view type;  // of its messages, with the package
};

inline constexpr std::array kJournalTopics = {
    JournalTopicName{JournalTopic::kManifest, "/manifest", "bonemill.journal.Manifest"},
    JournalTopicName{JournalTopic::kInputs, "/inputs", "bonemill.journal.Inputs"},
    JournalTopicName{JournalTopic::kStateHash, "/state_hash", "bonemill.journal.StateHash"},
    JournalTopicName{JournalTopic::kBone, "/bone", "bonemill.journal.Bone"},
    JournalTopicName{JournalTopic::kOrder, "/orders", "bonemill.journal.Order"},
    JournalTopicName{JournalTopic::kPutBack, "/put_back", "bonemill.journal.PutBack"},
    JournalTopicName{JournalTopic::kEvent, "/events", "bonemill.journal.Event"},
    JournalTopicName{JournalTopic::kCamera, "/cameras", "bonemill.journal.Camera"},
    JournalTopicName{JournalTopic::kResults, "/results", "bonemill.journal.Results"},
    JournalTopicName{JournalTopic::kTool, "/tool", "foxglove.PoseInFrame"},
    JournalTopicName{JournalTopic::kHand, "/hand", "foxglove.PoseInFrame"},
    JournalTopicName{JournalTopic::kWrench, "/wrench", "bonemill.journal.WrenchInFrame"},
    JournalTopicName{JournalTopic::kChain, "/chain", "bonemill.journal.Link"},
    JournalTopicName{JournalTopic::kTuned, "/tuned", "bonemill.journal.Tuned"},
};

// Of journal::Manifest.format.
inline constexpr uint32_t kJournalFormat = 1;
// The profile in the MCAP file's header: what tells a journal from other MCAP files.
inline constexpr std::string_view kJournalProfile = "bonemill.journal";

// What a file says of messages of this type, so that stock tools read them: a FileDescriptorSet with all that
// it uses. For normal threads, as what follows.
std::string descriptorsOf(const google::protobuf::Descriptor& type);

// Schema and channel of the topic, whose number both have.
void addTopic(const JournalTopicName& topic, mcap::Writer& writer);

}  // namespace bonemill
