#include "haptic_server/recording/export/h5_file.h"

#include <hdf5.h>

#include <deque>
#include <utility>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

constexpr hsize_t kRowsPerChunk = 4096;
constexpr unsigned kPacking = 1;  // of deflate's 0 to 9: the fastest that packs

[[noreturn]] void failAt(const std::string& path) {
    throw UserError(path + ": the HDF5 file cannot be written (disk full?)");
}

// Identifiers and results of HDF5 are negative where something failed.
template <class Result>
Result checked(Result result, const std::string& path) {
    if (result < 0) failAt(path);
    return result;
}

hid_t textType() {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, H5T_VARIABLE);
    H5Tset_cset(type, H5T_CSET_UTF8);
    return type;
}

void writeTextAttribute(hid_t object, const std::string& name, const std::string& value,
                        const std::string& path) {
    const hid_t type = textType(), space = H5Screate(H5S_SCALAR);
    const hid_t attribute =
        checked(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), path);
    const char* const text = value.c_str();
    checked(H5Awrite(attribute, type, &text), path);
    H5Aclose(attribute);
    H5Sclose(space);
    H5Tclose(type);
}

// Groups on the way to a dataset are made.
hid_t groupsOnTheWay() {
    const hid_t list = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(list, 1);
    return list;
}

}  // namespace

struct H5File::Handles {
    hid_t file = -1;
    std::deque<Column> columns;
};

// HDF5's own words are for programmers. What it cannot write it would try again at the program's end, and
// crash; all is closed without that.
H5File::H5File(const std::string& path) : path_(path), handles_(std::make_unique<Handles>()) {
    H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    handles_->file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    if (handles_->file < 0)
        throw UserError(path + ": cannot be written; check that its folder exists and is yours");
}

H5File::~H5File() {
    for (const Column& column : handles_->columns)
        if (column.dataset_ >= 0) H5Dclose(column.dataset_);
    if (handles_->file >= 0) H5Fclose(handles_->file);
}

void H5File::describe(const std::string& name, const std::string& value) {
    writeTextAttribute(handles_->file, name, value, path_);
}

void H5File::describe(const std::string& name, double value) {
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t attribute = checked(
        H5Acreate2(handles_->file, name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT), path_);
    checked(H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value), path_);
    H5Aclose(attribute);
    H5Sclose(space);
}

H5File::Column& H5File::addColumn(const std::string& place, size_t width, Number number,
                                  const H5About& about) {
    Column& column = handles_->columns.emplace_back();
    column.width_ = width;
    column.path_ = path_;
    const int axes = width == 1 ? 1 : 2;
    const hsize_t none[] = {0, width}, most[] = {H5S_UNLIMITED, width}, chunk[] = {kRowsPerChunk, width};
    const hid_t space = checked(H5Screate_simple(axes, none, most), path_);
    const hid_t list = H5Pcreate(H5P_DATASET_CREATE), links = groupsOnTheWay();
    H5Pset_chunk(list, axes, chunk);
    H5Pset_shuffle(list);
    H5Pset_deflate(list, kPacking);
    column.dataset_ = checked(
        H5Dcreate2(handles_->file, place.c_str(), number == Number::kDouble ? H5T_IEEE_F64LE : H5T_STD_U32LE,
                   space, links, list, H5P_DEFAULT),
        path_);
    H5Pclose(links);
    H5Pclose(list);
    H5Sclose(space);
    writeTextAttribute(column.dataset_, "unit", about.unit, path_);
    writeTextAttribute(column.dataset_, "description", about.description, path_);
    return column;
}

template <class Value>
void H5File::Column::appendAs(std::span<const Value> values, int64_t type) {
    if (values.empty()) return;
    const hsize_t rows = values.size() / width_;
    const hsize_t all[] = {rows_ + rows, width_}, start[] = {rows_, 0}, count[] = {rows, width_};
    const int axes = width_ == 1 ? 1 : 2;
    checked(H5Dset_extent(dataset_, all), path_);
    const hid_t in_file = checked(H5Dget_space(dataset_), path_),
                in_memory = H5Screate_simple(axes, count, nullptr);
    H5Sselect_hyperslab(in_file, H5S_SELECT_SET, start, nullptr, count, nullptr);
    const herr_t written = H5Dwrite(dataset_, type, in_memory, in_file, H5P_DEFAULT, values.data());
    H5Sclose(in_memory);
    H5Sclose(in_file);
    checked(written, path_);
    rows_ += rows;
}

void H5File::Column::append(std::span<const double> values) {
    appendAs(values, H5T_NATIVE_DOUBLE);
}

void H5File::Column::append(std::span<const uint32_t> values) {
    appendAs(values, H5T_NATIVE_UINT32);
}

void H5File::writeTexts(const std::string& place, const std::vector<std::string>& texts,
                        const std::string& description) {
    std::vector<const char*> raw;
    for (const std::string& text : texts) raw.push_back(text.c_str());
    const hsize_t count[] = {texts.size()};
    const hid_t type = textType(), space = H5Screate_simple(1, count, nullptr), links = groupsOnTheWay();
    const hid_t dataset = checked(
        H5Dcreate2(handles_->file, place.c_str(), type, space, links, H5P_DEFAULT, H5P_DEFAULT), path_);
    if (!raw.empty()) checked(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, raw.data()), path_);
    writeTextAttribute(dataset, "description", description, path_);
    H5Dclose(dataset);
    H5Pclose(links);
    H5Sclose(space);
    H5Tclose(type);
}

void H5File::close() {
    for (Column& column : handles_->columns) {
        const hid_t dataset = std::exchange(column.dataset_, -1);
        checked(H5Dclose(dataset), path_);
    }
    handles_->columns.clear();
    const hid_t file = std::exchange(handles_->file, -1);
    checked(H5Fclose(file), path_);
}

}  // namespace bonemill
