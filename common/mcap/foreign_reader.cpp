#include "common/mcap/foreign_reader.h"

#include <zstd.h>

#include <algorithm>
#include <memory>

#include "common/mcap/mcap_records.h"

namespace bonemill::mcap {
namespace {

constexpr size_t kPiece = size_t(1) << 20;

class ForeignReader {
  public:
    ForeignReader(RecordStream& records, const Visit& visit, Reading& out)
        : records_(records), visit_(visit), out_(out), zstd_(ZSTD_createDCtx(), ZSTD_freeDCtx) {}

    void read(bool has_record) {
        if (has_record || takeNext()) takeRecord();
        while (out_.problem.empty() && !is_at_end_ && takeNext()) takeRecord();
        if (out_.problem.empty()) readSummary();
    }

  private:
    void fail(const std::string& what) {
        out_.problem = what + " at byte " + std::to_string(out_.index.size());
    }
    // Something that this reader cannot do, and that is not the file's fault.
    void refuse(const std::string& what) {
        fail(what + "; write it anew with zstd or unpacked (mcap compress --compression zstd)");
    }

    // Reads the next record, without what is only passed over.
    bool takeNext() {
        if (records_.left() == 0)
            fail("the end is missing: whoever wrote it was stopped");
        else if (!records_.takeHead() || (isRead(records_.op()) && !isTooLarge() && !records_.takeContent()))
            fail("the file is torn");
        else if (isRead(records_.op()) && isTooLarge())
            refuse("a record is larger than " + std::to_string(kMaxPacked >> 20) + " MiB");
        return out_.problem.empty();
    }
    bool isTooLarge() const { return records_.length() > kMaxPacked; }
    static bool isRead(uint8_t op) {
        return op == kSchema || op == kChannel || op == kMessage || op == kChunk || op == kDataEnd ||
               op == kFooter;
    }

    void takeRecord() {
        const uint8_t op = records_.op();
        if (op == kDataEnd) return takeDataEnd();
        if (op == kFooter) return fail("the end of its data is missing");
        if (op == kChunk) return takeChunk();
        if (!isRead(op)) return passOver();
        const std::string record = records_.head() + records_.content();
        take(record, op == kMessage ? "a message is damaged" : "a schema or channel is damaged");
    }

    void take(std::string_view bytes, const char* complaint) {
        FoundRecords found;
        if (!known_.find(bytes, out_.index, found))
            return fail(KnownRecords::hasRoomFor(found, out_.index)
                            ? complaint
                            : "there are too many schemas and channels");
        records_.addTo(out_.index);
        known_.keep(found, out_.index);
        for (const Message& message : found.messages) visit_(known_.channelOf(message), message);
    }

    void takeChunk() {
        Taker taker(records_.content());
        taker.number<uint64_t>(), taker.number<uint64_t>();  // its first and last time
        const auto plain_size = taker.number<uint64_t>();
        const auto crc = taker.number<uint32_t>();
        const std::string packing{taker.text()};
        const std::string_view packed = taker.bytes(taker.number<uint64_t>());
        if (!taker.isDone()) return fail("a chunk is damaged");
        if (!packing.empty() && packing != kZstd)
            return refuse("its chunks are packed by '" + packing.substr(0, 16) + "', which is not read here");
        if (plain_size > kMaxPlain)
            return refuse("a chunk is larger than " + std::to_string(kMaxPlain >> 20) + " MiB");
        const bool is_plain = packing.empty();
        if (is_plain ? packed.size() != plain_size : !unpack(packed, size_t(plain_size)))
            return fail("a chunk is damaged");
        const std::string_view plain = is_plain ? packed : std::string_view(plain_);
        if (crc != 0 && crcOf(plain) != crc) return fail("a chunk is damaged: its CRC is another one");
        take(plain, "a chunk is damaged");
    }

    // What a small file claims costs nothing before it is there.
    bool unpack(std::string_view packed, size_t size) {
        plain_.clear();
        ZSTD_DCtx_reset(zstd_.get(), ZSTD_reset_session_only);
        ZSTD_inBuffer in{packed.data(), packed.size(), 0};
        piece_.resize(kPiece);
        for (size_t due = 1; in.pos < in.size || due != 0;) {
            ZSTD_outBuffer out{piece_.data(), piece_.size(), 0};
            due = ZSTD_decompressStream(zstd_.get(), &out, &in);
            if (ZSTD_isError(due) || plain_.size() + out.pos > size) return false;
            plain_.append(piece_, 0, out.pos);
            if (out.pos < out.size && in.pos == in.size && due != 0) return false;  // it is cut short
        }
        return plain_.size() == size;
    }

    void passOver() {
        if (records_.content().size() == records_.length()) return records_.addTo(out_.index);
        out_.index.addBytes(records_.head());
        std::string bytes;
        for (uint64_t left = records_.length(); left > 0; left -= bytes.size()) {
            if (!records_.takeBytes(std::min<uint64_t>(left, kPiece), bytes)) return fail("the file is torn");
            out_.index.addBytes(bytes);
        }
    }

    void takeDataEnd() {
        Taker taker(records_.content());
        const auto crc = taker.number<uint32_t>();
        if (!taker.isDone()) return fail("the end of its data is damaged");
        if (crc != 0 && crc != out_.index.crc())
            return fail("something before the end was changed: the CRC is another one");
        is_at_end_ = true;
    }

    // Records that say again what was met, the footer, and the last mark.
    void readSummary() {
        records_.addTo(out_.index);
        uint64_t start = out_.index.size();
        uint32_t crc = 0;
        while (out_.problem.empty() && takeNext() && records_.op() != kFooter) {
            crc = crcOf(records_.head(), crc);
            std::string bytes;
            if (isRead(records_.op()))
                bytes = records_.content();
            else if (records_.length() > kMaxPacked || !records_.takeBytes(records_.length(), bytes))
                return fail("the summary is torn");
            crc = crcOf(bytes, crc);
            out_.index.addBytes(records_.head()), out_.index.addBytes(bytes);
        }
        if (!out_.problem.empty()) return;
        Taker taker(records_.content());
        const auto summary_start = taker.number<uint64_t>();
        taker.number<uint64_t>();  // of the offsets
        const auto summary_crc = taker.number<uint32_t>();
        std::string magic;
        const std::string covered = records_.head() + records_.content().substr(0, 2 * sizeof(uint64_t));
        if (!taker.isDone() || !records_.takeBytes(kMagic.size(), magic) || magic != kMagic ||
            records_.left() > 0)
            return fail("the end is torn or changed");
        if (summary_crc != 0 && (summary_start != start && summary_start != 0))
            return fail("the summary is not where the end says");
        if (summary_crc != 0 && crcOf(covered, crc) != summary_crc)
            return fail("the summary was changed: its CRC is another one");
        records_.addTo(out_.index);
        out_.index.addBytes(magic);
    }

    RecordStream& records_;
    const Visit& visit_;
    Reading& out_;
    std::unique_ptr<ZSTD_DCtx, size_t (*)(ZSTD_DCtx*)> zstd_;
    KnownRecords known_{KnownRecords::Repeats::kAllowed};
    std::string plain_, piece_;
    bool is_at_end_ = false;
};

}  // namespace

void readForeign(RecordStream& records, bool has_record, const Visit& visit, Reading& reading) {
    reading.is_foreign = true;
    ForeignReader(records, visit, reading).read(has_record);
}

}  // namespace bonemill::mcap
