// Pixels that are fewer, more or other than a DICOM header says are refused or said, for what they are.
#include <gdcmTransferSyntax.h>
#include <gtest/gtest.h>

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

constexpr int kSlices = 3, kPixels = 48 * 40;
constexpr TransferSyntax::TSType kCompressed[] = {
    TransferSyntax::RLELossless, TransferSyntax::JPEGLosslessProcess14_1, TransferSyntax::JPEGLSLossless,
    TransferSyntax::JPEG2000Lossless};

class DicomPixelsTest : public testing::Test {
  protected:
    // Writes a stack of slices, each changed; one file of all as frames where that is wanted.
    template <class Change>
    void write(Change change, bool is_multi_frame = false) {
        std::filesystem::remove_all(folder_ / "scan");
        std::filesystem::create_directories(folder_ / "scan");
        if (is_multi_frame) {
            DicomImage image = imageOf(kSlices);
            for (int k = 0; k < kSlices; ++k) image.frame_positions.push_back("0\\0\\" + std::to_string(k));
            change(image, 0);
            return writeDicomFile(folder_ / "scan/frames", image);
        }
        for (int k = 0; k < kSlices; ++k) {
            DicomImage image = imageOf(1);
            image.position = "0\\0\\" + std::to_string(k);
            image.sop_uid = "1.2.3.4." + std::to_string(k + 1);
            change(image, k);
            writeDicomFile(folder_ / ("scan/slice" + std::to_string(k)), image);
        }
    }
    void expectRefused(std::initializer_list<std::string> words) {
        expectUserError([&] { importVolume(folder_ / "scan"); }, words);
    }
    RawVolume imported() { return importVolume(folder_ / "scan"); }

    // 12 bit of structure that does not shrink to nothing.
    static DicomImage imageOf(int frames) {
        DicomImage image;
        image.columns = 48;
        image.rows = 40;
        image.allocated = 16;
        image.bits = 12;
        image.high = 11;
        image.is_signed = false;
        for (int n = 0; n < frames * kPixels; ++n)
            image.pixel_bytes += dicom::number(uint32_t(n * 2654435761u >> 20), 2);
        return image;
    }
    static void compress(DicomImage& image, int frames, TransferSyntax::TSType syntax) {
        image.fragments = compressedFrames(image.pixel_bytes, image, frames, syntax);
        image.transfer_syntax = TransferSyntax::GetTSString(syntax);
        ASSERT_EQ(image.fragments.size(), size_t(frames));
    }

    test::TemporaryFolder folder_;
};

TEST_F(DicomPixelsTest, fewerBytesAreRefusedInOneInAllAndInFrames) {
    write([](DicomImage& image, int k) {
        if (k == 1) image.pixel_bytes.resize(kPixels);
    });
    expectRefused({"slice1", "Pixel Data has 1920 bytes", "Rows x Columns x frames (40 x 48 x 1) need 3840"});
    write([](DicomImage& image, int) { image.pixel_bytes.resize(2 * kPixels - 2); });
    expectRefused({"slice0", "Pixel Data has 3838 bytes", "need 3840"});
    write([](DicomImage& image, int) { image.pixel_bytes.resize(2 * 2 * kPixels); }, true);
    expectRefused({"frames", "Pixel Data has 7680 bytes", "(40 x 48 x 3) need 11520"});
}

TEST_F(DicomPixelsTest, moreThanOneByteToFillUpIsSaid) {
    write([](DicomImage& image, int k) {
        if (k > 0) image.pixel_bytes += "xx";
    });
    const std::string said = imported().description;
    EXPECT_NE(said.find("2 files with more Pixel Data than Rows x Columns x frames need, the rest not read "
                        "(slice1, ...)"),
              std::string::npos)
        << said;
    const auto odd = [](DicomImage& image, int) {  // five pixels of a byte, and one to make them even
        image.columns = 5;
        image.rows = 3;
        image.allocated = image.bits = 8;
        image.high = 7;
        image.pixel_bytes.resize(15);
    };
    write(odd);
    EXPECT_EQ(imported().description.find("more Pixel Data"), std::string::npos);
}

TEST_F(DicomPixelsTest, compressedPixelsThatAreFewerAreRefused) {
    for (const auto syntax : kCompressed)
        for (const bool is_multi_frame : {false, true}) {
            const int frames = is_multi_frame ? kSlices : 1;
            SCOPED_TRACE(TransferSyntax::GetTSString(syntax) +
                         std::string(is_multi_frame ? " frames" : " slices"));
            write([&](DicomImage& image, int) { compress(image, frames, syntax); }, is_multi_frame);
            EXPECT_NO_THROW(imported());
            write(
                [&](DicomImage& image, int k) {
                    compress(image, frames, syntax);
                    std::string& last = image.fragments.back();
                    if (k == 0) last.resize(last.size() / 4 * 2);
                },
                is_multi_frame);
            expectRefused({is_multi_frame ? "frames" : "slice0"});
            write(
                [&](DicomImage& image, int k) {
                    compress(image, frames, syntax);
                    if (k == 0) image.fragments.pop_back();
                    if (k == 0 && !is_multi_frame) image.fragments.push_back("");
                },
                is_multi_frame);
            expectRefused({is_multi_frame ? "its 3 frames need" : "slice0"});
        }
}

