#include "haptic_server/recording/foxglove/foxglove_export.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "common/base/user_error.h"
#include "common/mcap/mcap_reader.h"
#include "haptic_server/recording/export/export_journal.h"
#include "haptic_server/recording/rerun/rerun.h"
#include "tests/support/recorded_session.h"
#include "tests/support/rewritten_journal.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

struct Told {
    uint64_t time_ns;
    std::string data;
    template <class Message>
    Message as() const {
        Message message;
        EXPECT_TRUE(message.ParseFromString(data));
        return message;
    }
};

class FoxgloveExported : public testing::Test {
  protected:
    // Exports the journal, and reads what was written.
    void exported(const std::filesystem::path& journal) {
        exportJournal({.journal = journal,
                       .h5 = "",
                       .csv = folder_ / "s.csv",
                       .traj = "",
                       .foxglove = folder_ / "s.mcap"});
        std::ifstream file(folder_ / "s.mcap", std::ios::binary);
        reading_ = mcap::read(file, [&](const mcap::Channel& channel, const mcap::Message& message) {
            topics_[channel.topic].push_back({message.time_ns, std::string(message.data)});
        });
        std::ifstream csv(folder_ / "s.csv");
        std::string line, field;
        std::getline(csv, line);
        for (std::istringstream names(line); std::getline(names, field, ',');) names_.push_back(field);
        while (std::getline(csv, line)) {
            std::map<std::string, double>& row = rows_.emplace_back();
            std::istringstream fields(line);
            for (const std::string& name : names_)
                std::getline(fields, field, ','), row[name] = std::stod(field);
        }
    }
    static void expectSamePose(const Told& told, const std::map<std::string, double>& row,
                               const std::string& of) {
        const auto pose = told.as<foxglove::PoseInFrame>();
        ASSERT_EQ(pose.frame_id(), "W");
        const foxglove::Vector3& p = pose.pose().position();
        const foxglove::Quaternion& q = pose.pose().orientation();
        ASSERT_EQ(p.x(), row.at(of + "_px_m"));
        ASSERT_EQ(p.y(), row.at(of + "_py_m"));
        ASSERT_EQ(p.z(), row.at(of + "_pz_m"));
        ASSERT_EQ(q.w(), row.at(of + "_qw"));
        ASSERT_EQ(q.x(), row.at(of + "_qx"));
        ASSERT_EQ(q.y(), row.at(of + "_qy"));
        ASSERT_EQ(q.z(), row.at(of + "_qz"));
    }
    std::string logged() const {
        std::string all;
        for (const Told& told : topics_.at("/log")) all += told.as<foxglove::Log>().message() + '\n';
        return all;
    }
    using Points = std::multiset<std::array<double, 3>>;
    // The corners of all triangles (V, m) that the newest message of each node has: what a viewer shows at
    // the end.
    Points cornersShown() const {
        Points corners;
        for (const auto& [topic, all] : topics_) {
            if (!topic.starts_with("/bone/")) continue;
            const auto newest = all.back().as<foxglove::SceneUpdate>();
            EXPECT_EQ(newest.entities_size(), 1);
            EXPECT_EQ(newest.entities(0).frame_id(), "V");
            for (const auto& list : newest.entities(0).triangles())
                for (const uint32_t index : list.indices()) {
                    const foxglove::Point3& p = list.points(int(index));
                    const foxglove::Vector3& origin = list.pose().position();
                    corners.insert({origin.x() + p.x(), origin.y() + p.y(), origin.z() + p.z()});
                }
        }
        return corners;
    }
    static Points cornersOf(const BoneModel& bone) {
        Points corners;
        Mesher mesher(bone.volume, bone.lattice, MeshGrid::kStreamedStepsPerCell);
        mesher.pass([&](NodeMesh&& mesh) {
            for (const uint32_t index : mesh.indices) {
                const PackedVertex& v = mesh.vertices[index];
                const Eigen::Vector3f p = mesh.step.cwiseProduct(Eigen::Vector3f(v.x, v.y, v.z));
                const Eigen::Vector3d corner = mesh.origin.cast<double>() + p.cast<double>();
                corners.insert({corner.x(), corner.y(), corner.z()});
            }
        });
        return corners;
    }

    test::TemporaryFolder folder_;
    mcap::Reading reading_;
    std::map<std::string, std::vector<Told>> topics_;
    std::vector<std::string> names_;
    std::vector<std::map<std::string, double>> rows_;
};

