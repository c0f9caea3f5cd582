// What zlib makes of bytes, with each of the heads that files of scans have.
#pragma once

#include <zlib.h>

#include <string>

namespace bonemill {

enum class DeflateHead { kNone, kZlib, kGzip };

inline std::string deflated(const std::string& bytes, DeflateHead head) {
    constexpr int kWindow = 15, kAsGzip = 16;
    z_stream stream{};
    const int window = head == DeflateHead::kNone   ? -kWindow
                       : head == DeflateHead::kGzip ? kWindow + kAsGzip
                                                    : kWindow;
    deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, window, 8, Z_DEFAULT_STRATEGY);
    std::string out(deflateBound(&stream, uLong(bytes.size())), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = uInt(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = uInt(out.size());
    deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

}  // namespace bonemill
