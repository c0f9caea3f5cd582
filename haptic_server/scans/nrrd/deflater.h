// Writes bytes to a file as gzip.
#pragma once

#include <zlib.h>

#include <cstddef>
#include <fstream>
#include <new>
#include <span>
#include <vector>

namespace bonemill {

class Deflater {
  public:
    Deflater() {
        constexpr int kGzipWindow = 15 + 16;  // zlib: 16 added asks for a gzip wrapper, without a time stamp
        if (deflateInit2(&stream_, Z_BEST_SPEED, Z_DEFLATED, kGzipWindow, 8, Z_DEFAULT_STRATEGY) != Z_OK)
            throw std::bad_alloc();
    }
    ~Deflater() { deflateEnd(&stream_); }
    Deflater(const Deflater&) = delete;
    Deflater& operator=(const Deflater&) = delete;

    // `flush` is Z_NO_FLUSH, or Z_FINISH for the last bytes.
    void write(std::span<const std::byte> bytes, int flush, std::ofstream& file) {
        stream_.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));
        stream_.avail_in = uInt(bytes.size());
        do {
            stream_.next_out = out_.data();
            stream_.avail_out = uInt(out_.size());
            deflate(&stream_, flush);
            file.write(reinterpret_cast<const char*>(out_.data()),
                       std::streamsize(out_.size() - stream_.avail_out));
        } while (stream_.avail_out == 0);  // zlib: room left means that all input is used
    }

  private:
    z_stream stream_{};
    std::vector<Bytef> out_ = std::vector<Bytef>(size_t(1) << 18);
};

}  // namespace bonemill
