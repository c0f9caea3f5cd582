#include "haptic_server/scans/nrrd/nrrd_place.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <sstream>
#include <utility>
#include <vector>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

struct Space {
    const char *name, *short_name;  // without blanks and dashes
    Vector3d to_LPS;                // signs of its axes
    bool is_patients;
};

// teem.sourceforge.net/nrrd/format.html, "Space and orientation".
const Space kSpaces[] = {
    {"rightanteriorsuperior", "ras", {-1, -1, 1}, true},
    {"leftanteriorsuperior", "las", {1, -1, 1}, true},
    {"leftposteriorsuperior", "lps", {1, 1, 1}, true},
    {"scannerxyz", "", {1, 1, 1}, false},
    {"3drighthanded", "", {1, 1, 1}, false},
};

// A space with time as its fourth axis ends so, or with "t" where it is short.
Space namedSpace(const std::string& text, const std::string& file) {
    std::string name = text;
    std::erase(name, '-');
    if (name.ends_with("time")) name.resize(name.size() - 4);
    if (name == "3dlefthanded")
        throw UserError(file + ": its space is " + text +
                        ", which is a mirror image of any patient's, and does not say which axis to turn; "
                        "write it as left-posterior-superior");
    for (const Space& space : kSpaces)
        if (name == space.name ||
            (*space.short_name && (text == space.short_name || text == space.short_name + std::string("t"))))
            return space;
    throw UserError(
        file + ": its space \"" + text +
        "\" is none that NRRD has; write it as left-posterior-superior, right-anterior-superior or "
        "left-anterior-superior");
}

Space spaceOf(const NrrdFields& fields, const std::string& file) {
    if (fields.space.empty()) return {"", "", Vector3d::Ones(), false};
    const Space space = namedSpace(fields.space, file);
    if (fields.space_directions.empty())
        throw UserError(file + ": names its space (" + fields.space +
                        ") but not how its axes lie in it; write its space directions");
    return space;
}

// One text of each axis: "none", or numbers in brackets, which may have blanks within.
std::vector<std::string> vectorsIn(const std::string& text) {
    std::vector<std::string> vectors;
    std::string word;
    bool is_open = false;
    for (const char c : text + " ") {
        if (c == '(') is_open = true;
        if (c == ')') is_open = false;
        if (is_open || !std::isspace(static_cast<unsigned char>(c)))
            word += c;
        else if (!word.empty())
            vectors.push_back(std::exchange(word, {}));
        if (c == ')') vectors.push_back(std::exchange(word, {}));
    }
    return vectors;
}

[[noreturn]] void refuseAxes(const std::string& file) {
    throw UserError(file +
                    ": its axes, sizes and space directions are not those of one volume in three "
                    "dimensions; write it as such");
}

struct Axis {
    size_t number;  // in the file
    Vector3d step;  // to the next voxel, in the file's space and unit
};

// Axes that have a direction; one along the time of a fourth dimension is none of space.
std::vector<Axis> axesOfDirections(const NrrdFields& fields, size_t sizes, const std::string& file) {
    const std::vector<std::string> vectors = vectorsIn(fields.space_directions);
    if (vectors.size() != sizes) refuseAxes(file);
    std::vector<Axis> axes;
    for (size_t a = 0; a < vectors.size(); ++a) {
        if (vectors[a] == "none") continue;
        const std::vector<double> numbers = numbersIn(vectors[a]);
        if (numbers.size() < 3 || numbers.size() > 4) refuseAxes(file);
        const Vector3d step(numbers.data());
        const double in_time = numbers.size() == 4 ? numbers[3] : 0;
        if (in_time != 0 && !step.isZero(0)) refuseAxes(file);
        if (in_time == 0) axes.push_back({a, step});
    }
    return axes;
}

bool isOfSpace(const std::string& kind) {
    return kind.empty() || kind == "???" || kind == "none" || kind == "domain" || kind == "space";
}

// Axes without directions are those of W in their order.
std::vector<Axis> plainAxes(const NrrdFields& fields, size_t sizes) {
    std::istringstream words(fields.kinds);
    const std::vector<double> spacings = numbersIn(fields.spacings);
    std::vector<Axis> axes;
    for (size_t a = 0; a < sizes; ++a) {
        std::string kind;
        words >> kind;
        if (!isOfSpace(kind) || axes.size() == 3) continue;
        const double spacing = a < spacings.size() ? spacings[a] : 1;
        axes.push_back({a, Vector3d::Unit(int(axes.size())) * spacing});
    }
    return axes;
}

