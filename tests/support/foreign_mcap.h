// MCAP files as other programs write them: everything that the specification leaves open
// (https://mcap.dev/spec).
#pragma once

#include <zstd.h>

#include <string>
#include <vector>

#include "common/mcap/mcap_index.h"

namespace bonemill::test {

struct ForeignShape {
    std::string name = {};
    size_t per_chunk = 0;              // messages; 0: there are no chunks
    std::string packing = {};          // "", "zstd", or one that nobody knows
    bool has_crcs = false;             // of chunks, data and summary
    bool says_channels_again = false;  // in each chunk
    bool has_summary = false;
    bool has_attachments = false;  // and metadata, and a record that nobody knows
    std::string profile = {}, library = "another program 1";
};

struct ForeignMessage {
    uint16_t channel;
    uint64_t time_ns;
    std::string data;
};

class ForeignMcap {
  public:
    explicit ForeignMcap(const ForeignShape& shape) : shape_(shape) {
        std::string header;
        bytes_ = mcap::kMagic;
        mcap::appendText(header, shape.profile), mcap::appendText(header, shape.library);
        mcap::appendRecord(bytes_, mcap::kHeader, header);
    }

    std::string file(const std::vector<mcap::Channel>& channels,
                     const std::vector<ForeignMessage>& messages) {
        std::string declared;
        for (const mcap::Channel& channel : channels) addChannel(channel, declared);
        if (shape_.per_chunk == 0) bytes_ += declared;
        std::string chunk = declared;
        for (size_t n = 0; n < messages.size(); ++n) {
            if (shape_.per_chunk == 0) {
                addMessage(messages[n], uint32_t(n), bytes_);
            } else {
                addMessage(messages[n], uint32_t(n), chunk);
                if ((n + 1) % shape_.per_chunk == 0 || n + 1 == messages.size()) {
                    addChunk(chunk);
                    chunk = shape_.says_channels_again ? declared : "";
                }
            }
            if (shape_.has_attachments) addOthers();
        }
        addEnd(declared);
        return bytes_;
    }

  private:
    static void addChannel(const mcap::Channel& channel, std::string& out) {
        std::string schema, content;
        mcap::append(schema, channel.id);  // a schema for each
        mcap::appendText(schema, "a.Type"), mcap::appendText(schema, "protobuf"),
            mcap::appendText(schema, "");
        mcap::appendRecord(out, mcap::kSchema, schema);
        mcap::append(content, channel.id), mcap::append(content, channel.id);
        mcap::appendText(content, channel.topic), mcap::appendText(content, channel.encoding);
        mcap::append(content, uint32_t(0));
        mcap::appendRecord(out, mcap::kChannel, content);
    }
    static void addMessage(const ForeignMessage& message, uint32_t sequence, std::string& out) {
        std::string content;
        mcap::append(content, message.channel), mcap::append(content, sequence);
        mcap::append(content, message.time_ns), mcap::append(content, message.time_ns);
        mcap::appendRecord(out, mcap::kMessage, content + message.data);
    }
    // The size of what is packed is not in it, as it is when it was not known beforehand.
    static std::string packed(const std::string& plain) {
        std::string out(ZSTD_compressBound(plain.size()) + 64, '\0');
        ZSTD_CCtx* const context = ZSTD_createCCtx();
        ZSTD_CCtx_setParameter(context, ZSTD_c_contentSizeFlag, 0);
        out.resize(ZSTD_compress2(context, out.data(), out.size(), plain.data(), plain.size()));
        ZSTD_freeCCtx(context);
        return out;
    }
    void addChunk(const std::string& plain) {
        const std::string content = shape_.packing == mcap::kZstd ? packed(plain) : plain;
        std::string chunk;
        mcap::append(chunk, uint64_t(0)), mcap::append(chunk, uint64_t(0));  // times, which nobody needs
        mcap::append(chunk, uint64_t(plain.size()));
        mcap::append(chunk, shape_.has_crcs ? mcap::crcOf(plain) : 0);
        mcap::appendText(chunk, shape_.packing);
        mcap::append(chunk, uint64_t(content.size()));
        mcap::appendRecord(bytes_, mcap::kChunk, chunk + content);
    }
    void addOthers() {
        mcap::appendRecord(bytes_, mcap::Op(0x09), "an attachment");
        mcap::appendRecord(bytes_, mcap::Op(0x0C), "metadata");
        mcap::appendRecord(bytes_, mcap::Op(0xF0), "what nobody knows");
    }
    void addEnd(const std::string& declared) {
        std::string crc;
        mcap::append(crc, shape_.has_crcs ? mcap::crcOf(bytes_) : 0);
        mcap::appendRecord(bytes_, mcap::kDataEnd, crc);
        const size_t start = bytes_.size();
        if (shape_.has_summary) bytes_ += declared;
        bytes_ += char(mcap::kFooter);
        mcap::append(bytes_, uint64_t(2 * sizeof(uint64_t) + sizeof(uint32_t)));
        mcap::append(bytes_, uint64_t(shape_.has_summary ? start : 0)), mcap::append(bytes_, uint64_t(0));
        mcap::append(bytes_, shape_.has_crcs ? mcap::crcOf(bytes_.substr(start)) : 0);
        bytes_ += mcap::kMagic;
    }

    ForeignShape shape_;
    std::string bytes_;
};

// All shapes that are to be read.
inline std::vector<ForeignShape> foreignShapes() {
    std::vector<ForeignShape> shapes;
    for (const size_t per_chunk : {0, 1, 3})
        for (const char* packing : {"", "zstd"})
            for (const bool has_crcs : {false, true})
                for (const bool has_more : {false, true}) {
                    if (per_chunk == 0 && *packing != '\0') continue;
                    ForeignShape shape;
                    shape.per_chunk = per_chunk, shape.packing = packing, shape.has_crcs = has_crcs;
                    shape.says_channels_again = shape.has_summary = shape.has_attachments = has_more;
                    shape.name = std::to_string(per_chunk) + " per chunk, '" + packing + "'" +
                                 (has_crcs ? ", CRCs" : "") + (has_more ? ", more" : "");
                    shapes.push_back(shape);
                }
    return shapes;
}

}  // namespace bonemill::test
