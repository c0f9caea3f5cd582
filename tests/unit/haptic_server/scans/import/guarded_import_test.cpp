#include "haptic_server/scans/confined/guarded_import.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <functional>
#include <limits>
#include <thread>

#include "haptic_server/scans/confined/shared_name.h"
#include "haptic_server/scans/import/import_volume.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"

namespace bonemill {
namespace {

TEST(GuardedImport, volumeComesThroughUnchanged) {
    RawVolume sent;
    sent.geometry.dims = {100, 50, 40};
    sent.geometry.spacing = {0.1, 0.2, 0.3};
    sent.geometry.X_WV.position = {1, 2, 3};
    sent.geometry.X_WV.rotation = Eigen::Quaterniond(1, 2, 3, 4).normalized();
    sent.description = "a volume";
    sent.is_hounsfield = true;
    sent.values.append(std::vector<int16_t>(sent.geometry.voxelCount(), -7));
    const RawVolume got = importGuarded("file", [&] { return sent; });
    EXPECT_EQ(got.geometry.dims, sent.geometry.dims);
    EXPECT_EQ(got.geometry.spacing, sent.geometry.spacing);
    EXPECT_EQ(got.geometry.X_WV.position, sent.geometry.X_WV.position);
    EXPECT_EQ(got.geometry.X_WV.rotation.coeffs(), sent.geometry.X_WV.rotation.coeffs());
    EXPECT_EQ(got.description, sent.description);
    EXPECT_TRUE(got.is_hounsfield);
    EXPECT_EQ(got.values, sent.values);
}

// These are more samples than go through the pipe at a time, and of every type.
template <class T>
void expectSamplesComeThrough(float first) {
    std::vector<T> samples;
    for (int n = 0; n < 1500000; ++n) samples.push_back(T(first + float(n % 251)));
    RawVolume sent;
    sent.geometry.dims = {1500, 1000, 1};
    sent.values.append(samples);
    const RawVolume got = importGuarded("file", [&] { return sent; });
    EXPECT_EQ(got.values.type(), sent.values.type());
    EXPECT_EQ(got.values, sent.values);
}

TEST(GuardedImport, samplesOfEveryTypeComeThrough) {
    expectSamplesComeThrough<uint8_t>(0);
    expectSamplesComeThrough<int16_t>(-1000);
    expectSamplesComeThrough<uint16_t>(60000);
    expectSamplesComeThrough<float>(0.25);
}

TEST(GuardedImport, errorsComeThrough) {
    expectUserError([] { importGuarded("file", []() -> RawVolume { throw UserError("just so"); }); },
                    {"just so"});
    expectUserError([] { importGuarded("file", []() -> RawVolume { throw std::runtime_error("odd"); }); },
                    {"file", "odd"});
    expectUserError([] { importGuarded("file", []() -> RawVolume { throw std::bad_alloc(); }); },
                    {"file", "memory"});
}

// There are more samples than a pipe holds, so that the reader must be ended, too.
TEST(GuardedImport, whatDoesNotFitTogetherIsRefused) {
    using Dims = Eigen::Vector3i;
    for (const Dims& dims : {Dims(100, 100, 99), Dims(100, 100, 101), Dims(-100, -100, 100)}) {
        RawVolume sent;
        sent.geometry.dims = dims;
        sent.values.append(std::vector<int16_t>(1000000, -7));
        expectUserError([&] { importGuarded("file", [&] { return sent; }); }, {"file", "fit together"});
    }
    using Spoil = std::function<void(VolumeGeometry&)>;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Spoil& spoil :
         {Spoil([](VolumeGeometry& g) { g.spacing.y() = 0; }),
          Spoil([](VolumeGeometry& g) { g.spacing.z() = -1; }),
          Spoil([&](VolumeGeometry& g) { g.spacing.x() = nan; }),
          Spoil([&](VolumeGeometry& g) { g.X_WV.position.y() = nan; }),
          Spoil([](VolumeGeometry& g) { g.X_WV.position.y() = 1e30; }),
          Spoil([](VolumeGeometry& g) { g.X_WV.rotation.coeffs() *= 1.1; }),
          Spoil([&](VolumeGeometry& g) { g.X_WV.rotation.x() = nan; }), Spoil([](VolumeGeometry& g) {
              g.dims = {0, 0, 0};
          })}) {
        RawVolume sent;
        sent.geometry.dims = {100, 100, 100};
        sent.values.append(std::vector<int16_t>(1000000, -7));
        spoil(sent.geometry);
        if (sent.geometry.dims.x() == 0) sent.values = {};
        expectUserError([&] { importGuarded("file", [&] { return sent; }); }, {"file", "fit together"});
    }
    RawVolume talkative;
    talkative.description.assign(2 << 20, 'a');
    expectUserError([&] { importGuarded("file", [&] { return talkative; }); }, {"file", "fit together"});
}

// A reader that waits uses no processor time, so that no limit on that ends it.
TEST(GuardedImport, aReaderThatWaitsForEverIsEndedAndTheFileNamed) {
    const auto readAndWait = []() -> RawVolume {
        noteFileBeingRead("folder/slice7");
        for (;;) pause();
    };
    expectUserError([&] { importGuarded("folder", readAndWait, std::chrono::milliseconds(50)); },
                    {"folder/slice7", "within 0.05 s"});
}

RawVolume smallVolume() {
    RawVolume small;
    small.geometry.dims = {10, 10, 10};
    small.values.append(std::vector<int16_t>(1000, -7));
    return small;
}

TEST(GuardedImport, aReaderThatHasSaidAllIsNotWaitedFor) {
    const auto sayAllAndWait = [](int pipe, int) {
        const pid_t child = fork();
        if (child != 0) return child;
        if (fork() == 0) readAsChild(pipe, "file", smallVolume);
        for (;;) pause();
    };
    EXPECT_EQ(importFrom("file", sayAllAndWait).values, smallVolume().values);
}

// What the reader writes there may come from whoever took it over.
TEST(GuardedImport, theSharedNameCannotBeShrunkAndIsReadNoFurther) {
    const auto start = [](int, int name) {
        const pid_t child = fork();
        if (child != 0) return child;
        const bool is_shrunk = ftruncate(name, 0) == 0, is_grown = ftruncate(name, 1 << 20) == 0;
        const std::string text(4096, is_shrunk ? 's' : is_grown ? 'g' : 'n');
        if (pwrite(name, text.data(), text.size(), 0) < 0) _exit(1);
        _exit(0);
    };
    expectUserError([&] { importFrom("file", start); }, {std::string(4096, 'n') + ": the library"});
}

TEST(GuardedImport, whatTheReaderSaysStaysOneLine) {
    expectUserError(
        [] {
            importGuarded("file", []() -> RawVolume {
                throw UserError(
                    "one\ntwo\x1b[2J\xc2\x9b"
                    "2J\xc3\xa4");
            });
        },
        {"one two [2J  2J\xc3\xa4"});
    const auto readAndDie = []() -> RawVolume {
        noteFileBeingRead("folder/a\nb");
        std::abort();
    };
    expectUserError([&] { importGuarded("folder", readAndDie); }, {"folder/a b"});
}

TEST(GuardedImport, theReadersMemoryIsBounded) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers map terabytes themselves";
#endif
    const auto readGreedily = []() -> RawVolume {
        if (mmap(nullptr, size_t(1) << 44, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0) ==
            MAP_FAILED)
            throw std::bad_alloc();
        throw UserError("there is no bound");
    };
    expectUserError([&] { importGuarded("file", readGreedily); }, {"file", "not enough memory"});
}

