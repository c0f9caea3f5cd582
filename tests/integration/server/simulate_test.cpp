// Runs `haptic_server simulate` from outside, as someone who checks our physics would use it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/base/units.h"
#include "haptic_server/core/kernels/kernels.h"
#include "haptic_server/scans/import/import_volume.h"
#include "haptic_server/scene/setup/scene_setup.h"
#include "tests/support/ply_reader.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using test::run;
using test::TemporaryFolder;
using test::writeFile;

// The tool's +y lies along W's +z, so that the shaft stands upright.
const char* const kUpright = "0.70710678118654757,0.70710678118654757,0,0";

// The device goes straight down from z_from to z_to in `ticks`, then rests for `dwell` ticks.
std::string plunge(double x, double y, double z_from, double z_to, int ticks, int dwell, int buttons) {
    std::ostringstream csv;
    csv.precision(17);
    csv << "t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons\n";
    for (int n = 0; n < ticks + dwell; ++n) {
        const double z = z_from + (z_to - z_from) * std::min(1.0, double(n) / (ticks - 1));
        csv << n * kMillisecond << ',' << x << ',' << y << ',' << z << ',' << kUpright << ',' << buttons
            << '\n';
    }
    return csv.str();
}

nlohmann::json simulateOnce(const std::vector<std::string>& arguments) {
    const auto finished = run(arguments);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    std::string last_line;
    std::istringstream lines(finished.out);
    for (std::string line; std::getline(lines, line);) last_line = line;
    return nlohmann::json::parse(last_line);
}

std::vector<std::vector<double>> readCsv(const std::string& path, std::string& header) {
    std::ifstream file(path);
    std::getline(file, header);
    std::vector<std::vector<double>> rows;
    for (std::string line; std::getline(file, line);) {
        std::vector<double> row;
        std::istringstream cells(line);
        for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
        rows.push_back(row);
    }
    return rows;
}

TEST(Simulate, TwoRunsGiveTheSameHashAndAnotherPathAnotherOne) {
    const TemporaryFolder folder;
    ASSERT_EQ(run({"make_phantom", "body", "--kind", "slab", "--out", folder / "slab.nrrd"}).exit_code, 0);
    writeFile(folder / "s.textproto", "effects { time_removal {} } volume { path: \"slab.nrrd\" }");
    // The slab fills |z| < 2 mm.
    writeFile(folder / "a.csv", plunge(0.03e-3, -0.08e-3, 3.3e-3, 0.1e-3, 800, 100, 1));
    writeFile(folder / "b.csv", plunge(0.03e-3, -0.07e-3, 3.3e-3, 0.1e-3, 800, 100, 1));
    const auto go = [&](const char* trajectory) {
        return simulateOnce({"haptic_server", "simulate", "--scene", folder / "s.textproto", "--trajectory",
                             folder / trajectory});
    };
    const auto first = go("a.csv"), second = go("a.csv"), other = go("b.csv");
    EXPECT_EQ(first["state_hash"], second["state_hash"]);
    EXPECT_NE(first["state_hash"], other["state_hash"]);
    EXPECT_GT(first["removed_voxels"].get<double>(), 100);
    EXPECT_TRUE(first["mesh"]["is_closed"]);
    EXPECT_EQ(first["ticks"].get<double>(), 900);
}

TEST(Simulate, MillsWithTheToolThatIsAskedFor) {
    const TemporaryFolder folder;
    ASSERT_EQ(run({"make_phantom", "body", "--kind", "slab", "--out", folder / "slab.nrrd"}).exit_code, 0);
    writeFile(folder / "s.textproto",
              "effects { time_removal {} } volume { path: \"slab.nrrd\" }\ntool { }\n"
              "tool { name: \"fine\" burr_radius_mm: 0.5 sdf_spacing_mm: 0.0625 }");
    writeFile(folder / "fine.textproto",
              "effects { time_removal {} } volume { path: \"slab.nrrd\" }\n"
              "tool { name: \"fine\" burr_radius_mm: 0.5 sdf_spacing_mm: 0.0625 }");
    writeFile(folder / "a.csv", plunge(0.03e-3, -0.08e-3, 3.3e-3, 0.1e-3, 800, 100, 1));
    const auto go = [&](const std::string& scene, const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"haptic_server", "simulate",     "--scene",
                                           folder / scene,  "--trajectory", folder / "a.csv"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    };
    const auto first = simulateOnce(go("s.textproto", {})), alone = simulateOnce(go("fine.textproto", {})),
               fine = simulateOnce(go("s.textproto", {"--tool", "fine"}));
    EXPECT_EQ(first["tool"], "tool 1");
    EXPECT_EQ(fine["tool"], "fine");
    EXPECT_LT(fine["removed_mm3"].get<double>(), first["removed_mm3"].get<double>());
    EXPECT_EQ(fine["state_hash"], alone["state_hash"]);
    EXPECT_EQ(simulateOnce(go("s.textproto", {"--tool", "2"}))["state_hash"], alone["state_hash"]);
    const auto refused = run(go("s.textproto", {"--tool", "drill"}));
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find("tool 1, fine"), std::string::npos) << refused.err;
}

