#include "haptic_server/scans/pixels/png_picture.h"

#include <png.h>

#include <csetjmp>
#include <cstdio>
#include <vector>

#include "common/base/user_error.h"
#include "haptic_server/scans/confined/import_limits.h"
#include "haptic_server/scans/confined/shared_name.h"
#include "haptic_server/scans/pixels/itk_image_file.h"

namespace bonemill {
namespace {

constexpr size_t kMaxText = 128;

// The library wants its caller to jump out of it.
[[noreturn]] void keepErrorAndJump(png_structp png, png_const_charp why) {
    std::snprintf(static_cast<char*>(png_get_error_ptr(png)), kMaxText, "%s", why);
    png_longjmp(png, 1);
}

void passOver(png_structp, png_const_charp) {}

}  // namespace

struct PngPicture::Reading {
    FILE* file = nullptr;
    png_structp png = nullptr;
    png_infop info = nullptr;
    char error[kMaxText] = "memory is short";

    explicit Reading(const std::string& name)
        : file(std::fopen(name.c_str(), "rbe")),
          png(png_create_read_struct(PNG_LIBPNG_VER_STRING, error, keepErrorAndJump, passOver)),
          info(png ? png_create_info_struct(png) : nullptr) {
        if (!file) std::snprintf(error, kMaxText, "it cannot be opened");
    }
    ~Reading() {
        png_destroy_read_struct(&png, &info, nullptr);
        if (file) std::fclose(file);
    }
    Reading(const Reading&) = delete;
    Reading& operator=(const Reading&) = delete;

    // No object may live in these: a jump would pass its destructor over. Both are false where `error` says
    // why.
    bool readHeader() noexcept {
        if (!file || !info || setjmp(png_jmpbuf(png))) return false;
        png_init_io(png, file);
        png_read_info(png, info);
        return true;
    }
    bool readRows(png_bytepp rows) noexcept {
        if (setjmp(png_jmpbuf(png))) return false;
        png_set_swap(png);  // of 16 bit, which are stored with the high byte first
        png_set_interlace_handling(png);
        png_read_update_info(png, info);
        png_read_image(png, rows);
        png_read_end(png, nullptr);
        return true;
    }
};

PngPicture::PngPicture(const std::filesystem::path& path) : name_(path.string()) {
    noteFileBeingRead(path);
    const MemoryCap cap(mostMemoryToRead(path, 0));
    reading_ = std::make_unique<Reading>(name_);
    if (!reading_->readHeader())
        throw UserError(name_ + ": its header cannot be read: " + oneLine(reading_->error));
    width_ = png_get_image_width(reading_->png, reading_->info);
    height_ = png_get_image_height(reading_->png, reading_->info);
    bits_ = png_get_bit_depth(reading_->png, reading_->info);
    refuseOthers();
}

PngPicture::~PngPicture() = default;

void PngPicture::refuseOthers() const {
    const int colour = png_get_color_type(reading_->png, reading_->info);
    if (colour == PNG_COLOR_TYPE_PALETTE)
        throw UserError(name_ +
                        ": its values are numbers of a palette's colours; save the slices as grey images");
    if (colour != PNG_COLOR_TYPE_GRAY || png_get_valid(reading_->png, reading_->info, PNG_INFO_tRNS) != 0)
        throw UserError(name_ + ": is in colour or has transparent places; save the slices as grey images");
    if (bits_ != 8 && bits_ != 16)
        throw UserError(name_ + ": has " + std::to_string(bits_) +
                        " bit per pixel; save the slices with 8 or 16 bit");
}

void PngPicture::appendValues(RawValues& values) {
    const MemoryCap cap(mostMemoryToRead(name_, uint64_t(width_) * height_ * bits_ / 8));
    if (bits_ == 8)
        append<uint8_t>(values);
    else
        append<uint16_t>(values);
}

template <class T>
void PngPicture::append(RawValues& values) {
    std::vector<T> pixels(size_t(width_) * height_);
    std::vector<png_bytep> rows;
    for (uint32_t y = 0; y < height_; ++y)
        rows.push_back(reinterpret_cast<png_bytep>(pixels.data() + size_t(y) * width_));
    if (!reading_->readRows(rows.data()))
        throw UserError(name_ + ": its pixels cannot be read: " + oneLine(reading_->error));
    values.append(std::move(pixels));
}

}  // namespace bonemill
