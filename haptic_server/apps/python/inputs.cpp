#include "haptic_server/apps/python/inputs.h"

#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "common/device_messages/device_messages.h"
#include "haptic_server/apps/python/arrays.h"

namespace bonemill::python {
namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

constexpr uint32_t kButtons = kButtonRemove | kButtonAdd;

py::array arrayIn(const py::object& given, const char* what, std::string_view kinds, const char* expected) {
    py::array array;
    try {
        array = py::module_::import("numpy").attr("asarray")(given);
    } catch (const py::error_already_set&) {
        throw UserError(std::string(what) + ": expected " + expected + ", in rows of equal length");
    }
    if (kinds.find(array.dtype().kind()) == std::string_view::npos)
        throw UserError(std::string(what) + ": expected " + expected + ", got an array of " +
                        std::string(py::str(array.dtype())));
    return array;
}

Numbers numbersIn(const py::object& given, const char* what) {
    if (py::isinstance<Numbers>(given)) return py::reinterpret_borrow<Numbers>(given);
    return Numbers(arrayIn(given, what, "fiub", "real numbers"));
}

Numbers vectorIn(const py::object& given, py::ssize_t size, const char* what) {
    Numbers array = numbersIn(given, what);
    if (array.ndim() != 1 || array.shape(0) != size)
        throw UserError(std::string(what) + ": expected " + std::to_string(size) +
                        " numbers, got an array of shape " + shapeText(array));
    return array;
}

// Any number of rows, if `rows` is negative.
Numbers rowsIn(const py::object& given, py::ssize_t rows, py::ssize_t size, const char* what) {
    Numbers array = numbersIn(given, what);
    if (array.ndim() != 2 || array.shape(1) != size || (rows >= 0 && array.shape(0) != rows))
        throw UserError(std::string(what) + ": expected an array of shape (" +
                        (rows < 0 ? "N" : std::to_string(rows)) + ", " + std::to_string(size) + "), got " +
                        shapeText(array));
    return array;
}

void requireRows(const py::array& array, py::ssize_t rows, const char* what) {
    if (array.ndim() != 1 || array.shape(0) != rows)
        throw UserError(std::string(what) + ": expected an array of shape (" + std::to_string(rows) +
                        ",), got " + shapeText(array));
}

// Bits that mean something, one number or one a row.
py::array_t<int64_t> buttonsIn(const py::object& given) {
    const py::array_t<int64_t, py::array::forcecast> array(arrayIn(given, "buttons", "iub", "whole numbers"));
    const py::array_t<int64_t, py::array::c_style | py::array::forcecast> flat(array.attr("ravel")());
    for (py::ssize_t n = 0; n < flat.size(); ++n)
        if (flat.data()[n] < 0 || flat.data()[n] > int64_t(kButtons))
            throw UserError("buttons: expected 0, 1 (removes), 2 (adds) or 3, got " +
                            std::to_string(flat.data()[n]));
    return array;
}

void place(HandStep& hand, const double* position, const double* orientation) {
    hand.X_WT.position = Eigen::Vector3d(position);
    if (orientation)
        hand.X_WT.rotation =
            Eigen::Quaterniond(orientation[0], orientation[1], orientation[2], orientation[3]);
}

}  // namespace

HandStep handOf(const py::object& position, const py::object& orientation, const py::object& buttons) {
    const Numbers p = vectorIn(position, 3, "position_m");
    std::optional<Numbers> q;
    if (!orientation.is_none()) q = vectorIn(orientation, 4, "orientation_wxyz");
    const py::array_t<int64_t> pressed = buttonsIn(buttons);
    if (pressed.ndim() != 0) throw UserError("buttons: expected one number, got an array");
    HandStep hand;
    place(hand, p.data(), q ? q->data() : nullptr);
    hand.buttons = uint32_t(*pressed.data());
    return hand;
}

std::vector<HandStep> handsOf(const py::object& positions, const py::object& orientations,
                              const py::object& buttons, const py::object& times) {
    const Numbers p = rowsIn(positions, -1, 3, "positions_m");
    const py::ssize_t rows = p.shape(0);
    std::vector<HandStep> hands(size_t(rows), HandStep{});
    std::optional<Numbers> q;
    if (!orientations.is_none()) q = rowsIn(orientations, rows, 4, "orientations_wxyz");
    for (py::ssize_t n = 0; n < rows; ++n)
        place(hands[size_t(n)], p.data() + 3 * n, q ? q->data() + 4 * n : nullptr);
    if (!buttons.is_none()) {
        const py::array_t<int64_t> pressed = buttonsIn(buttons);
        if (pressed.ndim() != 0) requireRows(pressed, rows, "buttons");
        for (py::ssize_t n = 0; n < rows; ++n)
            hands[size_t(n)].buttons = uint32_t(pressed.ndim() == 0 ? *pressed.data() : *pressed.data(n));
    }
    if (!times.is_none()) {
        const Numbers t = numbersIn(times, "t_s");
        requireRows(t, rows, "t_s");
        for (py::ssize_t n = 0; n < rows; ++n) hands[size_t(n)].t_s = t.data()[n];
    }
    return hands;
}

}  // namespace bonemill::python
