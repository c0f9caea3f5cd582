#include "haptic_server/scans/dicom/dicom_pixels.h"

#include <gdcmByteValue.h>
#include <gdcmImage.h>

#include <utility>

#include "common/base/user_error.h"
#include "haptic_server/core/volume/forget_memory.h"
#include "haptic_server/scans/confined/import_limits.h"
#include "haptic_server/scans/dicom/coded_frames.h"
#include "haptic_server/scans/dicom/dicom_groups.h"
#include "haptic_server/scans/pixels/itk_image_file.h"

namespace bonemill {
namespace {

const gdcm::Tag kFramesElement(0x7fe0, 0x0010);
const gdcm::Tag kModalityTable(0x0028, 0x3000);
const gdcm::Tag kPaddingValue(0x0028, 0x0120), kPaddingLimit(0x0028, 0x0121);

std::string bitsText(const StoredBits& bits) {
    return "Bits Allocated " + std::to_string(bits.allocated) + ", Bits Stored " +
           std::to_string(bits.stored) + ", High Bit " + std::to_string(bits.high);
}

void checkLayout(const DicomFile& file) {
    const DicomPixelLayout& layout = file.layout();
    if (!layout.bits.arePossible())
        throw UserError(file.name() + ": its pixels have " + bitsText(layout.bits) +
                        "; values within words of 8, 16 or 32 bit are read: export it anew");
    if (itemsOf(file.data(), kModalityTable))
        throw UserError(file.name() +
                        ": its values are to go through a Modality LUT, a table, which is not supported; "
                        "export it with Rescale Slope and Intercept");
}

std::optional<PixelPadding> paddingOf(const DicomFile& file) {
    // Some write them as numbers of 32 bit.
    const auto number = [&](const gdcm::Tag& tag) -> std::optional<uint16_t> {
        const std::string bytes = bytesOf(file.data(), tag);
        return numberOf<uint16_t>(bytes.substr(0, sizeof(uint16_t)));
    };
    const auto value = number(kPaddingValue), limit = number(kPaddingLimit);
    if (!value && limit)
        throw UserError(file.name() +
                        ": states a Pixel Padding Range Limit without a Pixel Padding Value; export it anew");
    if (!value) return std::nullopt;
    return paddingOf(*value, limit, file.layout().bits);
}

// An empty element is none.
const gdcm::DataElement& pixelsOf(const gdcm::DataSet& data, const std::string& file) {
    for (const uint16_t element : {uint16_t(0x0008), uint16_t(0x0009)})
        if (data.FindDataElement(gdcm::Tag(0x7fe0, element)))
            throw UserError(file + ": its pixels are floating point numbers (Float Pixel Data), which are " +
                            "not read; save it as NRRD");
    if (!data.FindDataElement(kFramesElement)) throw UserError(file + ": holds no Pixel Data");
    return data.GetDataElement(kFramesElement);
}

void requireBytes(const DicomPixelLayout& layout, uint64_t stored, const std::string& file) {
    if (stored < layout.neededBytes())
        throw UserError(file + ": Pixel Data has " + std::to_string(stored) +
                        " bytes, Rows x Columns x frames (" + std::to_string(layout.rows) + " x " +
                        std::to_string(layout.columns) + " x " + std::to_string(layout.frames) + ") need " +
                        std::to_string(layout.neededBytes()) + "; export it anew");
}

}  // namespace

void checkPixels(const DicomFile& file, const std::optional<uint64_t>& stored_bytes) {
    checkLayout(file);
    paddingOf(file);
    if (stored_bytes && !file.syntax().IsEncapsulated())
        requireBytes(file.layout(), *stored_bytes, file.name());
}

DicomPixels::DicomPixels(const std::filesystem::path& path) : name_(path.string()) {
    const DicomFile file(path);
    checkLayout(file);
    layout_ = file.layout();
    padding_ = paddingOf(file);
    const MemoryCap cap(mostMemoryToRead(path, 2 * layout_.neededBytes()));
    reader_ = std::make_unique<gdcm::Reader>();
    reader_->SetFileName(path.c_str());
    if (!reader_->Read()) throw UserError(name_ + ": cannot be read; the DICOM file is damaged");
    if (file.syntax().IsEncapsulated())
        unpack(file.syntax());
    else
        takeNative(file.syntax());
}

void DicomPixels::takeNative(const gdcm::TransferSyntax& syntax) {
    const gdcm::DataElement& pixels = pixelsOf(reader_->GetFile().GetDataSet(), name_);
    const gdcm::ByteValue* const stored = pixels.GetByteValue();
    takeCount(stored ? uint64_t(stored->GetLength()) : 0);
    bytes_ = {const_cast<char*>(stored->GetPointer()), size_t(layout_.neededBytes())};
    const bool is_big_endian = syntax.GetSwapCode() == gdcm::SwapCode::BigEndian;
    if (is_big_endian && layout_.bits.allocated == 16 && pixels.GetVR() == gdcm::VR::OB)
        throw UserError(
            name_ +
            ": its pixels have 16 bit but are written as bytes (VR OB) in a big-endian file, so that "
            "their order is not known; convert it, such as with dcmconv +te");
    if (is_big_endian && layout_.bits.allocated == 32)
        throw UserError(name_ +
                        ": its pixels have 32 bit in big-endian order, which is not read; convert it");
    // GDCM has turned the bytes of other files round.
    if (syntax != gdcm::TransferSyntax::ImplicitVRBigEndianPrivateGE || layout_.bits.allocated != 16) return;
    unpacked_.assign(bytes_.begin(), bytes_.end());
    for (size_t n = 0; n + 1 < unpacked_.size(); n += 2) std::swap(unpacked_[n], unpacked_[n + 1]);
    bytes_ = unpacked_;
}

// The library gets pictures that it has no reason to change.
void DicomPixels::unpack(const gdcm::TransferSyntax& syntax) {
    const gdcm::DataElement& pixels = pixelsOf(reader_->GetFile().GetDataSet(), name_);
    const bool is_rle = syntax == gdcm::TransferSyntax::RLELossless;
    const CodedFrames frames = codedFramesOf(pixels.GetSequenceOfFragments(), layout_, is_rle, name_);
    reader_.reset();
    const StoredBits& bits = layout_.bits;
    const auto used = uint16_t(frames.bits > 0 ? frames.bits : bits.allocated);  // words in RLE
    gdcm::Image image;
    image.SetTransferSyntax(syntax);
    image.SetNumberOfDimensions(layout_.frames > 1 ? 3 : 2);
    image.SetDimension(0, unsigned(layout_.columns));
    image.SetDimension(1, unsigned(layout_.rows));
    if (layout_.frames > 1) image.SetDimension(2, unsigned(layout_.frames));
    image.SetPixelFormat(
        gdcm::PixelFormat(1, uint16_t(bits.allocated), used, uint16_t(used - 1), bits.is_signed));
    image.SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
    gdcm::DataElement pieces(kFramesElement);
    pieces.SetValue(*frames.pieces);
    image.SetDataElement(pieces);
    takeCount(image.GetBufferLength());
    unpacked_.resize(size_t(image.GetBufferLength()));
    if (!image.GetBuffer(unpacked_.data()))
        throw UserError(name_ + ": its compressed pixels cannot be unpacked (transfer syntax " +
                        syntax.GetString() + "); the file is damaged, or of a kind that is not read");
    bytes_ = std::span(unpacked_).first(size_t(layout_.neededBytes()));
}

void DicomPixels::takeCount(uint64_t stored) {
    requireBytes(layout_, stored, name_);
    const uint64_t needed = layout_.neededBytes(), even = needed + needed % 2;
    surplus_ = stored > even ? stored - even : 0;
}

FrameValues DicomPixels::takeFrame(size_t n, const DicomRescale& rescale) {
    const auto size = size_t(layout_.frameBytes());
    const std::span<char> bytes = bytes_.subspan(n * size, size);
    FrameValues values = valuesOf(bytes, layout_.bits, padding_, rescale);
    forget(bytes);
    return values;
}

}  // namespace bonemill
