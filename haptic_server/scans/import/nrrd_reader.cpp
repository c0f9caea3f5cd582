// The readers of a build without BONEMILL_WITH_SCANS: NRRD.
#include <unistd.h>

#include <cctype>
#include <string>

#include "common/base/user_error.h"
#include "haptic_server/scans/import/import_volume.h"
#include "haptic_server/scans/import/packed_scan.h"

namespace bonemill {

RawVolume readVolume(const std::filesystem::path& path, const ImportOptions& options) {
    std::string ending = path.extension().string();
    for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
    if (ending == ".nrrd" && !std::filesystem::is_directory(path))
        return readPlainNrrd(path, options.spacing_mm);
    throw UserError(
        path.string() +
        ": this program was built without the readers of scans (BONEMILL_WITH_SCANS=OFF) and reads "
        ".nrrd files only; take one of all components, or save the volume as .nrrd");
}

std::vector<std::string> readSeries(const std::filesystem::path& path) {
    throw UserError(path.string() +
                    ": this program was built without the readers of scans (BONEMILL_WITH_SCANS=OFF), DICOM "
                    "among them; take one of all components");
}

bool isPacked(const std::filesystem::path&) {
    return false;
}

void sendPackedAsChild(int, const std::filesystem::path&) {
    _exit(kUserErrorExitCode);
}

void readUnpacked(const std::filesystem::path&, const StartReader&, const ReadUnpacked&) {}

}  // namespace bonemill