// GDCM writes values of 12 bit as words of 16, other programs do not.
void sayTwelveBits(std::string& picture) {
    for (const char* start_of_frame : {"\xff\xc3", "\xff\xf7"})
        if (const size_t at = picture.find(start_of_frame); at != std::string::npos) picture[at + 4] = 12;
    if (picture.starts_with("\xff\x4f")) picture[42] = 11;
}

// In RLE a picture's own bytes say only how many pixels of how many bytes there are.
TEST_F(DicomPixelsTest, compressedPicturesThatContradictTheHeaderAreRefused) {
    struct Lie {
        const char* said;
        bool is_of_rle, is_of_jpeg2000_only;
        void (*tell)(DicomImage&);
    };
    const Lie kLies[] = {{"Rows x Columns", true, false, [](DicomImage& image) { image.rows -= 2; }},
                         {"Rows x Columns", true, false, [](DicomImage& image) { image.columns += 2; }},
                         {"Rows x Columns", false, false,
                          [](DicomImage& image) {
                              image.rows *= 2;
                              image.columns /= 2;
                          }},
                         {"Bits Stored 16", false, false,
                          [](DicomImage& image) {
                              image.bits = 16;
                              image.high = 15;
                          }},
                         {"Bits Stored 10", false, false,
                          [](DicomImage& image) {
                              image.bits = 10;
                              image.high = 9;
                          }},
                         {"High Bit 15", false, false, [](DicomImage& image) { image.high = 15; }},
                         {"Bits Allocated 8", true, false,
                          [](DicomImage& image) {
                              image.allocated = image.bits = 8;
                              image.high = 7;
                          }},
                         {"Pixel Representation", false, true,
                          [](DicomImage& image) { image.is_signed = !*image.is_signed; }}};
    for (const auto syntax : kCompressed)
        for (const Lie& lie : kLies) {
            if (syntax == TransferSyntax::RLELossless && !lie.is_of_rle) continue;
            if (syntax != TransferSyntax::JPEG2000Lossless && lie.is_of_jpeg2000_only) continue;
            for (const bool is_multi_frame : {false, true}) {
                SCOPED_TRACE(TransferSyntax::GetTSString(syntax) + std::string(" ") + lie.said);
                write(
                    [&](DicomImage& image, int) {
                        compress(image, is_multi_frame ? kSlices : 1, syntax);
                        for (std::string& picture : image.fragments) sayTwelveBits(picture);
                        lie.tell(image);
                    },
                    is_multi_frame);
                expectRefused({is_multi_frame ? "frames frame 1" : "slice0", lie.said, "compressed picture"});
            }
        }
}

TEST_F(DicomPixelsTest, compressedPicturesBeyondTheFramesAreRefusedAndSpreadOnesRead) {
    for (const auto syntax : kCompressed) {
        SCOPED_TRACE(TransferSyntax::GetTSString(syntax));
        for (const bool is_at_end : {false, true}) {
            const auto addOne = [&](DicomImage& image, int) {
                compress(image, kSlices, syntax);
                const std::string first = image.fragments.front();
                image.fragments.insert(is_at_end ? image.fragments.end() : image.fragments.begin(), first);
            };
            write(addOne, true);
            expectRefused({"frames", "holds 4 compressed pictures", "its 3 frames need"});
        }
        const auto spread = [&](DicomImage& image, int) {
            compress(image, kSlices, syntax);
            std::vector<std::string> halves;
            for (const std::string& whole : image.fragments) {
                halves.push_back(whole.substr(0, whole.size() / 4 * 2));
                halves.push_back(whole.substr(whole.size() / 4 * 2));
            }
            image.fragments = halves;
        };
        write(spread, true);
        if (syntax == TransferSyntax::RLELossless) {  // where each fragment is a picture
            expectRefused({"frames", "holds 6 compressed pictures"});
            continue;
        }
        const RawVolume raw = imported();
        for (size_t n = 0; n < kSlices * kPixels; ++n)
            ASSERT_EQ(raw.values[n], float(uint32_t(n) * 2654435761u >> 20));
    }
}