// A recorded session can be checked on another PC.
TEST(Simulate, TheHashDoesNotDependOnTheCpusInstructionSet) {
    const TemporaryFolder folder;
    ASSERT_EQ(run({"make_phantom", "body", "--kind", "slab", "--out", folder / "slab.nrrd"}).exit_code, 0);
    writeFile(folder / "s.textproto", "effects { time_removal {} } volume { path: \"slab.nrrd\" }");
    writeFile(folder / "a.csv", plunge(0.03e-3, -0.08e-3, 3.3e-3, 0.1e-3, 800, 100, 1));
    std::vector<std::string> hashes;
    for (const CpuLevel level : kCpuLevels) {
        ASSERT_EQ(setenv("BONEMILL_CPU_LEVEL", cpuLevelName(level), 1), 0);
        hashes.push_back(simulateOnce({"haptic_server", "simulate", "--scene", folder / "s.textproto",
                                       "--trajectory", folder / "a.csv"})["state_hash"]);
    }
    unsetenv("BONEMILL_CPU_LEVEL");
    for (const std::string& hash : hashes) EXPECT_EQ(hash, hashes.front());
}

TEST(Simulate, AnInstructionSetThatNobodyKnowsIsSaid) {
    ASSERT_EQ(setenv("BONEMILL_CPU_LEVEL", "avx513", 1), 0);
    const auto finished = run({"haptic_server", "--version"});
    unsetenv("BONEMILL_CPU_LEVEL");
    EXPECT_EQ(finished.exit_code, 0);
    EXPECT_NE(finished.err.find("there is no 'avx513'; give x86-64, avx2 or avx512"), std::string::npos)
        << finished.err;
}

// Returns what `simulate` says of a scene, on the trajectory a.csv of the folder.
std::string warningsOf(const TemporaryFolder& folder, const std::string& scene) {
    writeFile(folder / "s.textproto", scene);
    const auto finished = run(
        {"haptic_server", "simulate", "--scene", folder / "s.textproto", "--trajectory", folder / "a.csv"});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return finished.err;
}

TEST(Simulate, WarnsOfATipThatTheCouplingPushesThroughAWall) {
    const TemporaryFolder folder;
    ASSERT_EQ(run({"make_phantom", "body", "--kind", "slab", "--out", folder / "slab.nrrd"}).exit_code, 0);
    writeFile(folder / "a.csv", plunge(0, 0, 3.3e-3, 3.2e-3, 10, 0, 0));
    const auto warnings = [&](const std::string& pin_radius_mm) {
        return warningsOf(
            folder,
            "effects { time_removal {} } volume { path: \"slab.nrrd\" } tool { shape { capsule { "
            "from_mm { y: 0 } "
            "to_mm { y: 8 } radius_mm: " +
                pin_radius_mm + " } } }");
    };
    EXPECT_NE(warnings("0.1").find("the tool's thinnest part has a radius of 0.1 mm"), std::string::npos);
    EXPECT_EQ(warnings("0.6").find("thinnest part"), std::string::npos);
}

TEST(Simulate, WarnsOfABurrThatTouchesMorePointsThanATickHasTimeFor) {
    const TemporaryFolder folder;
    ASSERT_EQ(run({"make_phantom", "body", "--kind", "slab", "--out", folder / "slab.nrrd"}).exit_code, 0);
    writeFile(folder / "a.csv", plunge(0, 0, 20e-3, 20e-3, 2, 0, 0));
    const auto warnings = [&](const std::string& length_mm) {
        return warningsOf(folder,
                          "volume { path: \"slab.nrrd\" } tool { burr_kind: CYLINDER burr_radius_mm: 4 "
                          "sdf_spacing_mm: 0.5 burr_length_mm: " +
                              length_mm + " }");
    };
    EXPECT_NE(warnings("30").find("coarser ones will be felt"), std::string::npos);
    EXPECT_EQ(warnings("2").find("coarser ones will be felt"), std::string::npos);
}

