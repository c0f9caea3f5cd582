// A folder with two DICOM series of the same block, as the tests of desk and screen open it: a soft one with
// more slices, and one for bone.
#pragma once

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

#include "render_client/case_window/case_desk/case_desk.h"
#include "tests/unit/haptic_server/scans/import/dicom_bytes.h"

namespace bonemill::test {

inline constexpr int kScanPixels = 32;  // of 1 mm
inline constexpr char kSoftSeries[] = "1.2.1", kBoneSeries[] = "1.2.2";

// A ball of bone around (15, 15, 12) mm with a radius of 9, and a small one beside it.
inline void writeSeries(const std::filesystem::path& folder, const std::string& uid,
                        const std::string& kernel, int slices, double step_mm) {
    for (int k = 0; k < slices; ++k) {
        DicomImage image;
        image.series_uid = uid;
        image.sop_uid = uid + "." + std::to_string(k + 1);
        image.series_description = "Head";
        image.kernel = kernel;
        image.rows = image.columns = kScanPixels;
        image.pixel_spacing = "1\\1";
        image.position = "0\\0\\" + std::to_string(k * step_mm);
        image.intercept = -1024;
        for (int j = 0; j < kScanPixels; ++j)
            for (int i = 0; i < kScanPixels; ++i) {
                const Eigen::Vector3d p(i, j, k * step_mm);
                const double inside = std::max(9 - (p - Eigen::Vector3d(15, 15, 12)).norm(),
                                               2.5 - (p - Eigen::Vector3d(28, 28, 12)).norm());
                const double hu = std::clamp(300 + 700 * inside, inside > -3 ? 40.0 : -1000.0, 1200.0);
                image.pixels.push_back(int16_t(std::lround(hu) + 1024));
            }
        writeDicomFile(folder / (uid + "_" + std::to_string(k)), image);
    }
}

inline void writeHead(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    writeSeries(folder, kSoftSeries, "B30f", 40, 0.625);
    writeSeries(folder, kBoneSeries, "H60s", 25, 1.0);
}

// Until nothing goes on beside the window any more.
inline void settle(CaseDesk& desk) {
    for (int idle = 0; idle < 2;) {
        desk.poll();
        idle = desk.busyWith().empty() ? idle + 1 : 0;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
}

}  // namespace bonemill::test
