#include "common/config/field_unit.h"

#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace bonemill {

std::string_view unitOfField(std::string_view field_name) noexcept {
    // A suffix stands before every shorter suffix that it ends with.
    static constexpr std::array<std::pair<std::string_view, std::string_view>, 29> kUnits{{
        {"_density_per_s", "density/s"},
        {"_w_per_m2_k", "W/(m²·K)"},
        {"_w_per_m_k", "W/(m·K)"},
        {"_j_per_cm3_k", "J/(cm³·K)"},
        {"_mm_per_s", "mm/s"},
        {"_deg_per_s", "deg/s"},
        {"_per_s", "1/s"},
        {"_n_per_mm3", "N/mm³"},
        {"_n_per_mm", "N/mm"},
        {"_n_per_m", "N/m"},
        {"_nmm_per_rad", "N·mm/rad"},
        {"_nmm_per_krpm", "N·mm per 1000/min"},
        {"_nm_s_per_rad", "N·m·s/rad"},
        {"_nm_per_rad", "N·m/rad"},
        {"_n_s_per_m", "N·s/m"},
        {"_kg_m2", "kg·m²"},
        {"_kg_mm2", "kg·mm²"},
        {"_voxels", "voxels"},
        {"_nmm", "N·mm"},
        {"_deg", "deg"},
        {"_mm", "mm"},
        {"_um", "µm"},
        {"_ms", "ms"},
        {"_hz", "Hz"},
        {"_kg", "kg"},
        {"_hu", "HU"},
        {"_n", "N"},
        {"_s", "s"},
        {"_c", "°C"},
    }};
    for (const auto& [suffix, unit] : kUnits)
        if (field_name.ends_with(suffix)) return unit;
    return {};
}

std::string numberText(double value) {
    std::array<char, 32> text;
    const bool is_everyday = value == 0.0 || (std::abs(value) >= 1e-3 && std::abs(value) < 1e7);
    const auto format = is_everyday ? std::chars_format::fixed : std::chars_format::general;
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value, format).ptr;
    return std::string(text.data(), end);
}

}  // namespace bonemill
