// Writes TIFF pictures of every kind byte by byte.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "tests/unit/haptic_server/scans/import/deflated_bytes.h"

namespace bonemill {

struct TiffKind {
    int photometric = 1;  // 0: 0 is shown white
    int bits = 16, samples = 1;
    bool is_signed = false, is_big_endian = false, is_packed = false;
    int rows_per_strip = 1;  // 0: tiles of 16 x 16
    int orientation = 1;
    int missing_bytes = 0;  // of each part's end, though it is said to have them
};

class TiffWriter {
  public:
    TiffWriter(const TiffKind& kind, int columns, const std::vector<double>& values)
        : kind_(kind), columns_(columns), rows_(int(values.size()) / columns), values_(values) {}

    std::string bytes() {
        file_ = kind_.is_big_endian ? "MM" : "II";
        file_ += put(42, 2) + put(0, 4);
        if (kind_.rows_per_strip == 0)
            writeTiles();
        else
            for (int row = 0; row < rows_; row += kind_.rows_per_strip)
                addPart(region(0, row, columns_, std::min(kind_.rows_per_strip, rows_ - row)));
        writeDirectory();
        return file_;
    }

  private:
    std::string put(uint64_t value, int bytes) const {
        std::string text;
        for (int b = 0; b < bytes; ++b) text += char(value >> (8 * b) & 0xff);
        if (kind_.is_big_endian) std::reverse(text.begin(), text.end());
        return text;
    }
    // What lies beyond the picture is not 0.
    std::string region(int column, int row, int width, int height) const {
        std::string bytes;
        for (int j = row; j < row + height; ++j)
            for (int i = column; i < column + width; ++i) {
                const bool is_inside = i < columns_ && j < rows_;
                const double value = is_inside ? values_[size_t(j * columns_ + i)] : 77;
                for (int s = 0; s < kind_.samples; ++s)
                    bytes += put(uint64_t(int64_t(value)), (kind_.bits + 7) / 8);
            }
        return bytes;
    }
    void writeTiles() {
        for (int row = 0; row < rows_; row += kTile)
            for (int column = 0; column < columns_; column += kTile)
                addPart(region(column, row, kTile, kTile));
    }
    void addPart(const std::string& plain) {
        std::string part = kind_.is_packed ? deflated(plain, DeflateHead::kZlib) : plain;
        part.resize(part.size() - size_t(kind_.missing_bytes));
        offsets_.push_back(uint32_t(file_.size()));
        counts_.push_back(uint32_t(part.size()));
        file_ += part;
        if (file_.size() % 2) file_ += '\0';
    }
    void entry(int tag, const std::vector<uint32_t>& numbers, int size) {
        std::string value;
        for (const uint32_t number : numbers) value += put(number, size);
        directory_ += put(uint64_t(tag), 2) + put(size == 2 ? 3 : 4, 2) + put(numbers.size(), 4);
        if (value.size() > 4) {
            directory_ += put(file_.size(), 4);
            file_ += value;
        } else {
            directory_ += value + std::string(4 - value.size(), '\0');
        }
        ++entries_;
    }
    void writeDirectory() {
        const auto word = [&](int tag, int value) { entry(tag, {uint32_t(value)}, 2); };
        word(256, columns_);
        word(257, rows_);
        word(258, kind_.bits);
        word(259, kind_.is_packed ? 8 : 1);
        word(262, kind_.photometric);
        const bool is_tiled = kind_.rows_per_strip == 0;
        if (!is_tiled) entry(273, offsets_, 4);
        word(274, kind_.orientation);
        word(277, kind_.samples);
        if (!is_tiled) word(278, kind_.rows_per_strip);
        if (!is_tiled) entry(279, counts_, 4);
        if (kind_.photometric == 3) entry(320, std::vector<uint32_t>(3u << kind_.bits, 9), 2);
        if (is_tiled) {
            word(322, kTile);
            word(323, kTile);
            entry(324, offsets_, 4);
            entry(325, counts_, 4);
        }
        word(339, kind_.is_signed ? 2 : 1);
        const std::string begin = put(file_.size(), 4);
        file_.replace(4, 4, begin);
        file_ += put(uint64_t(entries_), 2) + directory_ + put(0, 4);
    }

    static constexpr int kTile = 16;
    TiffKind kind_;
    int columns_, rows_, entries_ = 0;
    const std::vector<double>& values_;
    std::vector<uint32_t> offsets_, counts_;
    std::string file_, directory_;
};

inline std::string tiffOf(const TiffKind& kind, int columns, const std::vector<double>& values) {
    return TiffWriter(kind, columns, values).bytes();
}

}  // namespace bonemill
