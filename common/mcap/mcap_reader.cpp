#include "common/mcap/mcap_reader.h"

#include <zstd.h>

#include <istream>
#include <utility>

#include "common/mcap/foreign_reader.h"
#include "common/mcap/mcap_index.h"
#include "common/mcap/mcap_records.h"
#include "common/mcap/mcap_stream.h"

namespace bonemill::mcap {
namespace {

constexpr uint64_t kMaxHeader = 4096;
constexpr uint64_t kMaxTorn = uint64_t(1) << 20;  // of one chunk

// A chunk that is unpacked; what was found in it points into it.
struct OpenChunk {
    std::string plain;
    FoundRecords found;
};

class FileReader {
  public:
    FileReader(std::istream& stream, const Visit& visit)
        : records_(stream), size_(records_.left()), visit_(visit) {}

    Reading read() {
        readHeader();
        if (out_.problem.empty()) isOurs() ? readOurs() : readForeign(records_, has_record_, visit_, out_);
        out_.is_whole = out_.problem.empty();
        out_.lost_bytes = out_.is_whole ? 0 : size_ - out_.index.size();
        out_.is_torn_chunk = out_.is_whole || (is_cut_off_ && out_.lost_bytes <= kMaxTorn);
        return std::move(out_);
    }

  private:
    void fail(const std::string& what) {
        out_.problem = what + " at byte " + std::to_string(out_.index.size());
    }

    // Whoever writes our file anew may leave its header as it was, and gives it another shape. Takes the
    // first record.
    bool isOurs() {
        if (!out_.library.starts_with(kOurs)) return false;
        is_cut_off_ = records_.left() == 0;
        if (is_cut_off_ || !records_.takeHead()) return true;
        has_record_ = true;
        if (records_.length() > kMaxPacked || !records_.takeContent()) return true;
        if (records_.op() != kChunk) return records_.op() == kDataEnd;
        Taker taker(records_.content());
        taker.bytes(3 * sizeof(uint64_t));
        const auto crc = taker.number<uint32_t>();
        return crc != 0 && taker.text() == kZstd;
    }

    void readOurs() {
        while (out_.problem.empty() && !is_at_end_) readRecord();
        if (out_.problem.empty()) readEnding();
    }

    void readHeader() {
        std::string magic;
        if (!records_.takeBytes(kMagic.size(), magic) || magic != kMagic) return fail("this is no MCAP file");
        if (!records_.takeRecord(kMaxHeader) || records_.op() != kHeader)
            return fail("the header is torn or changed");
        Taker taker(records_.content());
        out_.profile = taker.text(), out_.library = taker.text();
        if (!taker.isDone()) return fail("the header is torn or changed");
        out_.index.addBytes(kMagic);
        records_.addTo(out_.index);
    }

    // False: no whole record is there. The first one may have been taken.
    bool takeRecord() {
        const bool is_there = std::exchange(has_record_, false)
                                  ? records_.content().size() == records_.length()
                                  : records_.takeRecord(kMaxPacked);
        is_cut_off_ = !is_there && records_.isCutOff();
        return is_there;
    }

    void readRecord() {
        is_cut_off_ = !has_record_ && records_.left() == 0;
        if (is_cut_off_) return fail("the end is missing: whoever wrote it was stopped");
        if (!takeRecord()) return fail("the file is torn");
        if (records_.op() == kDataEnd) {
            is_at_end_ = true;
            return;
        }
        OpenChunk chunk;
        if (records_.op() != kChunk || !open(chunk))
            return fail(KnownRecords::hasRoomFor(chunk.found, out_.index)
                            ? "a chunk is damaged"
                            : "there are too many schemas and channels");
        keep(chunk);
        for (const Message& message : chunk.found.messages) visit_(known_.channelOf(message), message);
    }

    bool open(OpenChunk& chunk) {
        Taker taker(records_.content());
        const auto first_ns = taker.number<uint64_t>(), last_ns = taker.number<uint64_t>();
        const auto plain_size = taker.number<uint64_t>();
        const auto crc = taker.number<uint32_t>();
        const bool is_zstd = taker.text() == kZstd;
        const std::string_view packed = taker.bytes(taker.number<uint64_t>());
        if (!taker.isDone() || !is_zstd || plain_size > kMaxPlain) return false;
        if (ZSTD_getFrameContentSize(packed.data(), packed.size()) != plain_size) return false;
        chunk.plain.resize(size_t(plain_size));
        const size_t unpacked =
            ZSTD_decompress(chunk.plain.data(), chunk.plain.size(), packed.data(), packed.size());
        if (unpacked != plain_size || crcOf(chunk.plain) != crc) return false;
        packed_size_ = packed.size();
        // Its CRC is right; yet whoever made it may have made it so.
        return known_.find(chunk.plain, out_.index, chunk.found) && chunk.found.first_ns == first_ns &&
               chunk.found.last_ns == last_ns;
    }

    // What follows the chunk in the file is known from it.
    void keep(OpenChunk& chunk) {
        records_.addTo(out_.index);
        FoundRecords& found = chunk.found;
        known_.keep(found, out_.index);
        const std::string indexes = out_.index.addChunk({kRecordHead + records_.length(), packed_size_,
                                                         chunk.plain.size(), found.first_ns, found.last_ns},
                                                        found.places);
        std::string in_file;
        const bool is_there = records_.takeBytes(indexes.size(), in_file);
        is_cut_off_ = !is_there && records_.isCutOff();
        if (is_there && in_file == indexes) return out_.index.addBytes(indexes);
        fail("the index of a chunk is torn or changed");
        out_.missing = indexes;
    }

    // It is known from what is before it, too.
    void readEnding() {
        const std::string ending = out_.index.ending();
        std::string found = records_.head() + records_.content(), rest;
        const bool is_longer = found.size() + records_.left() > ending.size();
        if (!is_longer && records_.takeBytes(records_.left(), rest)) found += rest;
        if (found == ending && !is_longer) return;
        is_cut_off_ = !is_longer && ending.starts_with(found);
        fail("the end is torn or changed, or something before it that no chunk covers,");
    }

    RecordStream records_;
    uint64_t size_;
    const Visit& visit_;
    Reading out_;
    KnownRecords known_{KnownRecords::Repeats::kNone};
    bool has_record_ = false;  // the first one was taken
    uint64_t packed_size_ = 0;
    bool is_at_end_ = false;
    bool is_cut_off_ = false;  // what was taken last goes on behind the file's end
};

}  // namespace

Reading read(std::istream& input, const Visit& visit) {
    return FileReader(input, visit).read();
}

}  // namespace bonemill::mcap
