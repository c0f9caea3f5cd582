#include <archive.h>
#include <archive_entry.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>
#include <memory>
#include <pugixml.hpp>
#include <utility>

#include "common/base/user_error.h"
#include "common/text/printed_text.h"
#include "haptic_server/scans/confined/import_limits.h"
#include "haptic_server/scans/formats/volume_file.h"
#include "haptic_server/scans/frame/physical_frame.h"

namespace bonemill {
namespace {

static_assert(std::endian::native == std::endian::little, "the matrix is stored little endian");

constexpr uint64_t kMaxPlistBytes = 1 << 20;
constexpr int kMaxEntries = 10000;

// Finds the entry with this file name, in whatever folder of the archive; `accepts` is asked with the stated
// size in bytes before anything is read.
template <class T>
std::vector<T> readEntry(const std::filesystem::path& path, const std::string& name,
                         const std::function<void(uint64_t)>& accepts) {
    const std::unique_ptr<archive, int (*)(archive*)> reader(archive_read_new(), archive_read_free);
    archive_read_support_filter_all(reader.get());
    archive_read_support_format_tar(reader.get());
    const auto fail = [&](const std::string& what) -> UserError {
        const char* why = archive_error_string(reader.get());
        return UserError(path.string() + ": " + what + (why ? std::string(": ") + why : ""));
    };
    constexpr size_t kBlock = 1 << 16;
    if (archive_read_open_filename(reader.get(), path.c_str(), kBlock) != ARCHIVE_OK)
        throw fail("is not an InVesalius project (compressed tar archive)");
    archive_entry* entry = nullptr;
    for (int count = 0; count < kMaxEntries; ++count) {
        const int state = archive_read_next_header(reader.get(), &entry);
        if (state == ARCHIVE_EOF) throw UserError(path.string() + ": holds no " + name);
        if (state != ARCHIVE_OK && state != ARCHIVE_WARN) throw fail("the archive is damaged");
        const char* entry_name = archive_entry_pathname(entry);
        if (!entry_name || std::filesystem::path(entry_name).filename() != name) continue;
        const uint64_t size = uint64_t(std::max<int64_t>(archive_entry_size(entry), 0));
        accepts(size);
        std::vector<T> items(size / sizeof(T));
        if (archive_read_data(reader.get(), items.data(), size) != la_ssize_t(size))
            throw fail(name + " is cut short");
        return items;
    }
    throw UserError(path.string() + ": the archive holds too many files");
}

// Property lists are a <dict> of a <key> and a value each.
pugi::xml_node valueOf(const pugi::xml_node& dict, const char* key) {
    for (const pugi::xml_node& node : dict.children("key"))
        if (std::strcmp(node.child_value(), key) == 0) return node.next_sibling();
    return {};
}

std::vector<double> numbersOf(const pugi::xml_node& array) {
    std::vector<double> numbers;
    for (const pugi::xml_node& node : array.children()) numbers.push_back(node.text().as_double());
    return numbers;
}

struct Project {
    std::string matrix_file, dtype, name, modality;
    std::vector<double> shape;       // slices, rows, columns
    std::vector<double> spacing_mm;  // column, row, slice
    double window_level = 0, window_width = 0;
};

Project readProject(const std::filesystem::path& path) {
    const std::vector<char> text = readEntry<char>(path, "main.plist", [&](uint64_t size) {
        if (size > kMaxPlistBytes) throw UserError(path.string() + ": its main.plist is absurdly large");
    });
    pugi::xml_document document;
    const auto result = document.load_buffer(text.data(), text.size());
    const pugi::xml_node dict = document.child("plist").child("dict");
    if (!result || !dict) throw UserError(path.string() + ": its main.plist is not a property list");
    const pugi::xml_node matrix = valueOf(dict, "matrix");
    Project project;
    project.matrix_file = valueOf(matrix, "filename").child_value();
    project.dtype = valueOf(matrix, "dtype").child_value();
    project.shape = numbersOf(valueOf(matrix, "shape"));
    project.spacing_mm = numbersOf(valueOf(dict, "spacing"));
    project.name = valueOf(dict, "name").child_value();
    project.modality = valueOf(dict, "modality").child_value();
    project.window_level = valueOf(dict, "window_level").text().as_double();
    project.window_width = valueOf(dict, "window_width").text().as_double();
    return project;
}

void checkProject(const Project& project, const std::string& file) {
    if (project.matrix_file.empty() || project.shape.size() != 3 || project.spacing_mm.size() != 3)
        throw UserError(file + ": its main.plist does not say matrix file, shape and spacing");
    if (project.dtype != "int16")
        throw UserError(file + ": its matrix is \"" + project.dtype + "\"; InVesalius stores int16");
    std::vector<uint64_t> dims;
    for (const double n : project.shape) dims.push_back(n >= 0 && n < 1e9 ? uint64_t(n) : uint64_t(1e9));
    std::swap(dims[0], dims[2]);
    checkVolumeSize(dims, sizeof(int16_t), file);
}

std::string describe(const Project& project) {
    return "InVesalius project \"" + project.name + "\"" +
           printed(", display window level %g width %g", project.window_level, project.window_width) +
           ", rows reversed to run front to back";
}

}  // namespace

RawVolume importInv3(const std::filesystem::path& path) {
    const std::string file = path.string();
    const Project project = readProject(path);
    checkProject(project, file);
    FileFrame frame;
    frame.dims = Eigen::Vector3d(project.shape[2], project.shape[1], project.shape[0]).cast<int>();
    frame.spacing_mm = {project.spacing_mm[0], project.spacing_mm[1], project.spacing_mm[2]};
    frame.directions.setIdentity();
    frame.origin_mm.setZero();
    const size_t voxels = size_t(frame.dims.cast<int64_t>().prod());
    auto samples = readEntry<int16_t>(path, project.matrix_file, [&](uint64_t size) {
        if (size != voxels * sizeof(int16_t))
            throw UserError(file + ": " + project.matrix_file + " has " + std::to_string(size) +
                            " bytes, its shape needs " + std::to_string(voxels * sizeof(int16_t)));
    });
    RawVolume raw;
    raw.values.append(std::move(samples));
    reverseAxis(raw.values, frame.dims, 1);
    makeRightHanded(frame, file, raw.geometry, raw.values);
    raw.is_hounsfield = project.modality == "CT" && raw.values.range().low <= -500;
    raw.description = describe(project);
    return raw;
}

}  // namespace bonemill
