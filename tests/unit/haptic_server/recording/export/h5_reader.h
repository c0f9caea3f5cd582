// Reads HDF5 files in tests, by HDF5's own functions.
#pragma once

#include <gtest/gtest.h>
#include <hdf5.h>

#include <string>
#include <vector>

namespace bonemill::test {

class H5Reader {
  public:
    explicit H5Reader(const std::string& path) : file_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)) {
        EXPECT_GE(file_, 0) << path;
    }
    ~H5Reader() { H5Fclose(file_); }
    H5Reader(const H5Reader&) = delete;
    H5Reader& operator=(const H5Reader&) = delete;

    struct Reals {
        std::vector<size_t> shape;
        std::vector<double> values;
    };
    bool has(const std::string& place) const { return H5Lexists(file_, place.c_str(), H5P_DEFAULT) > 0; }
    Reals reals(const std::string& place) const {
        const hid_t dataset = H5Dopen2(file_, place.c_str(), H5P_DEFAULT);
        EXPECT_GE(dataset, 0) << place;
        const std::vector<hsize_t> shape = shapeOf(dataset);
        Reals reals{{shape.begin(), shape.end()}, {}};
        size_t count = 1;
        for (const size_t n : reals.shape) count *= n;
        reals.values.resize(count);
        H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, reals.values.data());
        H5Dclose(dataset);
        return reals;
    }
    std::vector<std::string> texts(const std::string& place) const {
        const hid_t dataset = H5Dopen2(file_, place.c_str(), H5P_DEFAULT), type = textType();
        std::vector<char*> raw(shapeOf(dataset)[0]);
        H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, raw.data());
        std::vector<std::string> texts(raw.begin(), raw.end());
        for (char* text : raw) H5free_memory(text);
        H5Tclose(type);
        H5Dclose(dataset);
        return texts;
    }
    std::string text(const std::string& place, const std::string& attribute) const {
        const hid_t object = H5Oopen(file_, place.c_str(), H5P_DEFAULT), type = textType();
        const hid_t there = H5Aopen(object, attribute.c_str(), H5P_DEFAULT);
        char* raw = nullptr;
        H5Aread(there, type, &raw);
        const std::string text = raw ? raw : "";
        H5free_memory(raw);
        H5Aclose(there);
        H5Tclose(type);
        H5Oclose(object);
        return text;
    }

  private:
    static std::vector<hsize_t> shapeOf(hid_t dataset) {
        const hid_t space = H5Dget_space(dataset);
        std::vector<hsize_t> shape(size_t(H5Sget_simple_extent_ndims(space)));
        H5Sget_simple_extent_dims(space, shape.data(), nullptr);
        H5Sclose(space);
        return shape;
    }
    static hid_t textType() {
        const hid_t type = H5Tcopy(H5T_C_S1);
        H5Tset_size(type, H5T_VARIABLE);
        H5Tset_cset(type, H5T_CSET_UTF8);
        return type;
    }

    hid_t file_;
};

}  // namespace bonemill::test
