// Reads what the headers of DICOM files say of their pictures, and finds the files of a folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "haptic_server/scans/dicom/dicom_slice.h"

namespace bonemill {

// Counts files that are left out on purpose, by reason, with one example each.
class LeftOut {
  public:
    void add(const std::string& reason, const std::filesystem::path& file);
    void add(const LeftOut& more);
    std::string text() const;  // empty: none

  private:
    struct Entry {
        std::string reason, example;
        int count;
    };
    void add(const Entry& entry);

    std::vector<Entry> entries_;
};

// Ascending by name. Those of its folders are among them when they are wanted. Throws UserError.
enum class Subfolders : bool { kNo, kYes };
std::vector<std::filesystem::path> filesOf(const std::filesystem::path& folder, Subfolders subfolders,
                                           LeftOut& left_out);

// The pictures of one file, or none and the reason: it cannot belong to a volume. Throws UserError when it is
// damaged, which must not pass as "not an image": the volume would silently lose a slice.
std::vector<DicomSlice> slicesOfFile(const std::filesystem::path& path, LeftOut& left_out);

struct DicomFiles {
    std::vector<DicomSlice> slices;
    std::vector<DamagedFile> damaged;
    LeftOut left_out;
};

// The pictures of all the files, which are read several at a time.
DicomFiles readDicomFiles(const std::vector<std::filesystem::path>& files);

}  // namespace bonemill
