#include "haptic_server/scans/formats/stored_bytes.h"

#include <zlib.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <vector>

#include "common/base/user_error.h"
#include "common/files/require_file.h"
#include "haptic_server/scans/confined/import_limits.h"

namespace bonemill {
namespace {

constexpr int kAnyWrapper = 15 + 32;  // zlib: 32 added accepts a zlib or a gzip head
constexpr size_t kBufferBytes = size_t(1) << 18;

// Unpacks and throws away; gzip files may consist of several members.
class InflateCounter {
  public:
    explicit InflateCounter(const StoredData& data)
        : file_(data.file, std::ios::binary), name_(data.file.string()) {
        if (data.packed_bytes > 0) left_ = data.packed_bytes;
        file_.seekg(std::streamoff(data.begin));
        if (inflateInit2(&stream_, kAnyWrapper) != Z_OK) throw std::bad_alloc();
    }
    ~InflateCounter() { inflateEnd(&stream_); }
    InflateCounter(const InflateCounter&) = delete;
    InflateCounter& operator=(const InflateCounter&) = delete;

    // Reads on behind `needed` to the end of the member, so that its checksum counts, but no further.
    uint64_t count(uint64_t needed) {
        const uint64_t at_most = needed + kBufferBytes;
        uint64_t bytes = 0;
        while (bytes <= at_most) {
            if (stream_.avail_in == 0 && !refill()) break;
            stream_.next_out = out_.data();
            stream_.avail_out = uInt(out_.size());
            const int state = inflate(&stream_, Z_NO_FLUSH);
            bytes += out_.size() - stream_.avail_out;
            if (state == Z_STREAM_END) {
                if (bytes >= needed) break;
                inflateReset(&stream_);
            } else if (state != Z_OK && state != Z_BUF_ERROR) {
                throw UserError(name_ + ": its compressed voxels are damaged");
            }
        }
        return bytes;
    }

  private:
    bool refill() {
        file_.read(reinterpret_cast<char*>(in_.data()),
                   std::streamsize(std::min<uint64_t>(in_.size(), left_)));
        left_ -= uint64_t(file_.gcount());
        stream_.next_in = in_.data();
        stream_.avail_in = uInt(file_.gcount());
        return stream_.avail_in > 0;
    }

    std::ifstream file_;
    std::string name_;
    uint64_t left_ = std::numeric_limits<uint64_t>::max();  // packed bytes that belong to the data
    z_stream stream_{};
    std::vector<Bytef> in_ = std::vector<Bytef>(kBufferBytes);
    std::vector<Bytef> out_ = std::vector<Bytef>(kBufferBytes);
};

}  // namespace

bool namesSeveralFiles(const std::string& data_file) {
    return data_file.rfind("LIST", 0) == 0 || data_file.find('%') != std::string::npos;
}

uint64_t countStoredBytes(const StoredData& data, uint64_t needed) {
    requireFile(data.file);
    std::error_code error;
    const auto size = std::filesystem::file_size(data.file, error);
    if (error) throw UserError(data.file.string() + ": no such file; it should hold the voxels");
    const uint64_t stored = size > data.begin ? size - data.begin : 0;
    if (data.packing == StoredData::Packing::kOther) return stored * kMaxDeflateRatio;
    return data.packing == StoredData::Packing::kPlain ? stored : InflateCounter(data).count(needed);
}

}  // namespace bonemill