TEST(GuardedImport, deathOfTheReaderNamesTheFileItWasAt) {
    expectUserError([] { importGuarded("folder", []() -> RawVolume { std::abort(); }); },
                    {"folder", "library", "failed on it", "export it anew"});
    const auto readAndDie = []() -> RawVolume {
        noteFileBeingRead("folder/slice7");
        std::abort();
    };
    expectUserError([&] { importGuarded("folder", readAndDie); }, {"folder/slice7", "damaged"});
    expectUserError([] { importGuarded("file", []() -> RawVolume { _exit(0); }); }, {"file", "ended early"});
}

// As the kernel does where a control group may take no more.
TEST(GuardedImport, aReaderThatIsKilledForItsMemoryIsNotCalledDamaged) {
    const auto beKilled = []() -> RawVolume {
        noteFileBeingRead("folder/slice7");
        syscall(SYS_tgkill, getpid(), gettid(), SIGKILL);
        return {};
    };
    try {
        importGuarded("folder", beKilled);
        ADD_FAILURE() << "no UserError";
    } catch (const UserError& error) {
        const std::string message = error.what();
        for (const char* word :
             {"folder/slice7", "killed from outside", "limit of memory", "MiB of memory are free"})
            EXPECT_NE(message.find(word), std::string::npos) << word << " in: " << message;
        EXPECT_EQ(message.find("damaged"), std::string::npos) << message;
    }
}

// The other thread has noted its file later.
TEST(GuardedImport, deathOfAThreadNamesTheFileThatTheThreadWasAt) {
    for (const bool is_out_of_stack : {false, true}) {
        const auto readBesideAndDie = [=]() -> RawVolume {
            noteFileBeingRead("folder/slice7");
            std::thread([] { noteFileBeingRead("folder/slice8"); }).join();
            if (!is_out_of_stack) std::abort();
            const std::function<int(int)> goDeeper = [&](int n) { return n < 0 ? n : goDeeper(n + 1) + 1; };
            throw UserError(std::to_string(goDeeper(0)));
        };
        expectUserError([&] { importGuarded("folder", readBesideAndDie); }, {"folder/slice7", "damaged"});
    }
}

TEST(GuardedImport, aReaderProgramThatDoesNotReadIsToldOf) {
    setReaderProgram("/bin/false");
    expectUserError([] { importVolume("folder/a.nrrd"); }, {"folder/a.nrrd", "ended early"});
    setReaderProgram("/nowhere/reader");
    expectUserError([] { importVolume("folder/a.nrrd"); }, {"folder/a.nrrd", "cannot start"});
    setReaderProgram("");  // importVolume() reads itself again
    expectUserError([] { importVolume("folder/a.nrrd"); }, {"folder/a.nrrd", "no such file"});
}

}  // namespace
}  // namespace bonemill
