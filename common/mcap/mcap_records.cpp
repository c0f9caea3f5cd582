#include "common/mcap/mcap_records.h"

#include <algorithm>

#include "common/mcap/mcap_reader.h"

namespace bonemill::mcap {

bool KnownRecords::find(std::string_view bytes, const Index& known, FoundRecords& found) const {
    Taker taker(bytes);
    while (!taker.rest().empty()) {
        const std::string_view start = taker.rest();
        const auto op = taker.number<uint8_t>();
        const std::string_view content = taker.bytes(taker.number<uint64_t>());
        if (!taker.isGood()) return false;
        const std::string_view record = start.substr(0, kRecordHead + content.size());
        const auto offset = uint64_t(start.data() - bytes.data());
        const bool is_good = op == kSchema    ? takeSchema(content, record, found)
                             : op == kChannel ? takeChannel(content, record, found)
                                              : op == kMessage && takeMessage(content, offset, found);
        if (!is_good || !hasRoomFor(found, known)) return false;
    }
    return true;
}

bool KnownRecords::hasRoomFor(const FoundRecords& found, const Index& known) {
    return known.recordBytes() + found.record_bytes <= kMaxRecordBytes &&
           known.records() + found.schemas.size() + found.channels.size() <= kMaxRecords;
}

void KnownRecords::keep(FoundRecords& found, Index& index) {
    for (const std::string_view record : found.schemas) index.addSchema(record);
    for (const std::string_view record : found.channels) index.addChannel(record);
    schemas_.insert(found.new_schemas.begin(), found.new_schemas.end());
    for (Channel& channel : found.new_channels) channels_[channel.id] = std::move(channel);
}

bool KnownRecords::takeSchema(std::string_view content, std::string_view record, FoundRecords& found) const {
    Taker taker(content);
    const auto id = taker.number<uint16_t>();
    if (!taker.isGood()) return false;
    if (repeats_ == Repeats::kAllowed &&
        (schemas_.contains(id) || std::ranges::count(found.new_schemas, id) > 0))
        return true;
    found.schemas.push_back(record);
    found.new_schemas.push_back(id);
    found.record_bytes += record.size();
    return true;
}

bool KnownRecords::takeChannel(std::string_view content, std::string_view record, FoundRecords& found) const {
    Taker taker(content);
    Channel channel;
    channel.id = taker.number<uint16_t>(), channel.schema = taker.number<uint16_t>();
    channel.topic = taker.text(), channel.encoding = taker.text();
    taker.text();  // metadata
    if (!taker.isDone()) return false;
    if (const Channel* const before = this->channel(channel.id, found))
        return repeats_ == Repeats::kAllowed && before->topic == channel.topic &&
               before->encoding == channel.encoding;
    found.channels.push_back(record);
    found.new_channels.push_back(std::move(channel));
    found.record_bytes += record.size();
    return true;
}

const Channel* KnownRecords::channel(uint16_t id, const FoundRecords& found) const {
    const auto known = channels_.find(id);
    if (known != channels_.end()) return &known->second;
    const auto fresh = std::ranges::find(found.new_channels, id, &Channel::id);
    return fresh == found.new_channels.end() ? nullptr : &*fresh;
}

bool KnownRecords::takeMessage(std::string_view content, uint64_t offset, FoundRecords& found) const {
    Taker taker(content);
    Message message;
    message.channel = taker.number<uint16_t>(), message.sequence = taker.number<uint32_t>();
    message.time_ns = taker.number<uint64_t>();
    taker.number<uint64_t>();  // when it was published
    message.data = taker.rest();
    if (!taker.isGood() || !channel(message.channel, found)) return false;
    const bool is_first = found.messages.empty();
    found.first_ns = is_first ? message.time_ns : std::min(found.first_ns, message.time_ns);
    found.last_ns = std::max(found.last_ns, message.time_ns);
    found.places[message.channel].push_back({message.time_ns, offset});
    found.messages.push_back(message);
    return true;
}

}  // namespace bonemill::mcap
