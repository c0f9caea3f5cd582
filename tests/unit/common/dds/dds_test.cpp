#include <dds/dds.h>
#include <gtest/gtest.h>
#include <net/if.h>
#include <spdlog/sinks/ringbuffer_sink.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <filesystem>
#include <map>
#include <thread>

#include "common/base/user_error.h"
#include "common/dds/endpoint.h"
#include "tests/support/dds_session.h"
#include "tests/unit/common/ipc/child.h"

namespace bonemill::dds {
namespace {

using namespace std::chrono_literals;

NodeMeshSample nodeSample(uint32_t node, uint32_t revision) {
    NodeMeshSample sample{};
    sample.session = testSession();
    sample.node = node;
    sample.revision = revision;
    return sample;
}

class DdsTest : public testing::Test {
  protected:
    // A node maps to its payload, to "disposed", or to "left" for a key whose writer is gone.
    using Seen = std::map<uint32_t, std::string>;

    // Takes until `node` was seen, or for 10 s.
    static Seen takeUntil(const Participant& participant, Reader<NodeMeshSample>& reader, uint32_t node) {
        WaitSet wait_set(participant);
        wait_set.add([&reader] { return reader.handle(); });
        Seen seen;
        while (!seen.contains(node) && wait_set.wait(10s)) {
            reader.take(1000, [&](const NodeMeshSample& sample, const SampleInfo& info) {
                if (sample.session != testSession()) return;
                const auto payload = payloadOf(sample);
                seen[sample.node] = info.is_disposed ? "disposed"
                                    : info.has_data  ? std::string(payload.begin(), payload.end())
                                                     : "left";
            });
        }
        return seen;
    }

