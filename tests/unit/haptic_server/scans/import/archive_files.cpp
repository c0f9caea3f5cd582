#include "tests/unit/haptic_server/scans/import/archive_files.h"

#include <archive.h>
#include <archive_entry.h>

#include <stdexcept>

namespace bonemill {
namespace {

void require(archive* writer, int state) {
    if (state != ARCHIVE_OK) throw std::logic_error(archive_error_string(writer));
}

void chooseKind(archive* writer, const std::string& name, const std::string& password) {
    if (name.ends_with(".zip")) {
        require(writer, archive_write_set_format_zip(writer));
        if (password.empty()) return;
        require(writer, archive_write_set_options(writer, "zip:encryption=traditional"));
        require(writer, archive_write_set_passphrase(writer, password.c_str()));
        return;
    }
    require(writer, archive_write_set_format_pax_restricted(writer));
    if (name.ends_with("gz")) require(writer, archive_write_add_filter_gzip(writer));
    if (name.ends_with("xz")) require(writer, archive_write_add_filter_xz(writer));
}

}  // namespace

void writeArchive(const std::filesystem::path& path, const std::vector<PackedFile>& files,
                  const std::string& password) {
    archive* const writer = archive_write_new();
    chooseKind(writer, path.filename().string(), password);
    require(writer, archive_write_open_filename(writer, path.c_str()));
    for (const PackedFile& file : files) {
        archive_entry* const entry = archive_entry_new();
        archive_entry_set_pathname(entry, file.name.c_str());
        archive_entry_set_filetype(entry, file.link_to.empty() || file.is_hard_link ? AE_IFREG : AE_IFLNK);
        if (file.is_hard_link)
            archive_entry_set_hardlink(entry, file.link_to.c_str());
        else if (!file.link_to.empty())
            archive_entry_set_symlink(entry, file.link_to.c_str());
        archive_entry_set_size(entry, la_int64_t(file.bytes.size()));
        archive_entry_set_perm(entry, 0644);
        require(writer, archive_write_header(writer, entry));
        archive_write_data(writer, file.bytes.data(), file.bytes.size());
        archive_entry_free(entry);
    }
    require(writer, archive_write_close(writer));
    archive_write_free(writer);
}

}  // namespace bonemill
