// How long a teacher waits for a large scan, and what memory it takes: import, region, mesh, first tick.
//
//   cmake --build --preset release --target scan_bench haptic_server device_daemon
//   build/release/bin/scan_bench            # makes the data once, 3 GB in build/scan_data; then all cases
//   build/release/bin/scan_bench --only head640 --runs 5
//
// Each case runs in processes of its own. Seconds are the best of --runs by the clock, beside it the
// processor's of that run, of all its processes; the peak is of all of them together. The digest is of the
// values or densities: it is the same before and after a change that must not change them.
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <functional>
#include <sstream>

#include "common/base/user_error.h"
#include "common/cli/command_line.h"
#include "common/config/scene_file.h"
#include "common/log/log.h"
#include "common/process/run_program.h"
#include "common/rt/clock.h"
#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/scans/dicom/dicom_headers.h"
#include "haptic_server/scans/import/import_volume.h"
#include "haptic_server/scene/setup/scanned_bone.h"
#include "haptic_server/surface/mesh/mesher.h"
#include "haptic_server/surface/mesh/surroundings_mesher.h"
#include "tests/bench/bench_output.h"
#include "tests/bench/big_scans.h"
#include "tests/bench/leaf_cells.h"
#include "tests/bench/memory_watch.h"
#include "tests/bench/processor_time.h"
#include "tests/support/process.h"