TEST_F(DicomPixelsTest, bitsThatCannotBeAreRefused) {
    struct Bits {
        int allocated, stored, high;
    };
    for (const Bits& bits :
         {Bits{16, 17, 16}, Bits{16, 12, 10}, Bits{16, 12, 16}, Bits{12, 12, 11}, Bits{1, 1, 0}}) {
        write([&](DicomImage& image, int) {
            image.allocated = bits.allocated;
            image.bits = bits.stored;
            image.high = bits.high;
        });
        expectRefused({"slice0", "Bits Allocated " + std::to_string(bits.allocated), "export it anew"});
    }
}

// Bytes have no order, words in big-endian files do.
TEST_F(DicomPixelsTest, wordsThatAreSaidToBeBytesAreRefusedInBigEndianFiles) {
    std::filesystem::create_directories(folder_ / "scan");
    for (int k = 0; k < kSlices; ++k) {
        DicomImage image = imageOf(1);
        image.position = "0\\0\\" + std::to_string(k);
        image.transfer_syntax = TransferSyntax::GetTSString(TransferSyntax::ExplicitVRBigEndian);
        std::string bytes = dicom::recodedFile(dicomBytes(image), {.is_big_endian = true});
        bytes.replace(bytes.rfind("OW"), 2, "OB");
        writeBytes(folder_ / ("scan/slice" + std::to_string(k)), bytes);
    }
    expectRefused({"slice0", "16 bit", "OB", "big-endian", "convert"});
}

TEST_F(DicomPixelsTest, valuesOfATableAreRefusedForIt) {
    using dicom::element, dicom::item, dicom::shortElement;
    const std::string table =
        item(element(0x00283002, "US", dicom::number(4, 2) + dicom::number(0, 2) + dicom::number(16, 2)) +
             element(0x00283006, "US", std::string(8, 'x')));
    write([&](DicomImage& image, int) { image.last_elements = element(0x00283000, "SQ", table); });
    expectRefused({"slice0", "Modality LUT", "Rescale Slope"});
    // These are only for a display.
    write([&](DicomImage& image, int) {
        image.last_elements = element(0x00281050, "DS", "40") + element(0x00281051, "DS", "400") +
                              element(0x00283010, "SQ", table) + element(0x20500020, "CS", "INVERSE");
    });
    const RawVolume raw = imported();
    for (size_t n = 0; n < kPixels; ++n) ASSERT_EQ(raw.values[n], float(uint32_t(n) * 2654435761u >> 20));
    write([&](DicomImage& image, int) {
        image.photometric = "PALETTE COLOR";
        image.allocated = image.bits = 8;
        image.high = 7;
    });
    expectRefused({"3 colour images", "palette", "slice0"});
}

TEST_F(DicomPixelsTest, paddingOfEverySliceAndOfAllIsNoData) {
    const std::string padding = dicom::element(0x00280120, "US", dicom::number(4000, 2));
    const auto fill = [](DicomImage& image, uint32_t value) {
        image.pixel_bytes.clear();
        for (int n = 0; n < kPixels; ++n) image.pixel_bytes += dicom::number(value, 2);
    };
    write([&](DicomImage& image, int k) {  // the first slice holds nothing
        image.elements = padding;
        fill(image, k == 0 ? 4000 : uint32_t(1000 - 100 * k));
    });
    const RawVolume raw = imported();
    EXPECT_EQ(raw.values[0], 800);
    EXPECT_EQ(raw.values[kPixels], 900);
    EXPECT_EQ(raw.values.range().high, 900);
    write([&](DicomImage& image, int) {
        image.elements = padding;
        fill(image, 4000);
    });
    expectRefused({"no value but its Pixel Padding Value"});
    write([&](DicomImage& image, int) {
        image.elements = dicom::element(0x00280121, "US", dicom::number(4000, 2));
    });
    expectRefused({"slice0", "Pixel Padding Range Limit"});
}

// What values of 12 bit cannot hold stands in whole words.
TEST_F(DicomPixelsTest, paddingBeyondTheValuesBitsIsSoughtInWords) {
    write([](DicomImage& image, int) {
        image.elements = dicom::element(0x00280120, "SS", dicom::number(63536, 2));
        image.pixel_bytes.replace(0, 4, dicom::number(63536, 2) + dicom::number(63536 & 0xfff, 2));
    });
    const RawVolume raw = imported();
    EXPECT_EQ(raw.values[0], raw.values.range().low);
    EXPECT_EQ(raw.values[1], 63536 & 0xfff);
    EXPECT_NE(raw.description.find("3 voxels are padding"), std::string::npos) << raw.description;
}

TEST_F(DicomPixelsTest, moreFramesThanMayBeAreNoFrames) {
    write([](DicomImage& image, int) { image.frame_count = "0"; }, true);
    expectRefused({"frames", "Number of Frames"});
    write([](DicomImage& image, int) { image.frame_count = "3000000000"; }, true);
    expectRefused({"frames", "Number of Frames"});
}

}  // namespace
}  // namespace bonemill
