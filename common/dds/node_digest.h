// Tells two models apart without sending them: server and client compare it (Status.node_digest).
#pragma once

#include <cstdint>

namespace bonemill {

// It is free of order: the sum modulo 2^64 of a mixed word per node. `content` tells what the
// node shows (EncodedNode::content).
class NodeDigest {
  public:
    void add(uint32_t node, uint64_t content) noexcept {
        ++count_;
        sum_ += mix(node, content);
    }
    // The pair must have been added.
    void remove(uint32_t node, uint64_t content) noexcept {
        --count_;
        sum_ -= mix(node, content);
    }

    uint32_t count() const noexcept { return count_; }
    uint64_t value() const noexcept { return sum_; }
    bool operator==(const NodeDigest&) const = default;

  private:
    // This is the finaliser of SplitMix64 (Steele, Lea, Flood: Fast splittable pseudorandom
    // number generators, 2014).
    static uint64_t mix(uint32_t node, uint64_t content) noexcept {
        return finalise(finalise(node) + content);
    }
    static uint64_t finalise(uint64_t word) noexcept {
        word += 0x9e3779b97f4a7c15u;
        word = (word ^ (word >> 30)) * 0xbf58476d1ce4e5b9u;
        word = (word ^ (word >> 27)) * 0x94d049bb133111ebu;
        return word ^ (word >> 31);
    }

    uint32_t count_ = 0;
    uint64_t sum_ = 0;
};

}  // namespace bonemill
