// The pixels of one DICOM file as they are stored: nothing that libraries do to them for a display or for
// people (inversion of MONOCHROME1, tables, rescaling) is done.
#pragma once

#include <gdcmReader.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "haptic_server/scans/dicom/dicom_file.h"
#include "haptic_server/scans/dicom/stored_bits.h"

namespace bonemill {

// Throws as DicomPixels does for all that a file's header tells, so that no series is recommended that is
// then refused. `stored_bytes` are those of its pixels; nothing: they are compressed.
void checkPixels(const DicomFile& file, const std::optional<uint64_t>& stored_bytes);

// It is for start-up only, each object for one thread. Throws UserError that names the file and says why:
// fewer bytes than its frames need, values that are to go through a table, bits that cannot be, damaged
// pixels.
class DicomPixels {
  public:
    explicit DicomPixels(const std::filesystem::path& path);

    size_t frameCount() const { return layout_.frames; }
    size_t frameSize() const { return size_t(layout_.columns) * size_t(layout_.rows); }  // values
    // Of frame n, which is one of the file's. Its memory goes back to the system, so that each is asked for
    // once.
    FrameValues takeFrame(size_t n, const DicomRescale& rescale);
    // Bytes beyond the frames and the one that makes their count even.
    uint64_t surplus() const { return surplus_; }

  private:
    void takeNative(const gdcm::TransferSyntax& syntax);
    void unpack(const gdcm::TransferSyntax& syntax);
    void takeCount(uint64_t stored);

    std::string name_;
    DicomPixelLayout layout_;
    std::optional<PixelPadding> padding_;
    std::unique_ptr<gdcm::Reader> reader_;  // nothing once its pixels are unpacked
    std::vector<char> unpacked_;
    std::span<char> bytes_;  // in either of them
    uint64_t surplus_ = 0;
};

}  // namespace bonemill
