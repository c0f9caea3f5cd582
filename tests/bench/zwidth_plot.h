// Results of the Z-width bench as CSV and as a gnuplot script with its picture.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace bonemill::test {

struct ZwidthRow {
    std::string variant;
    std::string place;     // plane, hole
    std::string hand;      // typical, none
    std::string quantity;  // what was raised: coupling, contact
    double rate_hz = 0;
    double largest = 0;        // stable stiffness; unit by quantity and variant
    bool is_scan_end = false;  // stable up to the end of the scan
    double relative = 0;       // largest over the variant's default
    double colgate_bound = 0;  // N/m: b / (T/2 + delay); what viscous damping alone can promise
    double drag_in_air = 0;    // N·s/m, moving freely at the largest stiffness
};

// zwidth.csv, zwidth.gp and, if gnuplot is there, zwidth.png in `folder`. False: a file could not be written.
bool writeZwidth(const std::filesystem::path& folder, const std::vector<ZwidthRow>& rows);

}  // namespace bonemill::test
