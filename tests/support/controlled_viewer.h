// It is a viewer's controls with a server behind them, as the tests of controls and panel need them.
#pragma once

#include "proto/topics.pb.h"
#include "render_client/hand/controls/session_view.h"
#include "render_client/hand/controls/viewer_controls.h"
#include "render_client/look/camera/camera.h"
#include "render_client/look/camera/view_settings.h"

namespace bonemill::test {

class ControlledViewer {
  protected:
    ControlledViewer() {
        session_.has_server = true;
        session_.info = &info_;
        session_.status = &status_;
    }

    topics::SceneInfo info_;
    topics::Status status_;
    SessionView session_;
    Wishes wishes_;
    ViewSettings settings_;
    OrbitCamera camera_;
    ViewerControls controls_{settings_, camera_};
};

}  // namespace bonemill::test
