// The header of one DICOM file: all that stands before its pixels.
#pragma once

#include <gdcmReader.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "haptic_server/scans/dicom/stored_bits.h"

namespace bonemill {

// How the pixels lie in the file, unchecked.
struct DicomPixelLayout {
    int columns = 0, rows = 0;
    size_t frames = 1;
    int samples_per_pixel = 1;
    StoredBits bits;

    uint64_t frameBytes() const { return uint64_t(columns) * uint64_t(rows) * bits.allocated / 8; }
    uint64_t neededBytes() const { return frameBytes() * frames; }
};

// It is for start-up only, each object for one thread. Throws UserError that names the file when it cannot be
// read.
class DicomFile {
  public:
    explicit DicomFile(const std::filesystem::path& path);

    const std::string& name() const { return name_; }
    const DicomPixelLayout& layout() const { return layout_; }
    const gdcm::DataSet& data() const { return reader_.GetFile().GetDataSet(); }
    const gdcm::TransferSyntax& syntax() const {
        return reader_.GetFile().GetHeader().GetDataSetTransferSyntax();
    }

    // The value of a tag such as "0020|0032" as text without padding; empty when it is absent.
    std::string dicomTag(const char* tag) const;

  private:
    bool readWhole();

    std::string name_;
    gdcm::Reader reader_;
    DicomPixelLayout layout_;
};

}  // namespace bonemill
