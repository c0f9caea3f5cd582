// What people wrote and drew, as the picture shows it: strokes, a dot where a note belongs, and the note's
// first words beside it. It belongs to the render thread.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "proto/topics.pb.h"
#include "render_client/look/paint/frame.h"

namespace bonemill {

class RemarkView {
  public:
    static constexpr size_t kMaxLabels = 16;  // of the newest notes

    // Takes all that there are, by place.
    void set(const std::map<uint32_t, topics::Remark>& remarks);

    struct Label {
        Eigen::Vector3d p_W;
        std::string text;
    };
    const std::vector<Stroke>& strokes() const { return strokes_; }
    const std::vector<Label>& labels() const { return labels_; }

  private:
    std::vector<Stroke> strokes_;
    std::vector<Label> labels_;
};

// Returns the linear colour of a stroke, of 0xRRGGBB.
Eigen::Vector3f strokeColour(uint32_t colour);

}  // namespace bonemill
