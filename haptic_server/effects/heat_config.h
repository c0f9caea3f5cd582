// How heat spreads in bone and leaves it, in SI; temperatures in °C.
#pragma once

namespace bonemill {

struct HeatConfig {
    double cell = 0.5e-3;          // m: edge of the cubes
    double conductivity = 0.4;     // W/(m·K)
    double heat_capacity = 2.4e6;  // J/(m³·K)
    double perfusion = 0;          // 1/s
    double body_temperature = 37;
    double wet_transfer = 2000;  // W/(m²·K), of irrigated surface
    double irrigation_temperature = 22;
    double dry_transfer = 10;  // W/(m²·K), of all other surface
    double necrosis_temperature = 47;
    double necrosis_time = 0;  // s above it without a break
};

}  // namespace bonemill
