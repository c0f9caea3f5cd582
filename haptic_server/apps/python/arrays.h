// Arrays of numpy, in and out. Only with the GIL held.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/base/user_error.h"

namespace bonemill::python {

namespace py = pybind11;

// The array has the vector's memory, without a copy: one number an entry, or rows of as many as an entry has.
template <class Value, class Entry>
py::array rowsOf(std::vector<Entry>&& entries, size_t width = sizeof(Entry) / sizeof(Value)) {
    auto owned = std::make_unique<std::vector<Entry>>(std::move(entries));
    const auto rows = py::ssize_t(owned->size() * sizeof(Entry) / sizeof(Value) / width);
    const auto* const data = reinterpret_cast<const Value*>(owned->data());
    const py::capsule owner(owned.get(),
                            [](void* vector) { delete static_cast<std::vector<Entry>*>(vector); });
    owned.release();
    if (width == 1) return py::array_t<Value>(rows, data, owner);
    return py::array_t<Value>({rows, py::ssize_t(width)}, data, owner);
}
template <class Value>
py::array arrayOf(std::vector<Value>&& values, size_t width = 1) {
    return rowsOf<Value>(std::move(values), width);
}

// A view of what `owner` holds; it cannot be written.
template <class Value>
py::array viewOf(const Value* data, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides,
                 const py::handle& owner) {
    py::array_t<Value> view(std::move(shape), std::move(strides), data, owner);
    view.attr("flags").attr("writeable") = false;
    return view;
}

inline std::string shapeText(const py::array& array) {
    return py::str(array.attr("shape"));
}

}  // namespace bonemill::python