TEST(Simulate, WarnsOfVoxelsTooCoarseForABurrThatRemovesByTime) {
    const TemporaryFolder folder;
    ASSERT_EQ(run({"make_phantom", "body", "--kind", "slab", "--voxel-mm", "0.25", "--dims", "64", "64", "64",
                   "--out", folder / "slab.nrrd"})
                  .exit_code,
              0);
    writeFile(folder / "a.csv", plunge(0, 0, 20e-3, 20e-3, 2, 0, 0));
    const auto warnings = [&](const std::string& burr_radius_mm, const std::string& rest) {
        return warningsOf(folder,
                          "volume { path: \"slab.nrrd\" } tool { sdf_spacing_mm: 0.05 burr_radius_mm: " +
                              burr_radius_mm + " } " + rest);
    };
    const std::string by_time = "effects { time_removal {} } ", coarse = "larger by some 23 %";
    EXPECT_NE(warnings("0.6", by_time).find(coarse), std::string::npos);
    EXPECT_EQ(warnings("1", by_time).find("larger by some"), std::string::npos);
    EXPECT_EQ(warnings("0.6", "").find("larger by some"), std::string::npos);
    EXPECT_EQ(warnings("0.6", by_time + "accuracy { preset: THESIS_2012 }").find("larger by some"),
              std::string::npos);
}

TEST(Simulate, TraceHasTheDocumentedColumnsAndAddsUp) {
    const TemporaryFolder folder;
    ASSERT_EQ(run({"make_phantom", "body", "--kind", "slab", "--out", folder / "slab.nrrd"}).exit_code, 0);
    writeFile(folder / "s.textproto",
              "effects { time_removal {} } volume { path: \"slab.nrrd\" } accuracy { preset: THESIS_2012 }");
    writeFile(folder / "a.csv", plunge(0.03e-3, -0.08e-3, 3.3e-3, 0.1e-3, 800, 100, 1));
    const auto json = simulateOnce({"haptic_server", "simulate", "--scene", folder / "s.textproto",
                                    "--trajectory", folder / "a.csv", "--trace", folder / "o.csv"});
    std::string header;
    const auto rows = readCsv(folder / "o.csv", header);
    EXPECT_EQ(header,
              "t_s,spo_px_m,spo_py_m,spo_pz_m,spo_qw,spo_qx,spo_qy,spo_qz,dev_px_m,dev_py_m,dev_pz_m,dev_qw,"
              "dev_qx,dev_qy,"
              "dev_qz,fx_n,fy_n,fz_n,tx_nm,ty_nm,tz_nm,contacts,max_penetration_m,removed_voxels,removed_mm3,"
              "faults,tick_us");
    ASSERT_EQ(rows.size(), 900u);
    double removed_voxels = 0, removed_mm3 = 0;
    for (const auto& row : rows) {
        ASSERT_EQ(row.size(), 27u);
        removed_voxels += row[23];
        removed_mm3 += row[24];
        // What the hand feels is the coupling between the new tool pose and the device (eq 32).
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(row[15 + axis], 3000 * (row[1 + axis] - row[8 + axis]), 1e-9);
    }
    EXPECT_EQ(removed_voxels, json["removed_voxels"].get<double>());
    EXPECT_NEAR(removed_mm3, json["removed_mm3"].get<double>(), 1e-9);
    EXPECT_NEAR(rows.back()[0], 0.899, 1e-12);
}

