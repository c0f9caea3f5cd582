// A known ramp comes back from DICOM as it was stored, for every combination of what a header may say of it.
#include <gdcmTransferSyntax.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <span>

#include "haptic_server/scans/import/import_volume.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/scans/import/compressed_frames.h"
#include "tests/unit/haptic_server/scans/import/dicom_bytes.h"
#include "tests/unit/haptic_server/scans/import/dicom_elements.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/recoded_dicom.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {
namespace {

using gdcm::TransferSyntax;

constexpr int kFrames = 3;

struct Word {
    int allocated, stored, high;
};
constexpr Word kWords[] = {{8, 8, 7},    {8, 6, 7},  {16, 16, 15}, {16, 12, 11}, {16, 12, 15},
                           {16, 10, 13}, {16, 8, 7}, {32, 32, 31}, {32, 20, 19}};

struct Rescale {
    bool is_said;
    double slope, intercept;
};
constexpr Rescale kRescales[] = {{false, 1, 0}, {true, 1, -1024}, {true, 0.5, -100.25}, {true, -2, 7}};

enum class Padding { kNone, kValue, kRange, kRangeDownwards };
constexpr Padding kPaddings[] = {Padding::kNone, Padding::kValue, Padding::kRange, Padding::kRangeDownwards};
constexpr int kPaddingFrom = 50, kPaddingTo = 55;  // in the ramp

struct Syntax {
    TransferSyntax::TSType type;
    const char* uid;
};
constexpr Syntax kSyntaxes[] = {{TransferSyntax::ExplicitVRLittleEndian, "1.2.840.10008.1.2.1"},
                                {TransferSyntax::ImplicitVRLittleEndian, "1.2.840.10008.1.2"},
                                {TransferSyntax::ExplicitVRBigEndian, "1.2.840.10008.1.2.2"},
                                {TransferSyntax::RLELossless, "1.2.840.10008.1.2.5"},
                                {TransferSyntax::JPEGLosslessProcess14_1, "1.2.840.10008.1.2.4.70"},
                                {TransferSyntax::JPEGLSLossless, "1.2.840.10008.1.2.4.80"},
                                {TransferSyntax::JPEG2000Lossless, "1.2.840.10008.1.2.4.90"}};

struct Case {
    const char* photometric;
    bool is_signed;
    Word word;
    Padding padding;
    const char* padding_vr;
    Rescale rescale;
    bool is_multi_frame;
    Syntax syntax;

