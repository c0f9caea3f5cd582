#include "haptic_server/recording/journal/journal_topics.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>

#include <set>
#include <string>

#include "common/base/assert.h"
#include "proto/journal.pb.h"

namespace bonemill {
namespace {

// Those that a file imports come before it.
void addFile(const google::protobuf::FileDescriptor& file, std::set<std::string>& known,
             google::protobuf::FileDescriptorSet& all) {
    if (!known.insert(file.name()).second) return;
    for (int n = 0; n < file.dependency_count(); ++n) addFile(*file.dependency(n), known, all);
    file.CopyTo(all.add_file());
}

}  // namespace

std::string descriptorsOf(const google::protobuf::Descriptor& type) {
    google::protobuf::FileDescriptorSet all;
    std::set<std::string> known;
    addFile(*type.file(), known, all);
    return all.SerializeAsString();
}

void addTopic(const JournalTopicName& topic, mcap::Writer& writer) {
    journal::Manifest::descriptor();  // so that the types are there, and those that they use
    const auto* const type =
        google::protobuf::DescriptorPool::generated_pool()->FindMessageTypeByName(std::string(topic.type));
    BONEMILL_ASSERT(type);
    const auto id = uint16_t(topic.topic);
    writer.addSchema({id, std::string(topic.type), "protobuf", descriptorsOf(*type)});
    writer.addChannel({id, id, std::string(topic.name), "protobuf"});
}

}  // namespace bonemill
