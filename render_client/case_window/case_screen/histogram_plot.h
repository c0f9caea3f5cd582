// The scan's values as a plot, on which the iso-value is moved. It belongs to the render thread.
#pragma once

#include <optional>

#include "render_client/case_window/case_desk/case_desk.h"
#include "render_client/case_window/case_screen/control_places.h"

namespace bonemill {

// Returns the value that the mouse has moved the line to. What is white above the grey window is drawn white.
std::optional<double> plotHistogram(const Histogram& histogram, const std::optional<double>& iso,
                                    const std::optional<double>& runner_up, const GreyWindow& window,
                                    float height, ControlPlaces& places);

}  // namespace bonemill
