// The pictures of the scenes that can be chosen, decoded from PNG once. It belongs to the render thread.
#pragma once

#include <map>
#include <string>

#include "common/picture/picture.h"
#include "proto/topics.pb.h"

namespace bonemill {

struct ScenePicture {
    std::string png;  // that it was decoded from
    int number = 0;   // the panel's picture of this number; 0: there is none
    RgbaPixels pixels;
};

class ScenePictures {
  public:
    // Decodes what is new; a picture that is none, or larger than 512 pixels, is left out.
    void follow(const topics::Lesson& lesson);
    // By the scene's id. Numbers are never used again.
    const std::map<std::string, ScenePicture>& all() const { return pictures_; }

  private:
    std::map<std::string, ScenePicture> pictures_;
    int last_number_ = 0;
};

}  // namespace bonemill