// The disk becomes full while the run writes; it was not when the files were opened.
TEST(Simulate, AFileThatCannotBeWrittenCostsNeitherTheOthersNorTheTotals) {
    const TemporaryFolder folder;
    ASSERT_EQ(run({"make_phantom", "body", "--kind", "slab", "--out", folder / "slab.nrrd"}).exit_code, 0);
    writeFile(folder / "s.textproto", "effects { time_removal {} } volume { path: \"slab.nrrd\" }");
    writeFile(folder / "a.csv", plunge(0.03e-3, -0.08e-3, 3.3e-3, 1.1e-3, 400, 0, 1));
    const std::vector<std::string> plain{"haptic_server",        "simulate",     "--scene",
                                         folder / "s.textproto", "--trajectory", folder / "a.csv"};
    for (const char* name : {"full.csv", "full.nrrd"})
        std::filesystem::create_symlink("/dev/full", folder / name);
    std::vector<std::string> full = plain;
    full.insert(full.end(), {"--trace", folder / "full.csv", "--save-volume", folder / "full.nrrd",
                             "--save-mesh", folder / "mesh.stl", "--save-difference", folder / "cut.nrrd"});
    const auto finished = run(full);
    EXPECT_EQ(finished.exit_code, 1);
    for (const char* name : {"full.csv", "full.nrrd"})
        EXPECT_NE(finished.err.find(folder / name), std::string::npos) << finished.err;
    ASSERT_FALSE(finished.out.empty()) << finished.err;
    const auto json = nlohmann::json::parse(finished.out);
    EXPECT_EQ(json["state_hash"], simulateOnce(plain)["state_hash"]);
    EXPECT_EQ(std::filesystem::file_size(folder / "mesh.stl"),
              84 + 50 * json["mesh"]["triangles"].get<size_t>());
    EXPECT_GT(std::filesystem::file_size(folder / "cut.nrrd"), 100u);
}

TEST(Simulate, SavedVolumeGoesOnWhereTheRunEnded) {
    const TemporaryFolder folder;
    ASSERT_EQ(run({"make_phantom", "body", "--kind", "slab", "--out", folder / "slab.nrrd"}).exit_code, 0);
    writeFile(folder / "s.textproto", "effects { time_removal {} } volume { path: \"slab.nrrd\" }");
    writeFile(folder / "mill.csv", plunge(0.03e-3, -0.08e-3, 3.3e-3, 0.1e-3, 800, 100, 1));
    writeFile(folder / "away.csv", plunge(0, 0, 7e-3, 7e-3, 2, 0, 0));
    const auto milled = simulateOnce({"haptic_server", "simulate", "--scene", folder / "s.textproto",
                                      "--trajectory", folder / "mill.csv", "--save-volume",
                                      folder / "milled.nrrd", "--save-mesh", folder / "milled.stl"});
    writeFile(folder / "again.textproto",
              "volume { path: \"milled.nrrd\" window_low: 0 window_high: 65535 iso_value: 32768 } effects { "
              "time_removal {} }");
    const auto again = simulateOnce({"haptic_server", "simulate", "--scene", folder / "again.textproto",
                                     "--trajectory", folder / "away.csv"});
    EXPECT_NEAR(again["bone_mm3"].get<double>(), milled["bone_mm3"].get<double>(),
                1e-3 * milled["bone_mm3"].get<double>());
    EXPECT_LT(milled["bone_mm3"].get<double>(), milled["bone_before_mm3"].get<double>() - 3);
    EXPECT_EQ(std::filesystem::file_size(folder / "milled.stl"),
              84 + 50 * milled["mesh"]["triangles"].get<size_t>());
}

TEST(Simulate, SavedDifferenceAndMeshAddUp) {
    const TemporaryFolder folder;
    ASSERT_EQ(run({"make_phantom", "body", "--kind", "slab", "--out", folder / "slab.nrrd"}).exit_code, 0);
    writeFile(folder / "s.textproto", "effects { time_removal {} } volume { path: \"slab.nrrd\" }");
    writeFile(folder / "mill.csv", plunge(0.03e-3, -0.08e-3, 3.3e-3, 0.1e-3, 800, 100, 1));
    const auto milled = simulateOnce({"haptic_server", "simulate", "--scene", folder / "s.textproto",
                                      "--trajectory", folder / "mill.csv", "--save-difference",
                                      folder / "d.nrrd", "--save-mesh", folder / "milled.ply"});
    const double removed_mm3 = milled["bone_before_mm3"].get<double>() - milled["bone_mm3"].get<double>();
    const RawVolume slab = importVolume(folder / "slab.nrrd"), lost = importVolume(folder / "d.nrrd");
    EXPECT_EQ(lost.geometry.dims, slab.geometry.dims);
    EXPECT_EQ(lost.geometry.X_WV.position, slab.geometry.X_WV.position);
    double sum = 0;
    for (size_t n = 0; n < lost.values.size(); ++n) sum += lost.values[n];
    const double voxel_mm3 = slab.geometry.spacing.prod() * kPerCubicMillimetre;
    EXPECT_NEAR(sum / 32767 * voxel_mm3, removed_mm3, 0.05 * removed_mm3);
    const test::PlyMesh ply = test::readPly(folder / "milled.ply");
    EXPECT_TRUE(ply.isClosed());
    EXPECT_NEAR(ply.volume(), milled["bone_mm3"].get<double>(), 1e-4 * ply.volume());
}

