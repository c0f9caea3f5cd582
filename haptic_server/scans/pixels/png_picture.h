// Reads one PNG picture of grey values as they are stored: what is only said for a display (gamma,
// significant bits) changes nothing.
//
// There is no Eigen in here: the neighbours include ITK.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "haptic_server/core/volume/raw_values.h"

namespace bonemill {

// It is for start-up only; each object is for one thread, several may read beside each other. Throws
// UserError with one message naming the file and what about it is not read: colours, a palette, transparent
// places, values of other than 8 or 16 bit, damage.
class PngPicture {
  public:
    // Reads the header.
    explicit PngPicture(const std::filesystem::path& path);
    ~PngPicture();
    PngPicture(const PngPicture&) = delete;
    PngPicture& operator=(const PngPicture&) = delete;

    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }
    unsigned bits() const { return bits_; }  // of a value: 8 or 16
    bool isWhiteZero() const { return false; }

    // Appends all values, row by row, the first row first.
    void appendValues(RawValues& values);

  private:
    struct Reading;

    void refuseOthers() const;
    template <class T>
    void append(RawValues& values);

    std::string name_;
    std::unique_ptr<Reading> reading_;
    uint32_t width_ = 0, height_ = 0;
    unsigned bits_ = 0;
};

}  // namespace bonemill
