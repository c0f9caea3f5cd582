// Has bonemill list the attempts of before, and leaves a small picture of the bone beside the result of each
// attempt that ends here. It belongs to the render thread, which it does not keep waiting.
#pragma once

#include <future>
#include <string>
#include <vector>

#include "common/picture/picture.h"
#include "render_client/hand/controls/past_attempts.h"

namespace bonemill {

class PastList {
  public:
    static constexpr int kPictureWidth = 320, kPictureHeight = 240;  // pixels

    // Once per picture: the lists are made anew when the panel opens, and when an attempt has left something.
    void follow(const std::string& launcher, bool is_open, const SessionView& session);
    const std::vector<PastAttempt>& list() const { return lists_.all; }
    // Those at the scene of the recording that is replayed, experts' among them; else none.
    const std::vector<PastAttempt>& sameScene() const { return lists_.same_scene; }

    // The bone of the attempt of this stem.
    void keep(const std::string& stem, Picture picture);

  private:
    struct Lists {
        std::vector<PastAttempt> all, same_scene;
    };
    static Lists listsOf(const std::string& launcher, const std::string& scene_hash);
    void take();

    std::string seen_;  // what the newest lists were made for
    int kept_ = 0;      // pictures that are on the disk
    std::future<Lists> made_;
    std::future<void> keeping_;
    Lists lists_;
};

}  // namespace bonemill