    Participant participant_{testDomain()};
};

TEST_F(DdsTest, LateReaderGetsTheNewestSamplePerKeyAndDisposedKeys) {
    Writer<NodeMeshSample> writer(participant_);
    const std::string newest = "newest", old = "old";
    for (uint32_t node = 0; node < 10; ++node) {
        for (uint32_t revision = 0; revision < 5; ++revision) {
            NodeMeshSample sample = nodeSample(node, revision);
            setPayload(sample, revision == 4 ? newest : old);
            EXPECT_TRUE(writer.write(sample));
        }
    }
    EXPECT_TRUE(writer.dispose(nodeSample(3, 0)));
    EXPECT_TRUE(writer.write(nodeSample(99, 0)));

    Participant late(testDomain());
    Reader<NodeMeshSample> reader(late);
    Seen seen = takeUntil(late, reader, 99);
    ASSERT_EQ(seen.size(), 11u);
    EXPECT_EQ(seen[3], "disposed");
    seen.erase(3);
    seen.erase(99);
    for (const auto& [node, text] : seen) EXPECT_EQ(text, "newest") << node;
}

// What is tied to a device has its index, whatever address it is bound to.
TEST_F(DdsTest, OnOnePcEverySocketIsTiedToTheLoopback) {
    int tied = 0;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
        const int descriptor = std::stoi(entry.path().filename().string());
        int type = 0, domain = 0, device = 0;
        socklen_t size = sizeof type;
        if (getsockopt(descriptor, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_DGRAM) continue;
        ASSERT_EQ(getsockopt(descriptor, SOL_SOCKET, SO_DOMAIN, &domain, &size), 0);
        if (domain != AF_INET) continue;
        ASSERT_EQ(getsockopt(descriptor, SOL_SOCKET, SO_BINDTOIFINDEX, &device, &size), 0);
        EXPECT_EQ(device, int(if_nametoindex("lo")));
        ++tied;
    }
    EXPECT_GE(tied, 2);
}

TEST_F(DdsTest, WriterThatLeavesDoesNotDispose) {
    Reader<NodeMeshSample> reader(participant_);
    {
        Participant server(testDomain());
        Writer<NodeMeshSample> writer(server);
        EXPECT_TRUE(writer.write(nodeSample(1, 1)));
        EXPECT_EQ(takeUntil(participant_, reader, 1).at(1), "");
    }
    EXPECT_EQ(takeUntil(participant_, reader, 1).at(1), "left");
}

TEST_F(DdsTest, TakeKeepsTheRestForTheNextCall) {
    Writer<NodeMeshSample> writer(participant_);
    Reader<NodeMeshSample> reader(participant_);
    for (uint32_t node = 0; node < 200; ++node) EXPECT_TRUE(writer.write(nodeSample(node, 1)));
    const auto ignore = [](const NodeMeshSample&, const SampleInfo&) {};
    EXPECT_EQ(reader.take(150, ignore), 150u);
    EXPECT_EQ(reader.take(150, ignore), 50u);
    EXPECT_EQ(reader.take(150, ignore), 0u);
}

// They stay: DDS keeps a key for as long as its writer lives.
TEST_F(DdsTest, InventedSendersOfAStreamTakeBoundedMemoryAndKeepOutNobody) {
    Reader<HandPointerSample> reader(participant_);
    HandPointerSample sample{};
    sample.session = testSession();
    uint64_t heard = 0;
    const auto hear = [&](const HandPointerSample& one, const SampleInfo&) { heard = one.sender; };
    Writer<HandPointerSample> hostile(participant_), honest(participant_);
    for (sample.sender = 1; sample.sender <= 2 * kMaxStreamKeys; ++sample.sender) hostile.write(sample);
    EXPECT_EQ(reader.take(10 * kMaxStreamKeys, hear), size_t(kMaxStreamKeys));
    EXPECT_EQ(reader.take(1, hear), 0u);
    EXPECT_TRUE(honest.write(sample));
    EXPECT_EQ(reader.take(1, hear), 1u);
    EXPECT_EQ(heard, sample.sender);
    WaitSet wait_set(participant_);
    wait_set.add([&reader] { return reader.handle(); });
    for (sample.sender = 1; sample.sender <= 2 * kMaxStreamKeys; ++sample.sender) {
        hostile.write(sample);
        if (sample.sender % 64 == 0) reader.take(64, hear);
    }
    reader.take(64, hear);
    EXPECT_TRUE(honest.write(sample));
    EXPECT_TRUE(wait_set.wait(10s)) << "the reader has begun anew meanwhile";
    EXPECT_EQ(reader.take(1, hear), 1u);
    EXPECT_EQ(heard, sample.sender);
}

TEST_F(DdsTest, PayloadIsNotCopiedIntoTheSample) {
    const std::string bytes = "payload";
    NodeMeshSample sample{};
    setPayload(sample, bytes);
    EXPECT_EQ(static_cast<const void*>(payloadOf(sample).data()), static_cast<const void*>(bytes.data()));
    EXPECT_FALSE(sample.payload._release);
}

TEST_F(DdsTest, LogsAWriterThatDoesNotMatch) {
    const auto sink = std::make_shared<spdlog::sinks::ringbuffer_sink_mt>(100);
    const auto logger_before = spdlog::default_logger();
    spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", sink));

    Reader<NodeMeshSample> reader(participant_);
    Participant other(testDomain());
    TopicDescription description = describeTopic<NodeMeshSample>();
    dds_qset_reliability(description.qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
    const AnyWriter writer(other, description);
    for (int i = 0; i < 1000 && sink->last_raw().empty(); ++i) std::this_thread::sleep_for(10ms);
    for (uint64_t i = 0; i < 2 * kMaxNamedMismatches; ++i) const AnyWriter more(other, description);

    spdlog::set_default_logger(logger_before);
    const auto lines = sink->last_formatted();
    ASSERT_FALSE(lines.empty());
    EXPECT_NE(lines[0].find("bonemill_node_mesh"), std::string::npos) << lines[0];
    EXPECT_EQ(writer.matchedReaders(), 0);
    EXPECT_LE(lines.size(), kMaxNamedMismatches) << "they must not fill the log";
}

// A program that reads every tick and stands still, stopped or on a bad network.
TEST(Ticks, WaitForNoReaderThatStandsStill) {
    int ready[2];
    ASSERT_EQ(pipe(ready), 0);
    const uint32_t domain = testDomain();
    Child child([&] {
        const Participant participant(domain);
        const Reader<TicksSample> reader(participant);
        while (reader.matchedWriters() == 0) std::this_thread::sleep_for(1ms);
        if (write(ready[1], "r", 1) != 1) return 1;
        for (;;) pause();
    });
    const Participant participant(domain);
    Writer<TicksSample> writer(participant);
    char letter = 0;
    ASSERT_EQ(read(ready[0], &letter, 1), 1);
    for (int n = 0; n < 2000 && writer.matchedReaders() == 0; ++n) std::this_thread::sleep_for(5ms);
    ASSERT_EQ(writer.matchedReaders(), 1);
    child.stop();
    TicksSample sample{};
    sample.session = testSession();
    const std::string payload(size_t(16) << 10, 'x');  // of 64 ticks
    setPayload(sample, payload);
    for (int n = 0; n < 300; ++n) ASSERT_TRUE(writer.write(sample)) << "it has waited, and given up";
}

TEST(Participant, RefusesADomainThatHasNoPorts) {
    EXPECT_THROW(Participant(kMaxDomain + 1), UserError);
}

TEST(Participant, RefusesABadProfile) {
    setenv("CYCLONEDDS_URI", "<CycloneDDS><Domain><NoSuchElement/></Domain></CycloneDDS>", 1);
    EXPECT_THROW(Participant(testDomain() + 1), UserError);
    unsetenv("CYCLONEDDS_URI");
}

TEST(Participant, DomainCanBeJoinedAgainAfterItWasLeft) {
    for (int i = 0; i < 3; ++i) {
        Participant first(testDomain() + 1);
        Participant second(testDomain() + 1);
        EXPECT_NE(first.handle(), second.handle());
    }
}

}  // namespace
}  // namespace bonemill::dds