std::vector<std::string> centersOf(const NrrdFields& fields) {
    std::istringstream words(fields.centers);
    return {std::istream_iterator<std::string>(words), {}};
}

// "axis mins" are where the first sample's cell begins, unless samples are nodes.
Vector3d plainOrigin(const NrrdFields& fields, const std::vector<Axis>& axes) {
    const std::vector<double> mins = numbersIn(fields.axis_mins);
    const std::vector<std::string> centers = centersOf(fields);
    Vector3d origin = Vector3d::Zero();
    for (size_t n = 0; n < axes.size(); ++n) {
        const size_t a = axes[n].number;
        if (a >= mins.size() || !std::isfinite(mins[a])) continue;
        const bool is_node = a < centers.size() && centers[a] == "node";
        origin[int(n)] = mins[a] + (is_node ? 0 : axes[n].step.norm() / 2);
    }
    return origin;
}

// From "axis mins" to "axis maxs" there are as many spacings as samples, of nodes one fewer; either where
// nothing says which they are.
void checkExtents(const NrrdFields& fields, const std::vector<Axis>& axes, const std::vector<double>& sizes,
                  const std::string& file) {
    constexpr double kMaxShare = 0.01;
    const std::vector<double> mins = numbersIn(fields.axis_mins), maxs = numbersIn(fields.axis_maxs);
    const std::vector<std::string> centers = centersOf(fields);
    for (const Axis& axis : axes) {
        const size_t a = axis.number;
        if (fields.spacings.empty() || a >= mins.size() || a >= maxs.size()) continue;
        const double extent = maxs[a] - mins[a], spacing = axis.step.norm();
        if (!std::isfinite(extent)) continue;
        const std::string center = a < centers.size() ? centers[a] : "";
        const auto agrees = [&](double spacings) {
            return std::abs(extent - spacings * spacing) <= kMaxShare * spacings * spacing;
        };
        if ((center != "node" && agrees(sizes[a])) || (center != "cell" && agrees(sizes[a] - 1))) continue;
        throw UserError(file + ": its axis mins and axis maxs contradict its spacings (" + fields.spacings +
                        "); take the wrong ones out of the header");
    }
}

Vector3d originOf(const NrrdFields& fields, const std::vector<Axis>& axes, const std::string& file) {
    if (fields.space_origin.empty() || fields.space_origin == "none")
        return fields.space_directions.empty() ? plainOrigin(fields, axes) : Vector3d(Vector3d::Zero());
    const std::vector<double> origin = numbersIn(fields.space_origin);
    if (origin.size() < 3 || origin.size() > 4) refuseAxes(file);
    return Vector3d(origin.data());
}

}  // namespace

void checkNrrdSpace(const NrrdHeader& header, const std::string& file) {
    spaceOf(header.fields, file);
}

FilePlace nrrdPlaceOf(const NrrdHeader& header, const std::string& file) {
    const NrrdFields& fields = header.fields;
    const Space space = spaceOf(fields, file);
    const std::vector<double> sizes = numbersIn(fields.sizes);  // checked: none is too large for an int
    const std::vector<Axis> axes = fields.space_directions.empty()
                                       ? plainAxes(fields, sizes.size())
                                       : axesOfDirections(fields, sizes.size(), file);
    if (axes.size() != 3) refuseAxes(file);
    if (fields.space_directions.empty()) checkExtents(fields, axes, sizes, file);
    FilePlace place{.frame = {}, .is_patients = space.is_patients};
    const Vector3d to_mm = header.mm_per_unit * space.to_LPS;
    for (int a = 0; a < 3; ++a) {
        const Vector3d step = axes[size_t(a)].step.cwiseProduct(to_mm);
        place.frame.dims[a] = int(sizes[axes[size_t(a)].number]);
        place.frame.spacing_mm[a] = step.norm();
        place.frame.directions.col(a) = step / step.norm();
    }
    place.frame.origin_mm = originOf(fields, axes, file).cwiseProduct(to_mm);
    return place;
}

}  // namespace bonemill
