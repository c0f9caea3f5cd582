// The child's end: looks into the archive.
#include <archive.h>
#include <archive_entry.h>

#include <memory>
#include <string>
#include <vector>

#include "common/base/user_error.h"
#include "haptic_server/scans/archive/archive_words.h"
#include "haptic_server/scans/archive/unpack_archive.h"

namespace bonemill {
namespace {

class ArchiveReader {
  public:
    explicit ArchiveReader(const std::filesystem::path& path) : path_(path) {
        archive_read_support_filter_gzip(reader_.get());
        archive_read_support_filter_xz(reader_.get());
        archive_read_support_format_tar(reader_.get());
        archive_read_support_format_zip(reader_.get());
        constexpr size_t kBlock = 1 << 16;
        if (archive_read_open_filename(reader_.get(), path.c_str(), kBlock) != ARCHIVE_OK)
            fail("is no zip or tar archive, or damaged");
    }

    // nullptr: there is none.
    archive_entry* next() {
        archive_entry* entry = nullptr;
        const int state = archive_read_next_header(reader_.get(), &entry);
        if (state == ARCHIVE_EOF) return nullptr;
        if (state != ARCHIVE_OK && state != ARCHIVE_WARN)
            fail("is cut short, damaged, or no zip or tar archive");
        if (archive_entry_is_encrypted(entry))
            throw UserError(path_.string() +
                            ": is encrypted; unpack it with its password first, and give the folder");
        return entry;
    }
    // So many bytes of the entry as there are, the buffer's size at most; 0: the entry ends.
    size_t read(std::vector<char>& bytes) {
        const la_ssize_t count = archive_read_data(reader_.get(), bytes.data(), bytes.size());
        if (count < 0) fail("is cut short or damaged");
        return size_t(count);
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        const char* const why = archive_error_string(reader_.get());
        throw UserError(path_.string() + ": " + what + (why ? " (" + std::string(why) + ")" : "") +
                        "; copy or download it anew, or unpack it and give the folder");
    }

    std::filesystem::path path_;
    std::unique_ptr<archive, int (*)(archive*)> reader_{archive_read_new(), archive_read_free};
};

std::string nameOf(archive_entry* entry) {
    const char* name = archive_entry_pathname(entry);
    if (!name) name = archive_entry_pathname_utf8(entry);
    return name ? name : "";
}

bool isFile(archive_entry* entry) {
    return archive_entry_filetype(entry) == AE_IFREG && !archive_entry_hardlink(entry) &&
           !archive_entry_symlink(entry);
}

void sendFiles(int pipe, const std::filesystem::path& path) {
    ArchiveReader reader(path);
    std::vector<char> bytes(kMaxWordsBytes);
    while (archive_entry* const entry = reader.next()) {
        if (archive_entry_filetype(entry) == AE_IFDIR) continue;
        const std::string name = nameOf(entry);
        if (!isFile(entry))
            throw UserError(path.string() + ": holds what is no file, as links and devices (" + name +
                            "); unpack it, if you trust it, and give the folder");
        if (!sendWords(pipe, kFileWords, name)) return;
        while (const size_t count = reader.read(bytes))
            if (!sendWords(pipe, kBytesWords, {bytes.data(), count})) return;
    }
    sendWords(pipe, kEndWords, {});
}

}  // namespace

void sendArchiveAsChild(int pipe, const std::filesystem::path& path) {
    sendAsChild(pipe, path, [&] { sendFiles(pipe, path); });
}

}  // namespace bonemill
