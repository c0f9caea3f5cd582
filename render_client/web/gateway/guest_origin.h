// Where guests come from, and how many may come from there. Of those who come through a relay the address is
// the relay's word: it tells them apart, and all of them together leave room for others, whatever the relay
// says.
#pragma once

#include <algorithm>
#include <compare>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

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

// Those who are there, in the order in which they came, and one who comes.
class Crowd {
  public:
    explicit Crowd(GuestOrigin comer) : comer_(std::move(comer)) {}
    void add(const GuestOrigin& one) { there_.push_back(one); }
    bool hasPlace(const CrowdBounds& bounds) const {
        return countOfComer() < bounds.of_address && there_.size() < bounds.all && !isRelayFull(bounds);
    }
    // Where there is no place: which of them, counted from 0, is to go instead, so that nobody keeps others
    // out by many connections. It is the first of the address that has most of these places; nobody, where
    // the comer's has as many, or its share.
    std::optional<size_t> whoMakesRoom(const CrowdBounds& bounds) const {
        if (countOfComer() >= bounds.of_address) return std::nullopt;
        std::map<GuestOrigin, size_t> counts;
        for (const GuestOrigin& one : there_)
            if (one.is_relayed || !isRelayFull(bounds)) ++counts[one];
        const auto most = std::ranges::max_element(counts, {}, [](const auto& one) { return one.second; });
        if (most == counts.end() || most->second <= countOfComer()) return std::nullopt;
        return size_t(std::ranges::find(there_, most->first) - there_.begin());
    }

  private:
    size_t countOfComer() const { return size_t(std::ranges::count(there_, comer_)); }
    bool isRelayFull(const CrowdBounds& bounds) const {
        return comer_.is_relayed &&
               size_t(std::ranges::count_if(there_, &GuestOrigin::is_relayed)) >= bounds.relayed;
    }

    const GuestOrigin comer_;
    std::vector<GuestOrigin> there_;
};

}  // namespace bonemill::gateway