// The corridor in the tooth is where the trajectory says. The oracle is all voxels of the scan that lie
// inside the burr at any traced tool position; it is independent of the tick's own milling.
class SimulatePresets : public testing::TestWithParam<const char*> {};

TEST_P(SimulatePresets, CorridorInTheToothIsTheSweptBurr) {
    const TemporaryFolder folder;
    ASSERT_EQ(run({"make_phantom", "tooth", "--out", folder / "tooth"}).exit_code, 0);
    constexpr double kIso = 600, kBurr = 1e-3;
    writeFile(folder / "s.textproto",
              "effects { time_removal {} } volume { path: \"tooth\" iso_value: 600 octree_depth: 3 } "
              "accuracy { preset: " +
                  std::string(GetParam()) + " }");
    // The burr goes from above a cusp straight down into the middle of the tooth, at 1 mm/s.
    writeFile(folder / "a.csv", plunge(2.7e-3, -2.45e-3, 21e-3, 12.2e-3, 8800, 400, 1));
    const auto json = simulateOnce({"haptic_server", "simulate", "--scene", folder / "s.textproto",
                                    "--trajectory", folder / "a.csv", "--trace", folder / "o.csv"});
    std::string header;
    const auto trace = readCsv(folder / "o.csv", header);
    const RawVolume raw = importVolume(folder / "tooth");
    const VolumeGeometry& g = raw.geometry;
    std::vector<bool> swept(g.voxelCount(), false);
    const Pose X_VW = g.X_WV.inverse();
    for (const auto& row : trace) {
        const Eigen::Vector3d center = X_VW * Eigen::Vector3d(row[1], row[2], row[3]);
        const Eigen::Vector3i low = ((center.array() - kBurr) / g.spacing.array()).floor().cast<int>().max(0);
        const Eigen::Vector3i high =
            ((center.array() + kBurr) / g.spacing.array()).ceil().cast<int>().min(g.dims.array() - 1);
        for (int k = low.z(); k <= high.z(); ++k)
            for (int j = low.y(); j <= high.y(); ++j)
                for (int i = low.x(); i <= high.x(); ++i)
                    if ((g.spacing.cwiseProduct(Eigen::Vector3d(i, j, k)) - center).norm() < kBurr)
                        swept[size_t(i) + size_t(g.dims.x()) * (size_t(j) + size_t(g.dims.y()) * size_t(k))] =
                            true;
    }
    size_t bone_in_sweep = 0;
    for (size_t n = 0; n < swept.size(); ++n) bone_in_sweep += swept[n] && raw.values[n] >= kIso;
    const double expected_mm3 = double(bone_in_sweep) * g.spacing.prod() * 1e9;
    EXPECT_GT(expected_mm3, 15);
    EXPECT_NEAR(json["removed_mm3"].get<double>() / expected_mm3, 1, 0.03);
    const double surface_mm3 = json["bone_before_mm3"].get<double>() - json["bone_mm3"].get<double>();
    EXPECT_NEAR(surface_mm3 / expected_mm3, 1, 0.03);
    std::printf("swept %.3f mm3, removed voxels %.3f mm3, between the surfaces %.3f mm3\n", expected_mm3,
                json["removed_mm3"].get<double>(), surface_mm3);
    EXPECT_TRUE(json["mesh"]["is_closed"]);
    // The burr was where the device was, but for the springs' give.
    const auto& last = trace.back();
    EXPECT_NEAR(last[3], 12.2e-3, 0.1e-3);
    for (const auto& row : trace) EXPECT_LT(std::hypot(row[1] - 2.7e-3, row[2] + 2.45e-3), 0.5e-3);
}

INSTANTIATE_TEST_SUITE_P(Presets, SimulatePresets,
                         testing::Values("THESIS_2012", "FAST", "BALANCED", "EXACT"),
                         [](const auto& preset) { return std::string(preset.param); });

}  // namespace
}  // namespace bonemill
