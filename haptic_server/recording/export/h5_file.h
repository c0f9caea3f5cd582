// Writes columns of numbers as an HDF5 file that h5py and MATLAB open in one line. It is for one normal
// thread.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace bonemill {

// What a dataset says of itself, as the attributes "unit" and "description".
struct H5About {
    std::string unit;
    std::string description;
};

class H5File {
  public:
    // Makes the file, or empties it. Throws UserError, as all that follows does, when it cannot be written.
    explicit H5File(const std::string& path);
    ~H5File();
    H5File(const H5File&) = delete;
    H5File& operator=(const H5File&) = delete;

    // Attributes of the file as a whole.
    void describe(const std::string& name, const std::string& value);
    void describe(const std::string& name, double value);

    // A dataset "/group/name" of rows; with width 1 it has one axis, else rows of this width. Rows are added
    // in blocks, packed.
    class Column {
      public:
        void append(std::span<const double> values);
        void append(std::span<const uint32_t> values);

      private:
        friend class H5File;
        int64_t dataset_ = -1;
        size_t width_ = 1;
        uint64_t rows_ = 0;
        std::string path_;
        template <class Value>
        void appendAs(std::span<const Value> values, int64_t type);
    };
    enum class Number { kDouble, kUint32 };
    // The reference is good as long as the file.
    Column& addColumn(const std::string& place, size_t width, Number number, const H5About& about);
    // A dataset of texts, all at once.
    void writeTexts(const std::string& place, const std::vector<std::string>& texts,
                    const std::string& description);

    // Writes all that waits and closes the file.
    void close();

  private:
    struct Handles;
    std::string path_;
    std::unique_ptr<Handles> handles_;
};

}  // namespace bonemill