    // The encoder of JPEG 2000 takes no small pictures.
    int columns() const { return syntax.type == TransferSyntax::JPEG2000Lossless ? 33 : 6; }
    int rows() const { return columns() - 1; }
    int valueCount() const { return columns() * rows() * kFrames; }
    std::string text() const {
        return std::string(photometric) + (is_signed ? " signed " : " unsigned ") +
               std::to_string(word.allocated) + "/" + std::to_string(word.stored) + "/" +
               std::to_string(word.high) + " padding " + std::to_string(int(padding)) + padding_vr +
               " slope " + std::to_string(rescale.slope) + (is_multi_frame ? " multi-frame " : " slices ") +
               syntax.uid;
    }
};

// All that the bits hold, as far as a float does; with numbers of 16 bit where padding may be.
std::vector<int64_t> rampOf(const Case& c) {
    const int bits = std::min(c.word.stored, 24);
    const int64_t count = int64_t(1) << bits, low = c.is_signed ? -count / 2 : 0;
    std::vector<int64_t> ramp;
    const int last = c.valueCount() - 1;
    for (int n = 0; n <= last; ++n) ramp.push_back(low + (count - 1) * n / last);
    if (c.word.stored > 16)
        for (int n = kPaddingFrom; n <= kPaddingTo; ++n) ramp[size_t(n)] = 1000 + n;
    return ramp;
}

// Of the values, for several steps of a ramp of few bits are alike.
bool isPadding(const Case& c, const std::vector<int64_t>& ramp, int n) {
    if (c.padding == Padding::kNone) return false;
    const int last = c.padding == Padding::kValue ? kPaddingFrom : kPaddingTo;
    return ramp[size_t(n)] >= ramp[kPaddingFrom] && ramp[size_t(n)] <= ramp[size_t(last)];
}

// The bits that no value uses are not 0.
std::string wordsOf(const Case& c, const std::vector<int64_t>& ramp) {
    const uint64_t mask = (uint64_t(1) << c.word.stored) - 1;
    const int up = c.word.high + 1 - c.word.stored;
    std::string bytes;
    for (const int64_t value : ramp) {
        const uint64_t rest = 0xa5a5a5a5 & ~(mask << up);
        bytes += dicom::number(uint32_t((uint64_t(value) & mask) << up | rest), c.word.allocated / 8);
    }
    return bytes;
}

std::string paddingElements(const Case& c, const std::vector<int64_t>& ramp) {
    if (c.padding == Padding::kNone) return {};
    const bool is_down = c.padding == Padding::kRangeDownwards;
    const auto number = [&](int n) { return dicom::number(uint16_t(ramp[size_t(n)]), 2); };
    std::string bytes = dicom::element(0x00280120, c.padding_vr, number(is_down ? kPaddingTo : kPaddingFrom));
    if (c.padding != Padding::kValue)
        bytes += dicom::element(0x00280121, c.padding_vr, number(is_down ? kPaddingFrom : kPaddingTo));
    return bytes;
}

DicomImage imageOf(const Case& c, const std::vector<int64_t>& ramp) {
    DicomImage image;
    image.photometric = c.photometric;
    image.columns = c.columns();
    image.rows = c.rows();
    image.allocated = c.word.allocated;
    image.bits = c.word.stored;
    image.high = c.word.high;
    image.is_signed = c.is_signed;
    image.elements = paddingElements(c, ramp);
    image.has_rescale = c.rescale.is_said;
    image.slope = c.rescale.slope;
    image.intercept = c.rescale.intercept;
    image.transfer_syntax = c.syntax.uid;
    return image;
}

std::string fileOf(const Case& c, const DicomImage& image) {
    const std::string bytes = dicomBytes(image);
    if (c.syntax.type == TransferSyntax::ImplicitVRLittleEndian)
        return dicom::recodedFile(bytes, {.is_implicit = true});
    if (c.syntax.type == TransferSyntax::ExplicitVRBigEndian)
        return dicom::recodedFile(bytes, {.is_big_endian = true});
    return bytes;
}

// False where the library cannot compress such words.
bool takePixels(const Case& c, const std::string& words, int frames, DicomImage& image) {
    if (!TransferSyntax(c.syntax.type).IsEncapsulated()) {
        image.pixel_bytes = words;
        return true;
    }
    image.fragments = compressedFrames(words, image, frames, c.syntax.type);
    return !image.fragments.empty();
}

bool writeCase(const Case& c, const std::vector<int64_t>& ramp, const std::filesystem::path& folder) {
    DicomImage image = imageOf(c, ramp);
    const std::string words = wordsOf(c, ramp);
    if (c.is_multi_frame) {
        for (int k = 0; k < kFrames; ++k) image.frame_positions.push_back("0\\0\\" + std::to_string(k));
        if (c.rescale.is_said)
            image.shared_rescale =
                std::to_string(c.rescale.slope) + "|" + std::to_string(c.rescale.intercept);
        if (!takePixels(c, words, kFrames, image)) return false;
        writeBytes(folder / "0", fileOf(c, image));
        return true;
    }
    const size_t size = words.size() / kFrames;
    for (int k = 0; k < kFrames; ++k) {
        image.position = "0\\0\\" + std::to_string(k);
        image.sop_uid = "1.2.3.4." + std::to_string(k + 1);
        if (!takePixels(c, words.substr(size * size_t(k), size), 1, image)) return false;
        writeBytes(folder / std::to_string(k), fileOf(c, image));
    }
    return true;
}

void expectRamp(const Case& c, const std::vector<int64_t>& ramp, const RawVolume& raw) {
    ASSERT_EQ(raw.values.size(), size_t(c.valueCount())) << c.text();
    double lowest = std::numeric_limits<double>::max();
    const auto scaled = [&](int n) {
        return c.rescale.slope * double(ramp[size_t(n)]) + c.rescale.intercept;
    };
    for (int n = 0; n < c.valueCount(); ++n)
        if (!isPadding(c, ramp, n)) lowest = std::min(lowest, scaled(n));
    for (int n = 0; n < c.valueCount(); ++n)
        ASSERT_NEAR(raw.values[size_t(n)], isPadding(c, ramp, n) ? lowest : scaled(n), 1)
            << c.text() << ", value " << n;
    EXPECT_NEAR(raw.values.range().low, lowest, 1) << c.text();
    EXPECT_EQ(raw.description.find("are padding") != std::string::npos, c.padding != Padding::kNone)
        << c.text();
}

// Of all that may be combined for plain files; what the pixels' coding has to do with, for the others.
template <class See>
void forEachCase(const Syntax& syntax, See&& see) {
    const bool is_plain = syntax.type == TransferSyntax::ExplicitVRLittleEndian;
    const std::span rescales = std::span(kRescales).last(is_plain ? std::size(kRescales) : 2);
    for (const char* photometric : {"MONOCHROME2", "MONOCHROME1"})
        for (const bool is_signed : {false, true})
            for (const Word& word : kWords)
                for (const Padding padding : kPaddings)
                    for (const char* vr : {"US", "SS"})
                        for (const Rescale& rescale : rescales)
                            for (const bool is_multi_frame : {false, true}) {
                                if (padding == Padding::kNone && vr[0] == 'S') continue;
                                if (padding != Padding::kNone && !is_plain &&
                                    (padding != Padding::kRange || vr[0] == 'U'))
                                    continue;
                                see(Case{photometric, is_signed, word, padding, vr, rescale, is_multi_frame,
                                         syntax});
                            }
}

// JPEG has no words of 32 bit; the others are not read with their bytes turned round.
bool canHold(const Syntax& syntax, const Word& word) {
    static const TransferSyntax::TSType kWide[] = {TransferSyntax::ExplicitVRLittleEndian,
                                                   TransferSyntax::ImplicitVRLittleEndian,
                                                   TransferSyntax::RLELossless};
    return word.allocated < 32 || std::ranges::find(kWide, syntax.type) != std::end(kWide);
}

class StoredValues : public testing::TestWithParam<Syntax> {};

TEST_P(StoredValues, everyRampComesBack) {
    const test::TemporaryFolder folder;
    std::map<bool, int> read;
    forEachCase(GetParam(), [&](const Case& c) {
        if (testing::Test::HasFailure()) return;
        if (!canHold(c.syntax, c.word)) return;
        const auto at = folder / (c.is_multi_frame ? "frames" : "slices");
        std::filesystem::create_directories(at);
        const std::vector<int64_t> ramp = rampOf(c);
        const bool is_written = writeCase(c, ramp, at);
        ++read[is_written];
        if (is_written) expectRamp(c, ramp, importVolumeHere(at));
    });
    std::cout << GetParam().uid << ": " << read[true] << " ramps, " << read[false]
              << " that GDCM cannot write\n";
    EXPECT_GE(read[true], 100);
}

INSTANTIATE_TEST_SUITE_P(Dicom, StoredValues, testing::ValuesIn(kSyntaxes),
                         [](const auto& info) { return "syntax" + std::to_string(info.index); });

}  // namespace
}  // namespace bonemill
