// What the file says of its topics, so that stock tools read it: Protobuf types with all that they use. It is
// for normal threads.
#pragma once

#include "common/mcap/mcap_writer.h"
#include "haptic_server/recording/journal/journal_topics.h"

namespace bonemill {

// Schema and channel of the topic, whose number both have.
void addTopic(const JournalTopicName& topic, mcap::Writer& writer);

}  // namespace bonemill
