// A box over the screen in which a folder or file is looked for. It belongs to the render thread.
#pragma once

#include <optional>
#include <string>

#include "render_client/case_window/case_desk/folder_view.h"
#include "render_client/case_window/case_screen/control_places.h"

namespace bonemill {

class BrowseBox {
  public:
    // Opens the box at the folder of this path, or at the working folder. With `takes_folders` a folder can
    // be chosen as a whole.
    void open(const std::string& title, const std::string& near, bool takes_folders);
    // It is called in every frame; returns what was chosen.
    std::optional<std::string> build(ControlPlaces& places, float scale);

  private:
    std::optional<std::string> buildEntries(ControlPlaces& places);

    std::string title_ = "Browse";
    bool takes_folders_ = true, is_asked_for_ = false;
    FolderView view_;
};

}  // namespace bonemill
