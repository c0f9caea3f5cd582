#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <cstdlib>
#include <span>
#include <sstream>
#include <vector>

#include "common/base/user_error.h"
#include "haptic_server/recording/statistics/bone_files.h"
#include "haptic_server/recording/statistics/tick_columns.h"
#include "tests/unit/haptic_server/recording/statistics/temporary_file.h"

namespace bonemill {
namespace {

constexpr char kHeader[] =
    "t_s,spo_px_m,spo_py_m,spo_pz_m,spo_qw,spo_qx,spo_qy,spo_qz,dev_px_m,dev_py_m,dev_pz_m,dev_qw,dev_qx,"
    "dev_qy,dev_qz,fx_n,fy_n,fz_n,tx_nm,ty_nm,tz_nm,contacts,max_penetration_m,removed_voxels,removed_mm3,"
    "faults,tick_us";

TickRecord awkwardRecord() {
    TickRecord record{};
    record.t_s = 1.0 / 3.0;
    double number = 0.1;
    for (double* const values : {record.p_WT, record.p_WT_device, record.f_hand_W, record.t_hand_W}) {
        for (int i = 0; i < 3; ++i) values[i] = number = -std::sqrt(std::abs(number)) * 0.7;
    }
    for (double* const values : {record.q_WT, record.q_WT_device}) {
        for (int i = 0; i < 4; ++i) values[i] = number = std::sin(1000 * number);
    }
    record.max_penetration = 1e-300;
    record.removed = 1.25e-9;
    record.contacts = 4'000'000'000;
    record.removed_voxels = 12;
    record.faults = kFaultOverrun | kFaultForceClamped;
    record.compute_ns = 123'456;
    return record;
}

std::vector<std::string> cellsOf(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream input(line);
    for (std::string cell; std::getline(input, cell, ',');) cells.push_back(cell);
    return cells;
}

std::vector<double> expectedCells(const TickRecord& r) {
    std::vector<double> cells{r.t_s};
    const std::span<const double> vectors[] = {r.p_WT,        r.q_WT,     r.p_WT_device,
                                               r.q_WT_device, r.f_hand_W, r.t_hand_W};
    for (const auto& vector : vectors) {
        for (const double component : vector) cells.push_back(component);
    }
    cells.insert(cells.end(), {double(r.contacts), r.max_penetration, double(r.removed_voxels),
                               r.removed * 1e9, double(r.faults), double(r.compute_ns) / 1e3});
    return cells;
}

TEST(TraceWriter, headerIsTheDocumentedOne) {
    const TemporaryFile file("header.csv");
    EXPECT_TRUE(TraceWriter(file.path()).close());
    EXPECT_EQ(file.content(), std::string(kHeader) + "\n");
}

TEST(TraceWriter, everyNumberRoundTrips) {
    const TemporaryFile file("round_trip.csv");
    const TickRecord record = awkwardRecord();
    TraceWriter writer(file.path());
    ASSERT_TRUE(writer.write(TickRecord{}));
    ASSERT_TRUE(writer.write(record));
    ASSERT_TRUE(writer.close());

    std::istringstream lines(file.content());
    std::string header, zeros, line;
    std::getline(lines, header);
    std::getline(lines, zeros);
    std::getline(lines, line);
    EXPECT_EQ(zeros, "0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0");
    const std::vector<double> expected = expectedCells(record);
    const std::vector<std::string> cells = cellsOf(line);
    ASSERT_EQ(cells.size(), cellsOf(header).size());
    ASSERT_EQ(cells.size(), expected.size());
    for (size_t i = 0; i < cells.size(); ++i) {
        EXPECT_EQ(std::strtod(cells[i].c_str(), nullptr), expected[i]) << cellsOf(header)[i];
    }
}

TEST(TraceWriter, effectsAddTheirColumns) {
    const TemporaryFile file("effects.csv");
    TraceWriter writer(file.path(), {.burr = true, .heat = true, .protection = true});
    TickRecord record{};
    record.effects = {.events = kEventTooHot,
                      .protected_id = 3,
                      .touched_id = 0,
                      .damaged_id = 0,
                      .spin_speed = float(1000 * 2 * M_PI / 60),
                      .burr_force = 1,
                      .axis_torque = 2,
                      .cutting_power = 3,
                      .removal_power = 4,
                      .removed_energy = 5,
                      .temperature = 6,
                      .necrotic_volume = 7e-9f,
                      .protected_distance = 8e-3f,
                      .protected_force = 9,
                      .damaged_volume = 10e-9f};
    ASSERT_TRUE(writer.write(record));
    ASSERT_TRUE(writer.close());
    std::istringstream lines(file.content());
    std::string header, line;
    std::getline(lines, header);
    std::getline(lines, line);
    const std::vector<std::pair<std::string, double>> expected = {
        {"spin_rpm", 1000},           {"burr_force_n", 1},      {"axis_torque_nm", 2},
        {"cutting_power_w", 3},       {"removal_power_w", 4},   {"removed_energy_j", 5},
        {"temperature_c", 6},         {"necrotic_mm3", 7},      {"protected_id", 3},
        {"protected_distance_mm", 8}, {"protected_force_n", 9}, {"damaged_mm3", 10},
        {"events", kEventTooHot}};
    const std::vector<std::string> names = cellsOf(header), cells = cellsOf(line);
    ASSERT_EQ(names.size(), cells.size());
    const size_t without = cellsOf(kHeader).size();
    ASSERT_EQ(names.size(), without + expected.size());
    for (size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(names[without + i], expected[i].first);
        EXPECT_NEAR(std::strtod(cells[without + i].c_str(), nullptr), expected[i].second, 1e-4)
            << names[without + i];
    }
}

TEST(TraceWriter, onlyListedEffectsHaveColumns) {
    const TemporaryFile file("heat.csv");
    EXPECT_TRUE(TraceWriter(file.path(), {.heat = true}).close());
    EXPECT_EQ(file.content(), std::string(kHeader) + ",temperature_c,necrotic_mm3,events\n");
}

TEST(TraceWriter, unwritablePathIsAUserError) {
    EXPECT_THROW(TraceWriter("/no/such/folder/trace.csv"), UserError);
}

// Opening a pipe would wait for its reader.
TEST(TraceWriter, aPipeIsRefused) {
    const TemporaryFile pipe("pipe.csv");
    ASSERT_EQ(mkfifo(pipe.path().c_str(), 0600), 0);
    EXPECT_THROW(TraceWriter(pipe.path()), UserError);
    EXPECT_THROW(requireWritable(pipe.path()), UserError);
}

TEST(TraceWriter, aFullDiskIsReported) {
    TraceWriter writer("/dev/full");
    bool is_good = true;
    for (int i = 0; i < 1000 && is_good; ++i) is_good = writer.write(awkwardRecord());
    EXPECT_FALSE(is_good);
    EXPECT_FALSE(writer.write(awkwardRecord()));
    EXPECT_FALSE(writer.close());
}

}  // namespace
}  // namespace bonemill
