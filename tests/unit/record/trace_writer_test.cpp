#include "haptic_server/record/trace_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <span>
#include <sstream>
#include <vector>

#include "common/config/user_error.h"
#include "tests/unit/record/temporary_file.h"

namespace bonemill {
namespace {

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
    EXPECT_EQ(
        file.content(),
        "t_s,spo_px_m,spo_py_m,spo_pz_m,spo_qw,spo_qx,spo_qy,spo_qz,dev_px_m,dev_py_m,dev_pz_m,dev_qw,dev_qx,"
        "dev_qy,dev_qz,fx_n,fy_n,fz_n,tx_nm,ty_nm,tz_nm,contacts,max_penetration_m,removed_voxels,removed_"
        "mm3,"
        "faults,tick_us\n");
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

TEST(TraceWriter, unwritablePathIsAUserError) {
    EXPECT_THROW(TraceWriter("/no/such/folder/trace.csv"), UserError);
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
