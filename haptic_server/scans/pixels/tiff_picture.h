// Reads one TIFF picture of grey values as they are stored: what is only said for a display (which value is
// white) changes nothing.
//
// There is no Eigen in here: the neighbours include ITK.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "haptic_server/core/volume/raw_values.h"

struct tiff;

namespace bonemill {

// It is for start-up only; each object is for one thread, several may read beside each other. Throws
// UserError with one message naming the file and what about it is not read: colours, a palette, turned rows,
// several pictures, values of other than 8 or 16 bit, a file that is cut short.
class TiffPicture {
  public:
    // Reads the header.
    explicit TiffPicture(const std::filesystem::path& path);

    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }
    unsigned bits() const { return bits_; }  // of a value: 8 or 16
    bool isWhiteZero() const { return is_white_zero_; }

    // Appends all values, row by row, the first row first.
    void appendValues(RawValues& values);

  private:
    struct Close {
        void operator()(tiff* file) const;
    };

    void readHeader();
    void refuseOthers() const;
    template <class T>
    void readTiles(T* pixels);
    template <class T>
    void readStrips(T* pixels);
    template <class T>
    void append(RawValues& values);

    std::string name_;
    std::unique_ptr<tiff, Close> file_;
    uint32_t width_ = 0, height_ = 0;
    unsigned bits_ = 1;
    bool is_signed_ = false, is_white_zero_ = false;
};

}  // namespace bonemill
