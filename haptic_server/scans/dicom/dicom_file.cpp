#include "haptic_server/scans/dicom/dicom_file.h"

#include <algorithm>
#include <charconv>
#include <set>

#include "common/base/user_error.h"
#include "haptic_server/scans/confined/import_limits.h"
#include "haptic_server/scans/confined/shared_name.h"
#include "haptic_server/scans/dicom/dicom_groups.h"
#include "haptic_server/scans/pixels/dicom_rescale.h"
#include "haptic_server/scans/pixels/itk_image_file.h"

namespace bonemill {
namespace {

unsigned shortOf(const gdcm::DataSet& data, uint16_t element, unsigned fallback) {
    return numberOf<uint16_t>(bytesOf(data, gdcm::Tag(0x0028, element))).value_or(uint16_t(fallback));
}

// Nothing said is one.
size_t frameCountOf(const gdcm::DataSet& data, const std::string& file) {
    const std::string text = withoutPadding(bytesOf(data, gdcm::Tag(0x0028, 0x0008)));
    if (text.empty()) return 1;
    const std::string digits = text.starts_with('+') ? text.substr(1) : text;
    size_t count = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), count);
    if (error != std::errc() || end != digits.data() + digits.size() || count < 1 || count > kMaxVoxels)
        throw UserError(file + ": its Number of Frames \"" + text + "\" is none; the header is damaged");
    return count;
}

DicomPixelLayout layoutOf(const gdcm::DataSet& data, const std::string& file) {
    DicomPixelLayout layout;
    layout.rows = int(shortOf(data, 0x0010, 0));
    layout.columns = int(shortOf(data, 0x0011, 0));
    layout.frames = frameCountOf(data, file);
    layout.samples_per_pixel = int(shortOf(data, 0x0002, 1));
    StoredBits& bits = layout.bits;
    bits.allocated = shortOf(data, 0x0100, 0);
    bits.stored = shortOf(data, 0x0101, bits.allocated);
    bits.high = shortOf(data, 0x0102, bits.stored - 1);
    bits.is_signed = shortOf(data, 0x0103, 0) != 0;
    return layout;
}

}  // namespace

DicomFile::DicomFile(const std::filesystem::path& path) : name_(path.string()) {
    noteFileBeingRead(path);
    const MemoryCap cap(mostMemoryToRead(path, 0));
    const gdcm::Tag kPixelData(0x7fe0, 0x0010);
    const std::set<gdcm::Tag> pixels{gdcm::Tag(0x7fe0, 0x0008), gdcm::Tag(0x7fe0, 0x0009), kPixelData};
    reader_.SetFileName(path.c_str());
    if (!reader_.ReadUpToTag(kPixelData, pixels) && !readWhole())
        throw UserError(name_ + ": its header cannot be read; the DICOM file is damaged");
    layout_ = layoutOf(data(), name_);
}

// The library cannot stop within a deflated data set that has sequences.
bool DicomFile::readWhole() {
    if (syntax() != gdcm::TransferSyntax::DeflatedExplicitVRLittleEndian) return false;
    reader_.SetFile(*new gdcm::File);  // which the reader owns
    reader_.SetFileName(name_.c_str());
    return reader_.Read();
}

std::string DicomFile::dicomTag(const char* tag) const {
    gdcm::Tag wanted;
    wanted.ReadFromPipeSeparatedString(tag);
    return withoutPadding(bytesOf(data(), wanted));
}

}  // namespace bonemill
