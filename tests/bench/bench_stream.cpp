#include <signal.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <sstream>
#include <thread>

#include "common/base/user_error.h"
#include "common/mesh_codec/mesh_codec.h"
#include "common/rt/clock.h"
#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/scans/import/import_volume.h"
#include "haptic_server/surface/mesh/mesher.h"
#include "render_client/link/subscribe/scene_subscriber.h"
#include "tests/bench/bench_commands.h"
#include "tests/bench/bench_output.h"
#include "tests/bench/leaf_cells.h"
#include "tests/bench/processor_time.h"
#include "tests/integration/dds/child_process.h"
#include "tests/support/dds_session.h"
#include "tests/support/places.h"
#include "tests/support/process.h"
#include "tests/support/whole_densities.h"

namespace bonemill::bench {
namespace {

using namespace std::chrono_literals;
using test::Process;

constexpr auto kSteady = 8s;  // over which the server's processor time is taken

struct StreamOptions {
    std::string volume, json, scene = test::sourceDir() + "/deploy/scenes/skull.textproto";
    double iso = 300;
    std::vector<int> viewers{1, 10, 30};
};

// The bone has three bands of density, as scenes tell soft, spongy and compact bone apart.
BoneProperties threeMaterials(const VoxelVolume& volume) {
    const int band = (kMaxDensity - volume.iso()) / 3 + 1;
    return {volume, [&](const Eigen::Vector3i& v) {
                const int above = int(volume.at(v.x(), v.y(), v.z())) - int(volume.iso());
                return above < 0 ? kNoMaterial : MaterialId(1 + above / band);
            }};
}

double bytesPerTriangle(const VoxelVolume& volume, const LeafLattice& lattice,
                        const BoneProperties& properties) {
    Mesher mesher(volume, lattice, MeshGrid::kStreamedStepsPerCell, {&properties});
    size_t nodes = 0, triangles = 0, bytes = 0;
    mesher.pass([&](NodeMesh&& mesh) {
        bytes += encodeNodeMesh(mesh, {.epoch = UINT64_MAX, .batch = nodes++}).bytes.size();
        triangles += mesh.indices.size() / 3;
    });
    return double(bytes) / double(triangles);
}

nlohmann::json wire(const StreamOptions& o, Table& table) {
    const VoxelVolume volume =
        densify(importVolume(o.volume), DensityWindow{.low = {}, .high = {}, .iso = o.iso});
    const LeafLattice lattice(volume, Eigen::Vector3i::Constant(kLeafCells));
    Mesher mesher(volume, lattice, MeshGrid::kStreamedStepsPerCell);
    size_t nodes = 0, triangles = 0, bytes = 0;
    LatencyHistogram encode, decode;
    mesher.pass([&](NodeMesh&& mesh) {
        const int64_t start_ns = monotonicNowNs();
        const EncodedNode encoded = encodeNodeMesh(mesh, {.epoch = UINT64_MAX, .batch = nodes});
        const int64_t encoded_ns = monotonicNowNs();
        decodeNodeMesh(encoded.bytes, mesh.leaf);
        decode.record(monotonicNowNs() - encoded_ns);
        encode.record(encoded_ns - start_ns);
        ++nodes;
        triangles += mesh.indices.size() / 3;
        bytes += encoded.bytes.size();
    });
    std::printf("%zu nodes, %zu triangles, %zu bytes: %.3f bytes per triangle\n", nodes, triangles, bytes,
                double(bytes) / double(triangles));
    const double with_materials = bytesPerTriangle(volume, lattice, threeMaterials(volume));
    std::printf("with three materials by density: %.3f bytes per triangle\n", with_materials);
    table.add({"encode a node"}, encode);
    table.add({"decode a node"}, decode);
    return {{"nodes", nodes},
            {"triangles", triangles},
            {"bytes", bytes},
            {"bytes_per_triangle", double(bytes) / double(triangles)},
            {"bytes_per_triangle_with_materials", with_materials},
            {"encode_us", microseconds(encode)},
            {"decode_us", microseconds(decode)}};
}

void replace(std::string& text, const std::string& what, const std::string& by) {
    const size_t at = text.find(what);
    if (at != std::string::npos) text.replace(at, what.size(), by);
}

// The scene has every piece of bone, and a hand that mills round and round for as long as wanted.
std::string millingScene(const std::string& scene, int seconds) {
    std::ifstream file(scene);
    std::ostringstream text;
    text << file.rdbuf();
    std::string whole = text.str();
    replace(whole, "smallest_piece_voxels: 30000", "smallest_piece_voxels: 0");
    const size_t begin = whole.find("simulated_operator"), end = whole.find("\n}\n", begin);
    if (begin == std::string::npos || end == std::string::npos)
        throw UserError(scene + ": no simulated_operator to replace");
    std::ostringstream path;
    path << "simulated_operator { hand_stiffness_n_per_m: 1500\n";
    for (int s = 0; s <= 2 * seconds; ++s) {
        const double angle = 0.9 * s, depth = std::min(16.0, 1.0 * s), radius = 3 + 0.1 * s;
        path << "  waypoint { time_s: " << 0.5 * s << " p_WT_mm { x: " << 200 - depth
             << " y: " << 154 + radius * std::cos(angle) << " z: " << 32 + radius * std::sin(angle)
             << " } q_WT { w: 0.70710678 z: -0.70710678 } remove: true }\n";
    }
    return whole.substr(0, begin) + path.str() + "}\n" + whole.substr(end + 3);
}

// It is a real server whose simulated hand mills all the time.
class Session {
  public:
    Session(const std::string& scene, const std::string& report)
        : report_(report),
          server_(arguments("haptic_server", scene,
                            {"--domain", std::to_string(testDomain()), "--report", report})),
          daemon_(arguments("device_daemon", scene, {"--device", "simulated", "--wait-seconds", "60"})) {
        SceneSubscriber watcher({.domain = testDomain(), .session = testSession()});
        while (!watcher.isComplete() || !watcher.toolState()) {
            if (!server_.isRunning() || !daemon_.isRunning())
                throw UserError("the session did not start: " + server_.errSoFar() + daemon_.errSoFar());
            watcher.waitForData(20ms);
            watcher.poll();
        }
    }
    int serverPid() const { return server_.pid(); }
    void stopMilling() { daemon_.signal(SIGTERM); }
    nlohmann::json finish() {
        server_.signal(SIGTERM);
        server_.wait();
        return nlohmann::json::parse(test::readFile(report_));
    }

