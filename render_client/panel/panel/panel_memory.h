// What the panel keeps between two pictures: what is being typed, and decoded pictures. It belongs to the
// render thread.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "common/picture/picture.h"
#include "proto/topics.pb.h"
#include "render_client/hand/controls/session_view.h"
#include "render_client/language/language.h"
#include "render_client/panel/panel/qr_code.h"

namespace bonemill {

// Which parts of the panel are open, by their names; those that were never seen are not among them.
using PanelFolds = std::map<std::string, bool>;

// Of a note.
struct RemarkDraft {
    std::array<char, 301> note{};          // as typed so far, zero-terminated UTF-8
    std::optional<Eigen::Vector3d> place;  // W; nothing: the note belongs to no place
    bool wants_keyboard = false;           // it is to be typed from now on
    bool leaves_keyboard = false;          // it was sent: keys are the viewer's again
};

// Of an invitation, and the QR code of the last link.
struct InviteDraft {
    std::array<char, 61> name{};  // as typed so far, zero-terminated UTF-8
    int role = 0;                 // of kInvitedRoles
    std::string link;             // that the code was made of
    QrCode code;
};
inline constexpr std::array<const char*, 3> kInvitedRoles = {trMark("observer"), trMark("operator"),
                                                             trMark("instructor")};

// Of what would be otherwise in the recording that is replayed.
struct WhatIfDraft {
    Eigen::Vector3f shift_mm{0, 0, 0};  // of the hand, W
    int tool = 0;                       // number from 1; 0: as it was
    float pace = 1;                     // of the hand
};

// Of a slider that is being dragged: of which field, and where it is.
struct TuningDraft {
    std::string path;  // empty: of none
    double value = 0;
};

// Of the user's side of a lesson: a name that is being typed, which task and which summary are on the screen.
class LessonDraft {
  public:
    // Takes what the server tells: an attempt that begins and a new scene show the task for a while, one that
    // ends its summary.
    void follow(const SessionView& session);

    // How much of the task is to be seen, 0 to 1: it fades.
    float taskOpacity(double time_s) const;
    // Returns the attempt whose summary is open; null if none.
    const topics::Attempt* summary(const SessionView& session) const;
    void closeSummary() { summary_ = 0; }
    void showSummary(uint32_t attempt) { summary_ = attempt; }
    // Returns the clock (s) of the attempt under way, without pauses; it counts what this viewer has seen,
    // and takes an attempt that had begun before for one without pauses. Nothing while none is under way.
    std::optional<double> attemptTime() const { return attempt_s_; }
    // Something stands over the picture, or can be clicked there, while the panel is closed.
    bool isOnScreen(const SessionView& session) const {
        return session.lesson && session.lesson->scenes_size() > 0;
    }

    std::array<char, 64> trainee{};  // as typed so far, zero-terminated UTF-8
    bool scrolls_to_top = false;     // the panel, in a new scene
    bool wants_keyboard = false;     // the name is to be typed from now on
    bool has_entered = false;        // the name was entered, and its attempt is to begin
    bool leaves_keyboard = false;    // it has begun: keys are the viewer's again

  private:
    void countTime(const SessionView& session, bool has_looked);

    static constexpr double kTaskTime = 12, kFadeTime = 2;  // s

    bool has_looked_ = false;
    std::string scene_id_;
    bool was_running_ = false;
    uint32_t last_attempt_ = 0;  // that was told
    uint32_t summary_ = 0;       // number of the attempt whose summary is open; 0: none
    std::optional<double> task_since_s_;
    int64_t start_stamp_ns_ = 0;  // of the attempt under way
    std::optional<double> attempt_s_;
    double counted_s_ = 0;  // SessionView::time_s until which it is counted
};

// Returns the scene of this id in what the server can teach; null if it is none of them.
const topics::SceneChoice* sceneOf(const topics::Lesson& lesson, const std::string& id);
// Returns what the panel is called, and the button that opens it.
std::string panelTitle(const SessionView& session);

// The pictures of the scenes that can be chosen, and of past attempts, decoded from PNG once.
struct ScenePicture {
    std::string png;  // that it was decoded from
    int number = 0;   // the panel's picture of this number; 0: there is none
    RgbaPixels pixels;
};

class ScenePictures {
  public:
    // Decodes what is new; a picture that is none, or larger than 512 pixels, is left out.
    void follow(const SessionView& session);
    // By the scene's id, or the attempt's stem. Numbers are never used again.
    const std::map<std::string, ScenePicture>& all() const { return pictures_; }

  private:
    std::map<std::string, ScenePicture> pictures_;
    int last_number_ = 0;
};

}  // namespace bonemill
