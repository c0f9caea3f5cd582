// Scans that come in an archive are read as if they were unpacked; what could do harm is refused in one line.
#include <gtest/gtest.h>
#include <sys/file.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "haptic_server/scans/archive/unpack_archive.h"
#include "haptic_server/scans/archive/unpacked_scan.h"
#include "haptic_server/scans/import/import_volume.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/scans/import/archive_files.h"
#include "tests/unit/haptic_server/scans/import/dicom_bytes.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

constexpr const char* kKinds[] = {".zip", ".tar", ".tar.gz", ".tgz", ".tar.xz"};

class Archives : public testing::Test {
  protected:
    Archives() {
        fs::create_directory(folder_.path() / "tmp");
        setenv("TMPDIR", (folder_ / "tmp").c_str(), 1);
    }
    ~Archives() override { unsetenv("TMPDIR"); }

    std::string nrrd() {
        writeNrrdFile(folder_ / "plain.nrrd", sample_, {});
        return readBytes(folder_ / "plain.nrrd");
    }
    std::vector<PackedFile> slices(const std::string& where) {
        std::vector<PackedFile> files;
        for (int k = 0; k < 3; ++k) {
            DicomImage image;
            image.position = "0\\0\\" + std::to_string(k);
            image.pixels.assign(20, int16_t(k * 100));
            writeDicomFile(folder_ / "slice", image);
            files.push_back({where + "IM" + std::to_string(k), readBytes(folder_ / "slice")});
        }
        return files;
    }
    // Nothing is left of what was unpacked.
    void expectClean() const { EXPECT_TRUE(fs::is_empty(folder_.path() / "tmp")); }
    void expectRefused(const std::string& name, std::initializer_list<std::string> words) {
        SCOPED_TRACE(name);
        expectUserError([&] { importVolume(folder_ / name); }, words);
        expectClean();
    }
    void unpack(const std::string& name, const ArchiveLimits& limits) {
        fs::create_directory(folder_.path() / "out");
        const fs::path path = folder_ / name;
        unpackArchive(path, folder_ / "out", forkOf([=](int pipe) { sendArchiveAsChild(pipe, path); }),
                      limits);
    }

    test::TemporaryFolder folder_;
    const SampleVolume sample_;
};

TEST_F(Archives, OfOneVolumeAreReadWhateverTheirKind) {
    for (const char* const kind : kKinds) {
        SCOPED_TRACE(kind);
        const std::string path = folder_ / (std::string("a") + kind);
        writeArchive(path, {{"readme.txt", "x"},
                            {"scan/ct.nrrd", nrrd()},
                            {"__MACOSX/scan/._ct.nrrd", "x"},
                            {"scan/.hidden.nrrd", "x"}});
        EXPECT_NO_THROW(expectSamePlaces(importVolume(path), sample_));
        expectClean();
    }
}

TEST_F(Archives, OfADicomFolderAreReadAndListed) {
    writeArchive(folder_ / "disc.zip", slices("case 1/series/"));
    EXPECT_EQ(importVolume(folder_ / "disc.zip").geometry.dims.z(), 3);
    EXPECT_GE(listSeries(folder_ / "disc.zip").size(), 2u);
    expectClean();
    fs::rename(folder_.path() / "disc.zip", folder_.path() / "a zip of another name");
    EXPECT_EQ(importVolume(folder_ / "a zip of another name").geometry.dims.z(), 3);
}

TEST_F(Archives, NameTheirFilesAsPeopleKnowThem) {
    const std::string bytes = nrrd();
    writeArchive(folder_ / "a.zip", {{"scan/ct.nrrd", bytes.substr(0, bytes.size() - 20)}});
    expectRefused("a.zip", {(folder_ / "a.zip") + ": scan/ct.nrrd: "});
    writeArchive(folder_ / "b.zip", {{"x.nrrd", "x"}, {"y.nii", "x"}});
    expectRefused("b.zip", {"b.zip: holds 2 volumes (x.nrrd, y.nii)"});
    writeArchive(folder_ / "c.zip", {{"x.txt", "x"}});
    expectRefused("c.zip", {"c.zip: "});
    writeArchive(folder_ / "d.tar", {});
    expectRefused("d.tar", {"d.tar: holds no files"});
    expectRefused("gone.zip", {"gone.zip", "no such file"});
}