namespace bonemill::bench {
namespace {

namespace fs = std::filesystem;

// ---- One stage, in a process of its own: it prints "seconds", "processor", "digest" and what more it knows.

double processorSecondsOf(int who) {
    rusage used{};
    getrusage(who, &used);
    return double(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * double(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

template <class T>
uint64_t digestOf(std::span<const T> numbers, uint64_t digest = 14695981039346656037u) {
    for (const T number : numbers)
        digest = (digest ^ uint64_t(int64_t(double(number) * 256))) * 1099511628211u;
    return digest;
}

uint64_t digestOf(const RawValues& values) {
    return values.visit([](auto samples) { return digestOf(samples); });
}

uint64_t digestOf(const VoxelVolume& volume) {
    uint64_t digest = 14695981039346656037u;
    for (BrickId brick = 0; brick < volume.bricks().brickCount(); ++brick)
        digest = digestOf(std::span(volume.bricks().contents(brick), kBrickSize), digest);
    return digest;
}

class Stopwatch {
  public:
    double lap() {
        const int64_t now = monotonicNowNs();
        return secondsOfNs(now - std::exchange(start_ns_, now));
    }

  private:
    int64_t start_ns_ = monotonicNowNs();
};

// Of this process and those that it waited for.
double processorSecondsSoFar() {
    return processorSecondsOf(RUSAGE_SELF) + processorSecondsOf(RUSAGE_CHILDREN);
}

void print(double seconds, double processor, uint64_t digest, const std::string& more = "-") {
    std::printf("%.3f %.3f %016llx %s\n", seconds, processor, (unsigned long long)digest, more.c_str());
}

void stageHeaders(const std::string& path) {
    Stopwatch watch;
    LeftOut left_out;
    size_t slices = 0;
    for (const auto& file : filesOf(path, Subfolders::kYes, left_out))
        slices += slicesOfFile(file, left_out).size();
    print(watch.lap(), processorSecondsSoFar(), slices);
}

void stageImport(const std::string& path, bool is_here) {
    Stopwatch watch;
    const RawVolume raw = is_here ? importVolumeHere(path) : importVolume(path);
    const double seconds = watch.lap(), processor = processorSecondsSoFar();
    print(seconds, processor, digestOf(raw.values));
}

void stageBone(const std::string& scene) {
    Stopwatch watch;
    ScannedBone bone = readBone(loadScene(scene));
    const double read = watch.lap(), processor = processorSecondsSoFar();
    const uint64_t digest = digestOf(bone.volume);
    watch.lap();
    const BoneModel model(std::move(bone.volume), Eigen::Vector3i::Constant(kLeafCells), {});
    const double built = watch.lap();
    size_t triangles = 0, around = 0;
    Mesher(model.volume, model.lattice).pass([&](NodeMesh&& mesh) { triangles += mesh.indices.size() / 3; });
    const double meshed = watch.lap();
    if (bone.surroundings)
        meshSurroundings(*bone.surroundings, 0, {}, [&](NodeMesh&& mesh) {
            around += mesh.indices.size() / 3;
            return true;
        });
    std::ostringstream more;
    more << "tree and shell " << number(built, 3) << " s; mesh " << number(meshed, 3) << " s, " << triangles
         << " triangles; around " << number(watch.lap(), 3) << " s, " << around;
    if (bone.surroundings) more << ", digest " << std::hex << digestOf(bone.surroundings->volume);
    print(read, processor, digest, more.str());
}

// ---- The cases.

struct Options {
    std::string data = "build/scan_data", only;
    int runs = 2;
};

struct Measured {
    double seconds = 0, processor = 0;
    size_t peak_bytes = 0;
    std::string digest, more;
};

Measured runStage(const std::string& stage, const std::string& path) {
    test::Process process({"/proc/self/exe", "stage", stage, path});
    const MemoryWatch memory(process.pid());
    const test::Finished finished = process.wait(std::chrono::seconds(300));
    if (finished.exit_code != 0) throw UserError(stage + " " + path + ": " + finished.err);
    Measured measured;
    std::istringstream words(finished.out);
    words >> measured.seconds >> measured.processor >> measured.digest;
    std::getline(words >> std::ws, measured.more);
    measured.peak_bytes = memory.peakBytes();
    return measured;
}

// The server with its scripted hand, as a session has it: until the first tick, and with all meshes made.
Measured runLive(const std::string& scene) {
    const std::string session = std::to_string(1000 + getpid() % 1000), domain = "199";
    Stopwatch watch;
    test::Process server({"haptic_server", "--scene", scene, "--session", session, "--domain", domain,
                          "--no-recording", "--seconds", "20"});
    const MemoryWatch memory(server.pid());
    test::Process daemon({"device_daemon", "--scene", scene, "--device", "simulated", "--session", session,
                          "--domain", domain, "--hold"});
    const auto says = [&](const std::string& words) {
        return server.errSoFar().find(words) != std::string::npos;
    };
    const auto waitFor = [&](const std::string& words) {
        test::waitFor([&] { return !server.isRunning() || says(words); }, std::chrono::seconds(240));
        if (!says(words)) throw UserError(scene + ": no first tick: " + server.errSoFar());
        return watch.lap();
    };
    Measured measured;
    measured.seconds = waitFor("the loop runs");
    measured.processor = processorSeconds(server.pid());
    measured.more = "peak " + number(double(memory.peakBytes() >> 20), 6) + " MiB until then";
    measured.more +=
        "; all around is shown " + number(waitFor("the bone around the region is shown"), 3) + " s later";
    measured.digest = "-";
    measured.peak_bytes = memory.peakBytes();
    return measured;
}

struct Case {
    std::string name, scan;
    double samples_mib;  // what its samples take
    std::function<void(const fs::path&)> make;
    std::string region;  // of its scene; empty: import only
};

std::vector<Case> cases(const fs::path& data) {
    const auto head = [](int slices) { return [=](const fs::path& to) { makeHead(to, slices); }; };
    const auto packed = [data](Packing packing) {
        return [=](const fs::path& to) { packSeries(data / "head140", to, packing); };
    };
    const auto micro = [](const fs::path& to) { makeMicro(to.parent_path(), 1024); };
    const std::string mastoid =
        "min_mm { x: 15 y: -22 z: 27 } max_mm { x: 94.85 y: 57.85 z: 106.85 } resample_mm: 0.2";
    const std::string core = "min_mm { x: 40 y: 40 z: 72 } max_mm { x: 60 y: 60 z: 92 } resample_mm: 0.05";
    return {{"head140", "head140", 70, head(140), ""},
            {"head140, RLE", "head140_rle", 70, packed(Packing::kRle), ""},
            {"head140, JPEG lossless", "head140_jpeg", 70, packed(Packing::kJpegLossless), ""},
            {"head140, JPEG 2000", "head140_j2k", 70, packed(Packing::kJpeg2000), ""},
            {"head640", "head640", 320, head(640), ""},
            {"head700", "head700", 350, head(700), mastoid},
            {"micro1024, NRRD", "micro.nhdr", 2048, micro, core},
            {"micro1024, MetaImage", "micro.mhd", 2048, micro, ""}};
}

fs::path makeScene(const fs::path& data, const Case& of) {
    const fs::path scene = data / (of.scan + ".textproto");
    std::ofstream(scene)
        << "name: 'scan_bench'\nvolume { path: '" << of.scan << "' region { " << of.region << " } }\n"
        << "tool { shape { sphere { radius_mm: 1.5 } } burr_radius_mm: 1.5 }\n"
           "device { p_WD_mm { x: 300 y: 300 z: 300 } q_WD { w: 1 } }\n"
           "simulated_operator { waypoint { time_s: 0 p_WT_mm { x: 300 y: 300 z: 300 } q_WT { w: 1 } }"
           " waypoint { time_s: 60 p_WT_mm { x: 300 y: 301 z: 300 } q_WT { w: 1 } } }\n";
    return scene;
}

class Report {
  public:
    explicit Report(const Options& options) : options_(options) {
        std::printf(
            "| scan | stage | s | processor s | peak MiB | of samples | digest | |\n"
            "|---|---|--:|--:|--:|--:|---|---|\n");
    }
    void row(const Case& of, const std::string& stage, const std::function<Measured()>& run) const {
        Measured best;
        for (int n = 0; n < options_.runs; ++n) {
            Measured now = run();
            now.peak_bytes = std::max(now.peak_bytes, best.peak_bytes);
            if (n == 0 || now.seconds < best.seconds) best = now;
            best.peak_bytes = now.peak_bytes;
        }
        const double mib = double(best.peak_bytes) / (1 << 20);
        std::printf("| %s | %s | %.2f | %.2f | %.0f | %.2f | %s | %s |\n", of.name.c_str(), stage.c_str(),
                    best.seconds, best.processor, mib, mib / of.samples_mib, best.digest.c_str(),
                    best.more.c_str());
        std::fflush(stdout);
    }

  private:
    const Options& options_;
};

void measure(const Options& options) {
    const fs::path data = options.data;
    fs::create_directories(data);
    const Report report(options);
    for (const Case& of : cases(data)) {
        if (of.name.find(options.only) == std::string::npos) continue;
        const fs::path scan = data / of.scan;
        if (!fs::exists(scan)) of.make(scan);
        if (fs::is_directory(scan) && of.region.empty())
            report.row(of, "headers", [&] { return runStage("headers", scan); });
        if (fs::is_directory(scan) && of.region.empty())
            report.row(of, "headers and voxels, one process", [&] { return runStage("here", scan); });
        report.row(of, "import", [&] { return runStage("import", scan); });
        if (of.region.empty()) continue;
        const std::string scene = makeScene(data, of);
        report.row(of, "bone of the scene", [&] { return runStage("bone", scene); });
        report.row(of, "server: first tick", [&] { return runLive(scene); });
    }
}

void runStageOf(const std::string& stage, const std::string& path) {
    if (stage == "headers") return stageHeaders(path);
    if (stage == "bone") return stageBone(path);
    stageImport(path, stage == "here");
}

int run(int argc, char** argv) {
    runReaderIfCalled(argc, argv);
    setReaderProgram("/proc/self/exe");
    setUpLog("scan_bench", "info");  // to stderr: stdout has the figures
    Options options;
    std::vector<std::string> stage;
    CLI::App app("Time and memory that large scans take until the first tick", "scan_bench");
    app.add_option("--data", options.data, "folder for the scans, made if they are not there")
        ->capture_default_str();
    app.add_option("--only", options.only, "cases with this in their name");
    app.add_option("--runs", options.runs, "the best of so many counts")->capture_default_str();
    CLI::App* const one = app.add_subcommand("stage", "one stage, for this program itself");
    one->add_option("words", stage)->expected(2);
    if (!parseCommandLine(app, argc, argv, "scan_bench")) return 0;
    if (one->parsed())
        runStageOf(stage[0], stage[1]);
    else
        measure(options);
    return 0;
}

}  // namespace
}  // namespace bonemill::bench

int main(int argc, char** argv) {
    return bonemill::runProgram([&] { return bonemill::bench::run(argc, argv); });
}
