#include "haptic_server/scans/import/import_volume.h"

#include "common/base/user_error.h"
#include "common/files/require_file.h"
#include "haptic_server/scans/confined/guarded_import.h"
#include "haptic_server/scans/import/import_program.h"
#include "haptic_server/scans/import/readers.h"

namespace bonemill {
namespace {

// The scenes of deploy/scenes read what deploy/make-phantoms puts into build/data.
bool isPhantom(const std::filesystem::path& path) {
    const std::filesystem::path folder = path.lexically_normal().parent_path();
    return folder.filename() == "data" && folder.parent_path().filename() == "build";
}

void requireThere(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::exists(path, error))
        throw UserError(path.string() + ": no such file or folder; " +
                        (isPhantom(path) ? "deploy/make-phantoms makes it" : "check the path of the volume"));
    requireFile(path);
}

void describeNonFinite(RawVolume& raw) {
    const size_t count = raw.values.range().non_finite;
    if (count > 0) raw.description += "; " + std::to_string(count) + " values are not finite";
}

}  // namespace

RawVolume importVolume(const std::filesystem::path& path, const ImportOptions& options) {
    if (hasReaderProgram()) return importByProgram(path, options);
    return importGuarded(path, [&] { return importVolumeHere(path, options); });
}

RawVolume importVolumeHere(const std::filesystem::path& path, const ImportOptions& options) {
    requireThere(path);
    RawVolume raw = readVolume(path, options);
    describeNonFinite(raw);
    return raw;
}

std::vector<std::string> listSeries(const std::filesystem::path& path) {
    if (hasReaderProgram()) return listByProgram(path);
    return linesGuarded(path, [&] { return listSeriesHere(path); });
}

std::vector<std::string> listSeriesHere(const std::filesystem::path& path) {
    requireThere(path);
    return readSeries(path);
}

}  // namespace bonemill
