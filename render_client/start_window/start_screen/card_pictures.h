// The pictures of scenes and cases, read when they are first seen. They belong to the render thread.
#pragma once

#include <map>
#include <string>

#include "common/picture/picture.h"

namespace bonemill {

struct CardPicture {
    int number = 0;  // under which the drawing names it; 0: there is no picture
    RgbaPixels pixels;
};

class CardPictures {
  public:
    // Of a PNG file; what is no picture has the number 0. It waits for the disk, once for each file.
    const CardPicture& of(const std::string& file);
    const std::map<std::string, CardPicture>& all() const { return pictures_; }

  private:
    std::map<std::string, CardPicture> pictures_;  // by file
    int last_number_ = 0;
};

}  // namespace bonemill
