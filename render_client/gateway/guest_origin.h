// Where guests come from, and how many may come from there. Of those who come through a relay the address is
// the relay's word: it tells them apart, and all of them together leave room for others, whatever the relay
// says.
#pragma once

#include <compare>
#include <cstddef>
#include <string>
#include <utility>

namespace bonemill::gateway {

struct GuestOrigin {
    std::string address;
    bool is_relayed = false;

    auto operator<=>(const GuestOrigin&) const = default;
    std::string text() const { return address + (is_relayed ? " through the relay" : ""); }
};

// So many at once.
struct CrowdBounds {
    size_t all;
    size_t of_address;
    size_t relayed;
};

// Counts those who are there, for one who comes.
class Crowd {
  public:
    explicit Crowd(GuestOrigin comer) : comer_(std::move(comer)) {}
    void add(const GuestOrigin& one) {
        ++all_;
        of_address_ += one == comer_;
        relayed_ += one.is_relayed;
    }
    bool hasPlace(const CrowdBounds& bounds) const {
        return all_ < bounds.all && of_address_ < bounds.of_address &&
               (!comer_.is_relayed || relayed_ < bounds.relayed);
    }

  private:
    GuestOrigin comer_;
    size_t all_ = 0, of_address_ = 0, relayed_ = 0;
};

}  // namespace bonemill::gateway
