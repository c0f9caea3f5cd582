// Damaged journals and trajectories go through all that reads them for a replay: they are refused, or what is
// read holds what a replay relies on.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

#include "common/base/user_error.h"
#include "common/mcap/mcap_writer.h"
#include "haptic_server/recording/journal/journal_topics.h"
#include "haptic_server/recording/rerun/recording.h"
#include "haptic_server/scene/setup/scene_setup.h"
#include "haptic_server/scene/trajectory/trajectory_reader.h"
#include "tests/support/mutated_bytes.h"
#include "tests/support/recorded_session.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

constexpr int kRounds = 300, kRowRounds = 20'000;

std::string bytesOf(const std::filesystem::path& path) {
    std::ostringstream bytes;
    bytes << std::ifstream(path, std::ios::binary).rdbuf();
    return bytes.str();
}

// Reads as a replay does.
void readAll(const std::string& path) {
    const Recording recording(path);
    ASSERT_GT(recording.ticks(), 0u);
    RecordedTicks ticks(recording);
    for (uint64_t tick = 0; tick < recording.ticks(); tick += 97) {
        EXPECT_EQ(ticks.at(tick).tick, tick);
        EXPECT_TRUE(std::isfinite(recording.secondsOf(tick)));
        EXPECT_GE(ticks.at(tick).input.periods, 1);
    }
    EXPECT_LT(recording.tickAt(1e12), recording.ticks());
    EXPECT_TRUE(std::isfinite(recording.lengthS()));
}

void readBytes(const std::string& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
    try {
        readAll(path);
    } catch (const UserError&) {
    }
}

class RecordingFuzz : public testing::Test {
  protected:
    test::TemporaryFolder folder_;
    const std::filesystem::path journal_ = test::recordSession(folder_.path(), {.ticks = 700}).journal;
    const std::string path_ = folder_ / "damaged.mcap";
};

TEST_F(RecordingFuzz, DamagedJournalsAreRefusedOrWhole) {
    const std::string valid = bytesOf(journal_);
    std::mt19937 random(19);
    for (int round = 0; round < kRounds; ++round) readBytes(path_, test::mutated(valid, random));
}

// Whoever makes a journal makes its sums right.
TEST_F(RecordingFuzz, MessagesThatSomebodyChanged) {
    struct Kept {
        JournalTopic topic;
        uint64_t time_ns;
        std::string data;
    };
    std::vector<Kept> messages;
    readJournal(journal_, [&](JournalTopic topic, const mcap::Message& message) {
        if (topic < JournalTopic::kTool)
            messages.push_back({topic, message.time_ns, std::string(message.data)});
    });
    const LoadedScene scene = Recording(journal_).scene();
    const SceneSetup simulation = setUpScene(scene);
    std::mt19937 random(20);
    for (int round = 0; round < kRounds; ++round) {
        mcap::Writer writer(kJournalProfile, "bonemill fuzz");
        for (const JournalTopicName& topic : kJournalTopics) addTopic(topic, writer);
        for (const Kept& message : messages) {
            const bool is_changed =
                std::uniform_int_distribution<size_t>(0, messages.size() / 2)(random) == 0;
            writer.addMessage(uint16_t(message.topic), message.time_ns,
                              is_changed ? test::mutated(message.data, random) : message.data);
        }
        writer.finish();
        readBytes(path_, writer.take());
        try {
            const Recording::Bones bones = Recording(path_).readBones(*simulation.bone);
            EXPECT_FALSE(bones.keyframes.empty());
        } catch (const UserError&) {
        }
    }
}

TEST(RecordedRowFuzz, RowsOfRecordedTrajectories) {
    const std::string valid =
        "t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons," + recordedHeader() +
        "\n0,0,0,0,1,0,0,0,1,3,1,0,0,2,0,0,1,0,3,0,1,\n0.001,nan,0,0,1,0,0,0,1,0,2,0,0,2,0,0,1,0,3,9,0.5," +
        textOfDevice(DeviceCapabilities{.name = "a",
                                        .kind = 1,
                                        .abilities = 1,
                                        .max_force = 3,
                                        .max_torque = 0,
                                        .max_stiffness = 0,
                                        .max_rotation_stiffness = 0,
                                        .workspace_radius = 0.1}) +
        "\n";
    std::mt19937 random(19);
    const auto read = [](const std::string& text) {
        std::istringstream stream(text);
        return readTrajectory(stream, "fuzz");
    };
    ASSERT_TRUE(read(valid)[1].recorded->input.has_other_device);
    EXPECT_EQ(read(valid)[1].recorded->input.periods, 2);
    for (int round = 0; round < kRowRounds; ++round) {
        try {
            for (const TrajectoryRow& row : read(test::mutated(valid, random))) {
                if (!row.recorded) continue;
                EXPECT_GE(row.recorded->input.periods, 1);
                EXPECT_TRUE(row.recorded->input.stale_factor >= 0 && row.recorded->input.stale_factor <= 1);
                EXPECT_TRUE(!row.recorded->input.has_other_device ||
                            isPlausible(row.recorded->input.other_device));
            }
        } catch (const UserError&) {
        }
    }
}

}  // namespace
}  // namespace bonemill
