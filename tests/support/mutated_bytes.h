// Makes damage for fuzz tests.
#pragma once

#include <random>
#include <string>

namespace bonemill::test {

// Returns valid bytes with a few bits, bytes, or the length changed; now and then it returns only noise.
inline std::string mutated(const std::string& valid, std::mt19937& random) {
    const auto below = [&](size_t n) { return std::uniform_int_distribution<size_t>(0, n - 1)(random); };
    std::string bytes = valid;
    if (below(20) == 0) {
        bytes.resize(below(200));
        for (char& c : bytes) c = static_cast<char>(random());
        return bytes;
    }
    for (size_t changes = 1 + below(4); changes > 0 && !bytes.empty(); --changes) {
        switch (below(4)) {
            case 0:
                bytes[below(bytes.size())] ^= static_cast<char>(1u << below(8));
                break;
            case 1:
                bytes[below(bytes.size())] = static_cast<char>(random());
                break;
            case 2:
                bytes.resize(below(bytes.size() + 1));
                break;
            default:
                bytes.insert(below(bytes.size() + 1), 1, static_cast<char>(random()));
                break;
        }
    }
    return bytes;
}

}  // namespace bonemill::test
