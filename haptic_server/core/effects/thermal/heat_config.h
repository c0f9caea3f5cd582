// It says how heat spreads in bone and leaves it, in SI; temperatures are in °C. The defaults
// stand in proto/scene.proto.
#pragma once

namespace bonemill {

struct HeatConfig {
    double cell;           // m: edge of the cubes
    double conductivity;   // W/(m·K)
    double heat_capacity;  // J/(m³·K)
    double perfusion;      // 1/s
    double body_temperature;
    double wet_transfer;  // W/(m²·K), of irrigated surface
    double irrigation_temperature;
    double dry_transfer;  // W/(m²·K), of all other surface
    double necrosis_temperature;
    double necrosis_time;  // s above it without a break
};

}  // namespace bonemill
