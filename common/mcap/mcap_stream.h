// The records of an MCAP file, one after the other, of which no more is read than is there. It is for normal
// threads.
#pragma once

#include <cstdint>
#include <istream>
#include <string>

#include "common/mcap/mcap_index.h"

namespace bonemill::mcap {

class RecordStream {
  public:
    explicit RecordStream(std::istream& stream) : stream_(stream) {
        stream_.seekg(0, std::ios::end);
        left_ = stream_ ? uint64_t(stream_.tellg()) : 0;
        stream_.seekg(0);
    }
    uint64_t left() const { return left_; }
    // What was asked for last goes on behind the file's end.
    bool isCutOff() const { return is_cut_off_; }

    // They return false where that is not all there.
    bool takeBytes(uint64_t count, std::string& bytes) {
        bytes.clear();
        is_cut_off_ = count > left_;
        if (is_cut_off_) return false;
        bytes.resize(size_t(count));
        if (!stream_.read(bytes.data(), std::streamsize(count))) return false;
        left_ -= count;
        return true;
    }
    // Of the next record: what it is, and how long its content is.
    bool takeHead() {
        if (!takeBytes(kRecordHead, head_)) return false;
        Taker taker(head_);
        op_ = taker.number<uint8_t>();
        length_ = taker.number<uint64_t>();
        content_.clear();
        return true;
    }
    bool takeContent() { return takeBytes(length_, content_); }
    // A whole record of no more than that.
    bool takeRecord(uint64_t most) { return takeHead() && length_ <= most && takeContent(); }

    uint8_t op() const { return op_; }
    uint64_t length() const { return length_; }  // of the content
    const std::string& head() const { return head_; }
    const std::string& content() const { return content_; }
    void addTo(Index& index) const { index.addBytes(head_), index.addBytes(content_); }

  private:
    std::istream& stream_;
    uint64_t left_ = 0;
    bool is_cut_off_ = false;
    uint8_t op_ = 0;
    uint64_t length_ = 0;
    std::string head_, content_;
};

}  // namespace bonemill::mcap