  private:
    static std::vector<std::string> arguments(const std::string& program, const std::string& scene,
                                              const std::vector<std::string>& more) {
        std::vector<std::string> words{program, "--scene", scene, "--session", std::to_string(testSession())};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    std::string report_;
    Process server_, daemon_;
};

std::vector<double> numbersOf(const std::string& line) {
    std::istringstream words(line);
    std::vector<double> numbers;
    for (double number = 0; words >> number;) numbers.push_back(number);
    return numbers;
}

nlohmann::json live(const test::TemporaryFolder& folder, int viewers, Table& table) {
    Session session(folder / "scene.textproto", folder / "report.json");
    const double alone = shareOfACore(session.serverPid(), kSteady);
    std::vector<std::unique_ptr<ChildProcess>> readers;
    for (int n = 0; n < viewers; ++n) readers.push_back(std::make_unique<ChildProcess>("stream_reader"));
    std::this_thread::sleep_for(1s);  // they have started, and wait
    for (const auto& reader : readers) reader->tell("join");
    std::vector<double> joins;
    for (const auto& reader : readers) joins.push_back(numbersOf(reader->readLine()).at(0));
    std::sort(joins.begin(), joins.end());
    const double watched = shareOfACore(session.serverPid(), kSteady);

    session.stopMilling();
    std::this_thread::sleep_for(1s);
    std::vector<std::string> states;
    double reader_s = 0;
    for (const auto& reader : readers) {
        const std::string answer = reader->ask("state");
        states.push_back(answer.substr(0, answer.rfind(' ')));
        reader_s += numbersOf(answer).at(2);
    }
    const nlohmann::json report = session.finish();
    const uint64_t digest = std::stoull(report["published_digest"].get<std::string>(), nullptr, 16);
    const std::string published = report["published_nodes"].dump() + ' ' + std::to_string(digest);
    const bool agree =
        std::all_of(states.begin(), states.end(), [&](const std::string& s) { return s == published; });
    table.add({std::to_string(viewers), number(joins[joins.size() / 2]), number(joins.back()),
               number(100 * alone, 3), number(100 * watched, 3), number(report["removed_mm3"]),
               agree ? "yes" : "NO"});
    return {{"viewers", viewers},
            {"join_s", {{"p50", joins[joins.size() / 2]}, {"max", joins.back()}}},
            {"server_share_alone", alone},
            {"server_share", watched},
            {"reader_s_mean", reader_s / viewers},
            {"removed_mm3", report["removed_mm3"]},
            {"node_write_ms", report["node_write_ms"]},
            {"dropped_ticks", report["dropped_ticks"]},
            {"states_agree", agree}};
}

void run(const StreamOptions& o) {
    nlohmann::json json;
    if (!o.volume.empty()) {
        Table table({"us", "mean", "p50", "p99", "p99.9", "max"});
        json["wire"] = wire(o, table);
        table.print();
    }
    const int most = o.viewers.empty() ? 0 : *std::max_element(o.viewers.begin(), o.viewers.end());
    const test::TemporaryFolder folder;
    test::writeFile(folder / "scene.textproto", millingScene(o.scene, 60 + most));
    Table table({"viewers", "join, s p50", "max", "server alone, % of a core", "watched", "removed, mm3",
                 "states agree"});
    for (const int viewers : o.viewers) json["live"].push_back(live(folder, viewers, table));
    table.print();
    writeJson(o.json, json);
}

}  // namespace

void addStreamCommand(CLI::App& app) {
    auto o = std::make_shared<StreamOptions>();
    CLI::App* command = app.add_subcommand(
        "stream", "a bone's bytes on the wire, and a session that mills with viewers that join at once");
    command->add_option("--volume", o->volume, "of the bytes: any volume that a scene can name");
    command->add_option("--iso", o->iso, "bone surface, in the volume's values");
    command->add_option("--scene", o->scene, "of the session");
    command->add_option("--viewers", o->viewers, "one session for each of these numbers")->delimiter(',');
    addJsonOption(*command, o->json);
    command->callback([o] { run(*o); });
}

}  // namespace bonemill::bench
