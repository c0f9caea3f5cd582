#include "haptic_server/scans/pixels/tiff_picture.h"

#include <tiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <mutex>
#include <type_traits>
#include <vector>

#include "common/base/user_error.h"
#include "haptic_server/scans/confined/import_limits.h"
#include "haptic_server/scans/confined/shared_name.h"
#include "haptic_server/scans/pixels/itk_image_file.h"

namespace bonemill {
namespace {

// Of the library, of this thread.
thread_local std::string last_error;
thread_local bool are_counts_wrong = false;

std::string textOf(const char* format, va_list arguments) {
    char text[256];
    std::vsnprintf(text, sizeof text, format, arguments);
    return text;
}

void keepError(const char*, const char* format, va_list arguments) {
    last_error = textOf(format, arguments);
}

// The library reads on behind a strip that is said to have fewer bytes than it needs, whatever lies
// there.
void keepWarning(const char*, const char* format, va_list arguments) {
    const std::string text = textOf(format, arguments);
    if (text.find("ByteCounts") != std::string::npos && text.find("ignoring") != std::string::npos)
        are_counts_wrong = true;
}

void takeErrors() {
    static std::once_flag once;
    std::call_once(once, [] {
        TIFFSetErrorHandler(keepError);
        TIFFSetWarningHandler(keepWarning);
    });
    last_error.clear();
    are_counts_wrong = false;
}

std::string because() {
    return last_error.empty() ? "" : ": " + oneLine(last_error);
}

// Of a field with a default.
template <class T>
T field(TIFF* file, uint32_t tag) {
    T value{};
    TIFFGetFieldDefaulted(file, tag, &value);
    return value;
}

// Previews and masks are no pictures.
bool isPicture(TIFF* file) {
    constexpr uint32_t kNone = FILETYPE_REDUCEDIMAGE | FILETYPE_MASK;
    return (field<uint32_t>(file, TIFFTAG_SUBFILETYPE) & kNone) == 0;
}

bool holdsAnother(TIFF* file) {
    while (TIFFReadDirectory(file))
        if (isPicture(file)) return true;
    return false;
}

}  // namespace

void TiffPicture::Close::operator()(tiff* file) const {
    TIFFClose(file);
}

TiffPicture::TiffPicture(const std::filesystem::path& path) : name_(path.string()) {
    noteFileBeingRead(path);
    const MemoryCap cap(mostMemoryToRead(path, 0));
    takeErrors();
    file_.reset(TIFFOpen(path.c_str(), "rm"));  // not mapped: a file that shrinks would end this process
    if (!file_) throw UserError(name_ + ": its header cannot be read" + because());
    if (are_counts_wrong)
        throw UserError(name_ +
                        ": says that its pixels have other bytes than they need; the file is damaged");
    if (holdsAnother(file_.get()))
        throw UserError(name_ + ": holds several images; save each slice as a file of its own");
    if (!TIFFSetDirectory(file_.get(), 0)) throw UserError(name_ + ": its header cannot be read" + because());
    readHeader();
    refuseOthers();
}

void TiffPicture::readHeader() {
    TIFFGetField(file_.get(), TIFFTAG_IMAGEWIDTH, &width_);
    TIFFGetField(file_.get(), TIFFTAG_IMAGELENGTH, &height_);
    bits_ = field<uint16_t>(file_.get(), TIFFTAG_BITSPERSAMPLE);
    is_signed_ = field<uint16_t>(file_.get(), TIFFTAG_SAMPLEFORMAT) == SAMPLEFORMAT_INT;
    uint16_t photometric = PHOTOMETRIC_MINISBLACK;
    TIFFGetField(file_.get(), TIFFTAG_PHOTOMETRIC, &photometric);
    is_white_zero_ = photometric == PHOTOMETRIC_MINISWHITE;
}

void TiffPicture::refuseOthers() const {
    uint16_t photometric = PHOTOMETRIC_MINISBLACK;
    TIFFGetField(file_.get(), TIFFTAG_PHOTOMETRIC, &photometric);
    if (photometric == PHOTOMETRIC_PALETTE)
        throw UserError(name_ +
                        ": its values are numbers of a palette's colours; save the slices as grey images");
    if (field<uint16_t>(file_.get(), TIFFTAG_SAMPLESPERPIXEL) != 1 || photometric == PHOTOMETRIC_RGB)
        throw UserError(name_ + ": is in colour or has transparent places; save the slices as grey images");
    if (photometric != PHOTOMETRIC_MINISBLACK && photometric != PHOTOMETRIC_MINISWHITE)
        throw UserError(name_ + ": its photometric interpretation " + std::to_string(photometric) +
                        " is not grey (0 or 1); save the slices as grey images");
    const auto orientation = field<uint16_t>(file_.get(), TIFFTAG_ORIENTATION);
    if (orientation != ORIENTATION_TOPLEFT)
        throw UserError(name_ + ": its rows are to be turned or mirrored (orientation " +
                        std::to_string(orientation) + "), which is not done; save the slices upright (1)");
    const auto format = field<uint16_t>(file_.get(), TIFFTAG_SAMPLEFORMAT);
    if ((bits_ != 8 && bits_ != 16) ||
        (format != SAMPLEFORMAT_UINT && format != SAMPLEFORMAT_INT && format != SAMPLEFORMAT_VOID))
        throw UserError(name_ + ": has " + std::to_string(bits_) + " bit per pixel" +
                        (format == SAMPLEFORMAT_IEEEFP ? " (floating point)" : "") +
                        "; save the slices with 8 or 16 bit, whole numbers");
}

void TiffPicture::appendValues(RawValues& values) {
    const MemoryCap cap(mostMemoryToRead(name_, uint64_t(width_) * height_ * bits_ / 8));
    takeErrors();
    if (bits_ == 8)
        is_signed_ ? append<int8_t>(values) : append<uint8_t>(values);
    else
        is_signed_ ? append<int16_t>(values) : append<uint16_t>(values);
}

template <class T>
void TiffPicture::append(RawValues& values) {
    std::vector<T> pixels(size_t(width_) * height_);
    if (TIFFIsTiled(file_.get()))
        readTiles(pixels.data());
    else
        readStrips(pixels.data());
    if constexpr (std::is_same_v<T, int8_t>)
        values.append(std::vector<int16_t>(pixels.begin(), pixels.end()));
    else
        values.append(std::move(pixels));
}

// The tiles at the right and lower edge reach beyond the picture.
template <class T>
void TiffPicture::readTiles(T* pixels) {
    uint32_t columns = 0, rows = 0;
    TIFFGetField(file_.get(), TIFFTAG_TILEWIDTH, &columns);
    TIFFGetField(file_.get(), TIFFTAG_TILELENGTH, &rows);
    const tmsize_t size = TIFFTileSize(file_.get());
    if (columns == 0 || rows == 0 || size != tmsize_t(uint64_t(columns) * rows * sizeof(T)))
        throw UserError(name_ + ": its tiles are of no possible size; the file is damaged");
    // The library reads on behind a tile that is said to have fewer bytes than it needs, whatever lies there.
    const bool is_plain = field<uint16_t>(file_.get(), TIFFTAG_COMPRESSION) == COMPRESSION_NONE;
    for (uint32_t n = 0; is_plain && n < TIFFNumberOfTiles(file_.get()); ++n)
        if (TIFFGetStrileByteCount(file_.get(), n) < uint64_t(size))
            throw UserError(name_ + ": its tiles are said to have fewer bytes than they need; it is damaged");
    std::vector<T> tile(size_t(size) / sizeof(T));
    for (uint32_t y = 0; y < height_; y += std::min(rows, height_ - y))
        for (uint32_t x = 0; x < width_; x += std::min(columns, width_ - x)) {
            if (TIFFReadEncodedTile(file_.get(), TIFFComputeTile(file_.get(), x, y, 0, 0), tile.data(),
                                    size) != size)
                throw UserError(name_ + ": its tiles cannot be read" + because());
            for (uint32_t row = 0; row < std::min(rows, height_ - y); ++row)
                std::copy_n(tile.data() + size_t(row) * columns, std::min(columns, width_ - x),
                            pixels + size_t(y + row) * width_ + x);
        }
}

template <class T>
void TiffPicture::readStrips(T* pixels) {
    if (TIFFScanlineSize(file_.get()) != tmsize_t(width_ * sizeof(T)))
        throw UserError(name_ + ": its rows are of no possible size; the file is damaged");
    for (uint32_t y = 0; y < height_; ++y)
        if (TIFFReadScanline(file_.get(), pixels + size_t(y) * width_, y, 0) != 1)
            throw UserError(name_ + ": its rows cannot be read" + because());
}

}  // namespace bonemill
