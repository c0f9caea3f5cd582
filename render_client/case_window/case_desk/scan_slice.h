// A slice through a scan as a picture, with the bone's surface drawn on it.
//
// Only this slice is computed, whatever the scan's size. Pure; any thread may call it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "haptic_server/cases/casework/case_plan.h"
#include "render_client/look/camera/view_settings.h"
#include "render_client/look/slices/slice_image.h"
#include "render_client/look/slices/slice_plane.h"

namespace bonemill {

// Everything but the window may be missing; what is pointed at must outlive the call.
struct SliceLook {
    GreyWindow window;
    std::optional<double> iso = {};            // value on the line
    const CaseBone* bone = nullptr;            // its line is drawn where bone was left out, too, but dull
    const RawVolume* labels = nullptr;         // on any grid
    std::map<uint32_t, Rgb> label_tints = {};  // by label; others are not shown
    bool operator==(const SliceLook&) const = default;
};

struct RgbaImage {
    int width = 0, height = 0;
    std::vector<uint8_t> rgba;  // rows from the top
    std::array<uint8_t, 4> at(int x, int y) const {
        const uint8_t* const p = rgba.data() + 4 * (size_t(y) * size_t(width) + size_t(x));
        return {p[0], p[1], p[2], p[3]};
    }
};

inline constexpr Rgb kBoneLine{255, 176, 32}, kLeftOutLine{120, 130, 150};

// The plane lies in the scan's frame V. Values are trilinear between voxels; outside of the scan it is black.
RgbaImage drawSlice(const RawVolume& scan, const SlicePlane& plane, const SliceLook& look);

}  // namespace bonemill
