#include <gtest/gtest.h>

#include <limits>

#include "device_daemon/ares/emulator/fault_spec.h"

namespace bonemill {
namespace {

constexpr int64_t kPeriodNs = 1'000'000;

class TestWire {
  public:
    explicit TestWire(const std::vector<std::string>& faults, uint32_t seed = 1)
        : wire_(specsOf(faults), seed, kPeriodNs) {}

    void put(int number, int64_t now_ns, double engaged_s = 0) {
        const std::byte bytes[2] = {std::byte(number), std::byte{0}};
        wire_.put(bytes, {1, 2}, engaged_s, now_ns);
    }
    std::vector<int> takeAll(int64_t now_ns) {
        std::vector<int> numbers;
        FaultyWire::Datagram datagram;
        while (wire_.take(datagram, now_ns)) {
            EXPECT_EQ(datagram.size, 2u);
            EXPECT_EQ(datagram.other, (wire::Endpoint{1, 2}));
            numbers.push_back(int(datagram.bytes[0]));
        }
        return numbers;
    }
    int64_t nextDueNs() const { return wire_.nextDueNs(); }

  private:
    static std::vector<FaultSpec> specsOf(const std::vector<std::string>& texts) {
        std::vector<FaultSpec> faults;
        for (const std::string& text : texts) faults.push_back(faultSpecOf(text));
        return faults;
    }
    FaultyWire wire_;
};

TEST(FaultyWire, WithoutFaultsCarriesAllAtOnceInOrder) {
    TestWire wire({"emergency-stop"});
    EXPECT_EQ(wire.nextDueNs(), std::numeric_limits<int64_t>::max());
    for (int i = 0; i < 5; ++i) wire.put(i, 10);
    EXPECT_EQ(wire.takeAll(10), (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST(FaultyWire, DelaysAndLetsOvertake) {
    TestWire late({"delay:2"});
    late.put(1, 0);
    EXPECT_EQ(late.nextDueNs(), 2'000'000);
    EXPECT_TRUE(late.takeAll(1'999'999).empty());
    EXPECT_EQ(late.takeAll(2'000'000), std::vector<int>{1});
    TestWire mixed({"reorder@0+1"});
    mixed.put(1, 0, 0.5);
    mixed.put(2, kPeriodNs, 1.0);
    EXPECT_EQ(mixed.takeAll(2 * kPeriodNs), (std::vector<int>{2, 1}));
}

TEST(FaultyWire, DropsAsOftenAsToldAndTheSameWithTheSameSeed) {
    const auto arrived = [](uint32_t seed) {
        TestWire wire({"drop%25"}, seed);
        std::vector<int> numbers;
        for (int i = 0; i < 4000; ++i) {
            wire.put(i % 200, i);
            for (const int n : wire.takeAll(i)) numbers.push_back(n);
        }
        return numbers;
    };
    EXPECT_NEAR(double(arrived(1).size()), 3000, 150);
    EXPECT_EQ(arrived(1), arrived(1));
    EXPECT_NE(arrived(1), arrived(2));
}

TEST(FaultyWire, DoublesCorruptsAndGoesSilent) {
    TestWire twice({"duplicate"});
    twice.put(7, 0);
    EXPECT_EQ(twice.takeAll(0), (std::vector<int>{7, 7}));
    TestWire silent({"unplug@1"});
    silent.put(7, 0, 0.9);
    silent.put(8, 0, 1.0);
    EXPECT_EQ(silent.takeAll(0), std::vector<int>{7});

    FaultyWire corrupt({faultSpecOf("corrupt")}, 3, kPeriodNs);
    const std::array<std::byte, 40> zeros{};
    corrupt.put(zeros, {}, 0, 0);
    FaultyWire::Datagram datagram;
    ASSERT_TRUE(corrupt.take(datagram, 0));
    int bits = 0;
    for (const std::byte b : datagram.content()) bits += std::popcount(uint8_t(b));
    EXPECT_EQ(bits, 1);
}

TEST(FaultyWire, AFullOneLosesInsteadOfGrowing) {
    TestWire wire({"delay:1000"});
    for (int i = 0; i < 3000; ++i) wire.put(i % 100, i);
    EXPECT_EQ(wire.takeAll(int64_t(1e12)).size(), 1024u);
}

}  // namespace
}  // namespace bonemill
