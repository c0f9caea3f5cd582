#include "tests/unit/haptic_server/scans/import/compressed_frames.h"

#include <gdcmImage.h>
#include <gdcmImageChangeTransferSyntax.h>
#include <gdcmSequenceOfFragments.h>
#include <gdcmTrace.h>

namespace bonemill {

std::vector<std::string> compressedFrames(const std::string& words, const DicomImage& image, int frames,
                                          int syntax) {
    gdcm::Trace::WarningOff();
    gdcm::Trace::ErrorOff();
    const auto word = uint16_t(image.allocated);
    const bool fills_word = image.high + 1 != image.bits;
    const auto bits = fills_word ? word : uint16_t(image.bits);
    const gdcm::SmartPointer<gdcm::Image> owner(new gdcm::Image);  // filters own what they are given
    gdcm::Image& plain = *owner;
    plain.SetTransferSyntax(gdcm::TransferSyntax::ExplicitVRLittleEndian);
    plain.SetNumberOfDimensions(frames > 1 ? 3 : 2);
    plain.SetDimension(0, unsigned(image.columns));
    plain.SetDimension(1, unsigned(image.rows));
    if (frames > 1) plain.SetDimension(2, unsigned(frames));
    plain.SetPixelFormat(gdcm::PixelFormat(1, word, bits, uint16_t(bits - 1), *image.is_signed));
    plain.SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
    gdcm::DataElement pixels(gdcm::Tag(0x7fe0, 0x0010));
    pixels.SetByteValue(words.data(), uint32_t(words.size()));
    plain.SetDataElement(pixels);
    gdcm::ImageChangeTransferSyntax change;
    change.SetInput(plain);
    change.SetTransferSyntax(gdcm::TransferSyntax(gdcm::TransferSyntax::TSType(syntax)));
    std::vector<std::string> fragments;
    if (!change.Change()) return fragments;
    const gdcm::SequenceOfFragments* parts = change.GetOutput().GetDataElement().GetSequenceOfFragments();
    for (size_t n = 0; parts && n < parts->GetNumberOfFragments(); ++n) {
        const gdcm::ByteValue* bytes = parts->GetFragment(n).GetByteValue();
        fragments.emplace_back(bytes->GetPointer(), bytes->GetLength());
    }
    return fragments;
}

}  // namespace bonemill