TEST_F(FoxgloveExported, EveryNumberOfPoseAndWrenchIsThatOfTheCsv) {
    exported(test::recordSession(folder_.path()).journal);
    ASSERT_EQ(rows_.size(), 3000u);
    ASSERT_EQ(topics_["/tick"].size(), rows_.size());
    ASSERT_EQ(topics_["/tool/pose"].size(), rows_.size());
    ASSERT_EQ(topics_["/hand/pose"].size(), rows_.size());
    double largest = 0, removed = 0;
    for (size_t n = 0; n < rows_.size(); ++n) {
        const auto& row = rows_[n];
        expectSamePose(topics_["/tool/pose"][n], row, "spo");
        expectSamePose(topics_["/hand/pose"][n], row, "dev");
        const auto tick = topics_["/tick"][n].as<plots::Tick>();
        ASSERT_EQ(tick.t_s(), row.at("t_s"));
        ASSERT_EQ(tick.force_x_n(), row.at("fx_n")) << n;
        ASSERT_EQ(tick.force_y_n(), row.at("fy_n")) << n;
        ASSERT_EQ(tick.force_z_n(), row.at("fz_n")) << n;
        ASSERT_EQ(tick.torque_x_nm(), row.at("tx_nm")) << n;
        ASSERT_EQ(tick.torque_y_nm(), row.at("ty_nm")) << n;
        ASSERT_EQ(tick.torque_z_nm(), row.at("tz_nm")) << n;
        ASSERT_EQ(tick.contacts(), row.at("contacts"));
        ASSERT_EQ(tick.removed_mm3(), row.at("removed_mm3"));
        largest = std::max(largest, tick.force_n());
        removed += row.at("removed_mm3");
        ASSERT_EQ(tick.removed_sum_mm3(), removed);
    }
    EXPECT_GT(largest, 0.1);
    EXPECT_GT(removed, 0.1);
    for (const Told& told : topics_["/frames"]) {
        const auto frames = told.as<foxglove::FrameTransforms>();
        ASSERT_EQ(frames.transforms_size(), 4);
        const auto at = std::ranges::find(topics_["/tool/pose"], told.time_ns, &Told::time_ns);
        EXPECT_EQ(frames.transforms(1).child_frame_id(), "T");
        EXPECT_EQ(frames.transforms(1).translation().x(),
                  at->as<foxglove::PoseInFrame>().pose().position().x());
    }
    EXPECT_EQ(topics_["/frames"].size(), 300u);
}

TEST_F(FoxgloveExported, TimesAreTheJournalsAndGoForward) {
    const test::RecordedSession session = test::recordSession(folder_.path());
    exported(session.journal);
    std::map<std::string, std::vector<uint64_t>> of_journal;
    for (const auto& message : test::journalMessages(session.journal))
        if (message.topic == JournalTopic::kTool) of_journal["/tool"].push_back(message.time_ns);
    ASSERT_FALSE(of_journal["/tool"].empty());
    std::set<uint64_t> exported_ns;
    for (const Told& told : topics_["/tool/pose"]) exported_ns.insert(told.time_ns);
    for (const uint64_t time_ns : of_journal["/tool"]) EXPECT_TRUE(exported_ns.contains(time_ns)) << time_ns;
    for (const auto& [topic, all] : topics_)
        EXPECT_TRUE(std::ranges::is_sorted(all, {}, &Told::time_ns)) << topic;
}

TEST_F(FoxgloveExported, TheBoneAtTheEndIsTheSessions) {
    const test::RecordedSession session =
        test::recordSession(folder_.path(), {.ticks = 1000, .has_orders = false});
    exported(session.journal);
    const Recording recording(session.journal);
    const LoadedScene scene = recording.scene();
    const SceneSetup simulation = setUpScene(scene);
    const Recording::Bones bones = recording.readBones(*simulation.bone);
    const Points scanned = cornersOf(*simulation.bone);
    Rerun rerun(recording, simulation, bones.checkpoints, *simulation.bone, bones.keyframes.front());
    while (!rerun.isAtEnd()) rerun.step();
    const Points milled = cornersOf(*simulation.bone);
    ASSERT_NE(milled, scanned) << "nothing was milled";
    EXPECT_TRUE(cornersShown() == milled);
}