TEST_F(Archives, ThatLeadOutAreRefused) {
    for (const char* const kind : {".zip", ".tar"})
        for (const char* const name : {"../out.nrrd", "a/../../out.nrrd", "/tmp/out.nrrd", "a/.."}) {
            SCOPED_TRACE(name);
            writeArchive(folder_ / (std::string("a") + kind), {{name, "x"}});
            expectRefused(std::string("a") + kind, {"leads out of its folder", name});
        }
    EXPECT_FALSE(fs::exists(folder_.path() / "out.nrrd"));
}

TEST_F(Archives, OfLinksAreRefused) {
    for (const char* const kind : {".zip", ".tar.gz"}) {
        writeArchive(folder_ / (std::string("a") + kind), {{"ct.nrrd", "", "/etc/passwd"}});
        expectRefused(std::string("a") + kind, {"links and devices (ct.nrrd)"});
    }
    writeArchive(folder_ / "a.tar", {{"ct.nrrd", "", "/etc/passwd", true}});
    expectRefused("a.tar", {"links and devices (ct.nrrd)"});
}

TEST_F(Archives, WithOneNameTwiceAreRefused) {
    writeArchive(folder_ / "a.zip", {{"ct.nrrd", nrrd()}, {"./ct.nrrd", "x"}});
    expectRefused("a.zip", {"two files of one name (./ct.nrrd)"});
    writeArchive(folder_ / "b.tar", {{"ct", "x"}, {"ct/ct.nrrd", "x"}});
    expectRefused("b.tar", {"two files of one name"});
}

TEST_F(Archives, ThatAreEncryptedSaySo) {
    writeArchive(folder_ / "a.zip", {{"ct.nrrd", nrrd()}}, "secret");
    expectRefused("a.zip", {"is encrypted", "password"});
}

TEST_F(Archives, CutShortAnywhereAreRefused) {
    for (const char* const kind : {".zip", ".tar.gz", ".tar.xz"}) {
        const std::string name = std::string("a") + kind;
        writeArchive(folder_ / name, {{"one.txt", "x"}, {"ct.nrrd", nrrd()}});
        const std::string whole = readBytes(folder_ / name);
        // What follows the files of a zip is their list once more.
        const size_t end = std::min(whole.find("PK\1\2"), whole.size() - 1);
        for (size_t length = 0; length < end; length += end / 12) {
            SCOPED_TRACE(length);
            writeBytes(folder_ / name, whole.substr(0, length));
            expectRefused(name, {name});
        }
    }
}

TEST_F(Archives, OfMoreThanTheLimitsAreRefused) {
    const std::string zeros(3 << 20, '\0');
    writeArchive(folder_ / "bomb.zip", {{"a.raw", zeros}, {"b.raw", zeros}});
    ASSERT_LT(fs::file_size(folder_.path() / "bomb.zip"), 20'000u);
    expectUserError([&] { unpack("bomb.zip", {.files = 10, .bytes = 5 << 20}); },
                    {"bomb.zip: unpacks to more than", "GiB"});
    fs::remove_all(folder_.path() / "out");
    EXPECT_NO_THROW(unpack("bomb.zip", {.files = 2, .bytes = 6 << 20}));
    fs::remove_all(folder_.path() / "out");
    expectUserError([&] { unpack("bomb.zip", {.files = 1, .bytes = 6 << 20}); }, {"more than 1 files"});
}

// A process was killed while it read; another one still reads.
TEST_F(Archives, LeaveNothingBehindForLong) {
    const fs::path dead = folder_.path() / "tmp/bonemill_scan_dead",
                   alive = folder_.path() / "tmp/bonemill_scan_live";
    for (const fs::path& left : {dead, alive}) {
        fs::create_directory(left);
        std::ofstream(left / "ct.nrrd") << "x";
        fs::last_write_time(left, fs::file_time_type::clock::now() - std::chrono::hours(1));
    }
    const int lock = open(alive.c_str(), O_RDONLY | O_DIRECTORY);
    ASSERT_EQ(flock(lock, LOCK_EX), 0);
    const PassingFolder folder;
    EXPECT_FALSE(fs::exists(dead));
    EXPECT_TRUE(fs::exists(alive));
    EXPECT_EQ(fs::status(folder.path()).permissions(), fs::perms::owner_all);
    close(lock);
}

}  // namespace
}  // namespace bonemill
