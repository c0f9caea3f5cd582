#include "haptic_server/scans/dicom/dicom_slice.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

std::vector<double> numbersOf(const std::string& text, size_t count, const char* what,
                              const std::string& image) {
    if (text.empty())
        throw UserError(image + ": does not state its " + what + "; export it anew, or leave it out");
    const auto numbers = decimalNumbers(text);
    if (!numbers || numbers->size() != count)
        throw UserError(image + ": its " + what + " \"" + text + "\" is not " + std::to_string(count) +
                        " numbers; the header is damaged");
    return *numbers;
}

// Both turn by as much towards the right angle.
void straighten(Eigen::Vector3d& a, Eigen::Vector3d& b) {
    const Eigen::Vector3d between = (a.normalized() + b.normalized()).normalized();
    const Eigen::Vector3d across = (a.normalized() - b.normalized()).normalized();
    a = (between + across).normalized();
    b = (between - across).normalized();
}

void takeAxes(DicomPlace& place, const std::string& text, double most_rounding, const std::string& image) {
    const std::vector<double> numbers = numbersOf(text, 6, "Image Orientation", image);
    place.row_direction = Eigen::Vector3d(numbers.data());
    place.column_direction = Eigen::Vector3d(numbers.data() + 3);
    const double off_length =
        std::max(std::abs(place.row_direction.norm() - 1), std::abs(place.column_direction.norm() - 1));
    const double cosine = std::abs(place.row_direction.dot(place.column_direction));
    // Three numbers are rounded per axis: a length is off by the root of 3 at most, a cosine by twice that.
    const double most_off = std::sqrt(3.0) * most_rounding;
    if (!(off_length <= most_off && cosine <= 2 * most_off))
        throw UserError(image + ": its Image Orientation \"" + text +
                        "\" is not two unit vectors at a right angle; export it anew");
    place.rounding = std::max(off_length, cosine);
    if (place.rounding > 0) straighten(place.row_direction, place.column_direction);
}

}  // namespace

DicomPlace placeFromTexts(const DicomPlaceTexts& texts, double most_rounding, const std::string& image) {
    DicomPlace place;
    place.position_mm = Eigen::Vector3d(numbersOf(texts.position, 3, "Image Position", image).data());
    takeAxes(place, texts.orientation, most_rounding, image);
    const std::vector<double> between = numbersOf(texts.pixel_spacing, 2, "Pixel Spacing", image);
    if (!(between[0] > 0 && between[1] > 0))
        throw UserError(image + ": its Pixel Spacing \"" + texts.pixel_spacing +
                        "\" is not above 0; export it anew");
    place.pixel_spacing_mm = {between[1], between[0]};  // DICOM: between rows first
    return place;
}

}  // namespace bonemill
