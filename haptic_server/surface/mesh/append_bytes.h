#pragma once

#include <cstddef>
#include <vector>

namespace bonemill {

/// Appends `size` bytes at `data`, as they lie in memory.
inline void appendBytes(std::vector<char>& out, const void* data, size_t size) {
    const char* bytes = static_cast<const char*>(data);
    out.insert(out.end(), bytes, bytes + size);
}

}  // namespace bonemill