TEST_F(FoxgloveExported, TheBonesUpdatesKeepWithinTheirRate) {
    exported(test::recordSession(folder_.path()).journal);
    std::map<uint64_t, size_t> bytes;
    for (const auto& [topic, all] : topics_)
        if (topic.starts_with("/bone/"))
            for (const Told& told : all) bytes[told.time_ns] += told.data.size();
    EXPECT_GT(bytes.size(), 3u) << "it was milled, and put back";
    const uint64_t last_ns = topics_["/tick"].back().time_ns;
    uint64_t before_ns = 0;
    for (const auto& [time_ns, size] : bytes) {
        if (time_ns != last_ns) {
            EXPECT_GE(double(time_ns - before_ns), BoneTopics::kPeriod * 0.99e9)
                << "later " << size << " bytes";
        }
        before_ns = time_ns;
    }
}

TEST_F(FoxgloveExported, EventsCutsAndToolsAreTold) {
    exported(test::recordSession(folder_.path()).journal);
    EXPECT_NE(logged().find("select_tool 1"), std::string::npos) << logged();
    EXPECT_NE(logged().find("the session ends"), std::string::npos);
    EXPECT_EQ(topics_["/tool/shape"].size(), 2u) << "the tool was changed once";
    EXPECT_EQ(topics_["/tool/shape"][1].as<foxglove::SceneUpdate>().entities(0).metadata(0).value(), "small");
    double removed = 0, of_ticks = 0;
    uint64_t voxels = 0, voxels_of_ticks = 0;
    for (const Told& told : topics_["/cuts"]) {
        const auto cut = told.as<plots::Cut>();
        EXPECT_LE(cut.begin_s(), cut.end_s());
        removed += cut.removed_mm3(), voxels += cut.removed_voxels();
    }
    for (const auto& row : rows_)
        of_ticks += row.at("removed_mm3"), voxels_of_ticks += uint64_t(row.at("removed_voxels"));
    EXPECT_GT(topics_["/cuts"].size(), 1u);
    EXPECT_NEAR(removed, of_ticks, 1e-9 * of_ticks);
    EXPECT_EQ(voxels, voxels_of_ticks);
}

TEST_F(FoxgloveExported, OfWhatIfItSaysSo) {
    const test::RecordedSession session = test::recordSession(folder_.path(), {.ticks = 300});
    auto messages = test::journalMessages(session.journal);
    auto manifest = messages.front().as<journal::Manifest>();
    manifest.mutable_what_if()->set_change("the hand 0.5 mm beside");
    messages.front().data = manifest.SerializeAsString();
    test::writeJournal(folder_ / "other.mcap", messages, true);
    exported(folder_ / "other.mcap");
    EXPECT_NE(logged().find("nobody did this"), std::string::npos);
    EXPECT_NE(logged().find("the hand 0.5 mm beside"), std::string::npos);
}

TEST_F(FoxgloveExported, TheFileIsWholeAndItsLayoutNamesWhatIsInIt) {
    exported(test::recordSession(folder_.path(), {.ticks = 600}).journal);
    EXPECT_TRUE(reading_.is_whole) << reading_.problem;
    std::ifstream file(folder_ / "s.layout.json");
    const auto layout = nlohmann::json::parse(file);
    size_t bones = 0;
    for (const auto& [topic, shown] : layout.at("configById").at("3D!bone").at("topics").items()) {
        EXPECT_TRUE(topics_.contains(topic) || topic == "/structures" || topic == "/force") << topic;
        bones += topic.starts_with("/bone/") ? 1 : 0;
    }
    EXPECT_GT(bones, 0u);
    EXPECT_LE(bones, size_t(BoneTopics::kMostNodes));
    for (const char* const plot : {"Plot!force", "Plot!removed"})
        for (const auto& path : layout.at("configById").at(plot).at("paths")) {
            const std::string value = path.at("value");
            ASSERT_EQ(value.substr(0, 6), "/tick.");
            EXPECT_TRUE(plots::Tick::descriptor()->FindFieldByName(value.substr(6))) << value;
        }
}

TEST_F(FoxgloveExported, RefusesAnotherEnding) {
    const test::RecordedSession session = test::recordSession(folder_.path(), {.ticks = 300});
    EXPECT_THROW(exportJournal({.journal = session.journal,
                                .h5 = "",
                                .csv = "",
                                .traj = "",
                                .foxglove = folder_ / "s.foxglove"}),
                 UserError);
    EXPECT_THROW(
        exportJournal(
            {.journal = session.journal, .h5 = "", .csv = "", .traj = "", .foxglove = session.journal}),
        UserError);
}

}  // namespace
}  // namespace bonemill
