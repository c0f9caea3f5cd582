// An MCAP file of Protobuf messages as Foxglove reads it: with schemas, an index, and chunks small enough to
// be fetched one by one. It is whole or not there. For one normal thread.
#pragma once

#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "common/files/whole_file.h"
#include "common/mcap/mcap_writer.h"

namespace google::protobuf {
class Descriptor;
class MessageLite;
}  // namespace google::protobuf

namespace bonemill {

class FoxgloveFile {
  public:
    // Throws UserError, as all that writes does, where the file cannot be written.
    explicit FoxgloveFile(const std::string& path);

    // Another topic, whose messages are of this type. Returns its channel.
    uint16_t addTopic(const std::string& name, const google::protobuf::Descriptor& type);
    // Returns how many bytes it takes before it is packed.
    size_t put(uint16_t channel, uint64_t stamp_ns, const google::protobuf::MessageLite& message);
    // The file takes its place; nothing may come after.
    void finish();

    // In the order in which they were added.
    const std::vector<std::string>& topics() const { return topics_; }

  private:
    void write();

    WholeFile file_;
    std::ofstream out_;
    mcap::Writer writer_;
    std::map<std::string, uint16_t> schemas_;  // by type
    std::vector<std::string> topics_;
    std::string message_;
    size_t chunk_bytes_ = 0;
};

}  // namespace bonemill
