// Numbers as OpenIGTLink has them on the wire: big-endian. Any thread.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace bonemill::igtl {

template <class Number>
using BitsOf =
    std::conditional_t<sizeof(Number) == 8, uint64_t,
                       std::conditional_t<sizeof(Number) == 4, uint32_t,
                                          std::conditional_t<sizeof(Number) == 2, uint16_t, uint8_t>>>;

template <class Number>
void append(std::string& bytes, Number number) {
    const auto bits = std::bit_cast<BitsOf<Number>>(number);
    for (int shift = 8 * int(sizeof(Number)) - 8; shift >= 0; shift -= 8) bytes += char(bits >> shift & 0xFF);
}

// There are as many bytes.
template <class Number>
Number read(std::string_view bytes, size_t at) {
    uint64_t bits = 0;
    for (size_t n = 0; n < sizeof(Number); ++n) bits = bits << 8 | uint8_t(bytes[at + n]);
    return std::bit_cast<Number>(BitsOf<Number>(bits));
}

}  // namespace bonemill::igtl
