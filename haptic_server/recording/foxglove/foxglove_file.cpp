#include "haptic_server/recording/foxglove/foxglove_file.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message_lite.h>

#include "common/base/user_error.h"
#include "haptic_server/recording/journal/journal_topics.h"

namespace bonemill {
namespace {

// Of a chunk before it is packed: what a reader fetches to show one moment.
constexpr size_t kChunkBytes = size_t(1) << 20;

}  // namespace

FoxgloveFile::FoxgloveFile(const std::string& path)
    : file_(path), out_(file_.part(), std::ios::binary), writer_("", std::string(mcap::kOurs) + "export") {}

uint16_t FoxgloveFile::addTopic(const std::string& name, const google::protobuf::Descriptor& type) {
    const auto [schema, is_new] = schemas_.try_emplace(type.full_name(), uint16_t(schemas_.size() + 1));
    if (is_new) writer_.addSchema({schema->second, type.full_name(), "protobuf", descriptorsOf(type)});
    topics_.push_back(name);
    const auto channel = uint16_t(topics_.size());
    writer_.addChannel({channel, schema->second, name, "protobuf"});
    return channel;
}

size_t FoxgloveFile::put(uint16_t channel, uint64_t stamp_ns, const google::protobuf::MessageLite& message) {
    message.SerializeToString(&message_);
    writer_.addMessage(channel, stamp_ns, message_);
    chunk_bytes_ += message_.size();
    if (chunk_bytes_ >= kChunkBytes) {
        writer_.closeChunk();
        chunk_bytes_ = 0;
        write();
    }
    return message_.size();
}

void FoxgloveFile::write() {
    const std::string bytes = writer_.take();
    if (!out_.write(bytes.data(), std::streamsize(bytes.size())))
        throw UserError(file_.path().string() + ": cannot be written to its end (disk full?)");
}

void FoxgloveFile::finish() {
    writer_.finish();
    write();
    out_.close();
    if (!out_) throw UserError(file_.path().string() + ": cannot be written to its end (disk full?)");
    file_.finish();
}

}  // namespace bonemill
