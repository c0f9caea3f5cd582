// Writes the results of the Z-width bench as CSV and as a gnuplot script with its picture.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace bonemill::test {

struct ZwidthRow {
    std::string variant;
    std::string place;     // plane, hole
    std::string hand;      // typical, none
    std::string quantity;  // zwidth, tuned, coupling, contact: see zwidth_bench.cpp
    double rate_hz = 0;
    double coupling = 0;            // k_t, N/m; 0: nothing was stable
    double contact = 0;             // N/m per point (thesis_2012), N/m³ (others)
    double contact_to_default = 0;  // its ratio to the default
    bool is_scan_end = false;       // stable up to the end of the scan
    double rendered = 0;            // N/m, measured at the hand
    double drag_in_air = 0;         // N·s/m, measured
    double colgate_bound = 0;       // N/m: b / (T/2 + delay); what viscous damping alone can promise
};

// Writes zwidth.csv, zwidth.gp and, if gnuplot is there, zwidth.png into `folder`. False means that a file
// could not be written.
bool writeZwidth(const std::filesystem::path& folder, const std::vector<ZwidthRow>& rows);

}  // namespace bonemill::test
