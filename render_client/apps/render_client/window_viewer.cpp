#include "render_client/apps/render_client/window_viewer.h"

#include <spdlog/spdlog.h>

#include <filesystem>

#include "common/process/start_apart.h"
#include "render_client/apps/render_client/clip_maker.h"
#include "render_client/apps/render_client/hand_feed.h"
#include "render_client/apps/render_client/inviter.h"
#include "render_client/apps/render_client/notices.h"
#include "render_client/apps/render_client/past_list.h"
#include "render_client/apps/render_client/saved_files.h"
#include "render_client/apps/render_client/scene_feed.h"
#include "render_client/hand/controls/announcing.h"
#include "render_client/hand/controls/key_table.h"
#include "render_client/hand/controls/past_attempts.h"
#include "render_client/hand/controls/quality_picker.h"
#include "render_client/hand/controls/viewer_controls.h"
#include "render_client/hand/window/glfw_window.h"
#include "render_client/language/language.h"
#include "render_client/link/subscribe/session_list.h"
#include "render_client/look/hud/figure_text.h"
#include "render_client/look/hud/hud_canvas.h"
#include "render_client/look/offscreen/osmesa_context.h"
#include "render_client/panel/panel/panel.h"
#include "render_client/viewer_options/preferences.h"

namespace bonemill {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kMinimisedPause{50};
constexpr uint32_t kNoSession = UINT32_MAX;  // no server is asked for it

const topics::Lesson* lessonOf(const SceneSubscriber& subscriber) {
    return subscriber.lesson() ? &*subscriber.lesson() : nullptr;
}

// A release ends what began before the mouse came to the panel.
bool isRelease(const WindowEvent& event) {
    if (const auto* key = std::get_if<KeyEvent>(&event)) return !key->is_down;
    const auto* button = std::get_if<MouseButtonEvent>(&event);
    return button && !button->is_down;
}

class WindowViewer {
  public:
    // Both must outlive the viewer.
    WindowViewer(const ClientOptions& options, PreferenceKeeper& keeper)
        : options_(options),
          keeper_(keeper),
          window_(options.width, options.height, "bonemill", kWithoutDisplay, keeper.kept().place),
          scene_(window_.gl(), options.has_effects),
          sound_({.is_played = true, .wav = options.sound_wav}),
          feed_(options.subscriber, scene_),
          controls_(scene_.settings(), scene_.camera()),
          hand_(controls_, scene_, feed_.subscriber(), options.holds_tool),
          remarks_(controls_, scene_),
          painter_(window_.gl()),
          notices_(scene_),
          quality_(window_.gl().isSoftware()) {
        spdlog::info("window, {}", window_.gl().describe());
        scene_.setViewWish(options.view);
        scene_.settings() = options.settings;
        scene_.setSought(soughtOf(options));
        if (options.has_effects) feed_.sound(&sound_);
        if (options.chooses_session) sessions_.emplace(options.subscriber.domain);
        scene_.settings().picks_quality = options.chooses_quality;
        controls_.openPanel(keeper.kept().is_panel_open);
        panel_.fold(keeper.kept().folds);
        start_ = preferences();
    }

    // Returns the session to go on with in another window; none at the end.
    std::optional<uint32_t> run() {
        while (!window_.shouldClose() && !stopRequested() && !has_quit_ && !chosen_) step();
        remember();
        keeper_.finish();
        sound_.finish();
        return chosen_;
    }

  private:
    void step() {
        lookForSessions();
        feed_.update();
        const int width = window_.pixelWidth(), height = window_.pixelHeight();
        const bool is_minimised = width == 0 || height == 0;
        const SessionView session = lookAtSession();
        Wishes wishes;
        if (!is_minimised) prepare(width, height);
        takeInput(height, session, wishes);
        if (const auto notice = remarks_.update(session, wishes)) notices_.show(*notice);
        if (!is_minimised) panel_.layOut(controls_, session, wishes);
        carryOut(wishes);
        past_.follow(options_.launcher, controls_.isPanelOpen(), session);
        if (const auto notice = hand_.update(session, wishes.hold_tool, Clock::now())) notices_.show(*notice);
        window_.showCrosshair(controls_.toolHold().isHolding());
        announce();
        attendance_.update(session.others);
        notices_.showOutcomes(feed_.subscriber());
        notices_.removeOld();
        if (is_minimised) return pause();
        pictureAttempt(session);
        scene_.setWatchers(watchers(session));
        scene_.setMouse(mouseOverScene(width, height));
        scene_.setFrameRate(frame_rate_.perSecond());
        scene_.setModes(modeTexts(scene_.settings(), controls_.isDrawing()));
        const Clock::time_point start = Clock::now();
        if (scene_.settings().picks_quality) scene_.settings().quality = quality_.quality();
        scene_.draw(width, height, scaleOfText(width, height));
        painter_.paint(panel_, width, height);
        const Clock::duration drawing = Clock::now() - start;
        if (wishes.save_picture)
            notices_.show(savePicture(window_.gl(), width, height, options_.class_folder,
                                      session.info ? session.info->name() : ""));
        if (wishes.save_attempts && session.lesson) notices_.show(saveAttempts(*session.lesson));
        if (!wishes.open_file.empty()) showFile(wishes.open_file);
        if (!wishes.replay_of.empty()) replay(wishes.replay_of);
        if (!wishes.what_if.empty()) goOnOtherwise(wishes.what_if);
        if (wishes.make_clip)
            notices_.show(clips_.make(options_, session.status->session_s(), scene_.camera(),
                                      nextName("bonemill_clip_%04d.mp4")));
        if (const auto notice = clips_.news()) notices_.show(*notice);
        if (!wishes.invite.empty())
            inviter_.invite(options_.launcher, options_.subscriber.session, wishes.invite, wishes.invite_as);
        showPicture(drawing);
        remember();
        if (wishes.full_screen) window_.switchFullScreen();
    }

    // `drawing` is how long it took up to now.
    void showPicture(Clock::duration drawing) {
        const Clock::time_point start = Clock::now();
        window_.show();
        const Clock::time_point now = Clock::now();
        frame_rate_.countPicture(now);
        const Camera camera = scene_.viewCamera();
        const bool has_moved = camera.X_CW() != std::exchange(last_camera_, camera).X_CW();
        const std::chrono::duration<double> taken = drawing + (now - start), time = now.time_since_epoch();
        quality_.take(taken.count(), has_moved, time.count());
    }

    // As it is now.
    Preferences preferences() const {
        const ViewSettings& settings = controls_.settings();
        Preferences now{.camera = settings.camera,
                        .text_scale = settings.text_scale,
                        .is_for_colour_blind = settings.is_for_colour_blind,
                        .is_panel_open = controls_.isPanelOpen(),
                        .folds = panel_.folds()};
        if (!options_.said.size) now.place = window_.place();
        if (!settings.picks_quality) now.quality = settings.quality;
        return now;
    }
    void remember() { keeper_.keep(toKeep(keeper_.kept(), start_, preferences()), Clock::now()); }

    // The only session is joined once it has been the only one for a while; of several the user chooses.
    void lookForSessions() {
        constexpr std::chrono::seconds kAlone{1};
        if (!sessions_) return;
        sessions_->poll();
        const std::vector<ListedSession> heard = sessions_->sessions();
        const Clock::time_point now = Clock::now();
        if (heard.size() != 1) alone_since_ = now;
        if (heard.size() == 1 && now - alone_since_ >= kAlone) chosen_ = heard[0].session;
        offered_.clear();
        if (heard.size() < 2) return;
        for (const ListedSession& session : heard)
            offered_.push_back({session.session, sessionText(session)});
    }

    void pause() { feed_.updateUntil(Clock::now() + kMinimisedPause, stopRequested); }

    SessionView lookAtSession() {
        SceneSubscriber& subscriber = feed_.subscriber();
        SessionView session;
        session.name = options_.subscriber.name;
        session.role = options_.subscriber.role;
        session.has_server = subscriber.hasServer();
        session.is_complete = subscriber.isComplete();
        session.frame_rate_hz = frame_rate_.perSecond();
        session.picture_s = quality_.median();
        if (subscriber.sceneInfo()) session.info = &*subscriber.sceneInfo();
        if (subscriber.status()) session.status = &*subscriber.status();
        if (subscriber.toolState()) session.tool = &*subscriber.toolState();
        session.lesson = lessonOf(subscriber);
        session.others = subscriber.viewers();
        session.faults = scene_.faults();
        session.remarks = &subscriber.remarks();
        session.offered = offered_;
        session.class_folder = options_.class_folder;
        session.has_launcher = !options_.launcher.empty();
        session.invitation = inviter_.invitation();
        session.past = &past_.list();
        session.same_scene = &past_.sameScene();
        session.recording = options_.recording;
        session.time_s = std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
        session.realtime_ns =
            std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
        return session;
    }

    float scaleOfText(int width, int height) {
        return textScale(width, height, scene_.settings().text_scale, window_.contentScale());
    }

    void prepare(int width, int height) {
        const Clock::time_point now = Clock::now();
        const std::chrono::duration<double> seconds = now - std::exchange(last_picture_, now);
        const int view_width = scene_.viewWidth(width, height);
        panel_.setPicture(width, height, view_width, scaleOfText(width, height), seconds.count());
        hand_.lookAt(view_width, height);
        controls_.paneMouse().lookAt(scene_.seenPanes());
    }

    void takeInput(int height, const SessionView& session, Wishes& wishes) {
        for (const WindowEvent& event : window_.takeEvents()) {
            const bool is_panels = panel_.handle(event, controls_, session, wishes);
            const auto* move = std::get_if<MouseMoveEvent>(&event);
            if (move) is_over_panel_ = is_panels;
            if (is_panels && move) {
                controls_.passOver(*move);
            } else if (!is_panels || isRelease(event)) {
                controls_.handle(event, height, session, wishes);
            }
        }
    }

    void carryOut(const Wishes& wishes) {
        for (const topics::Command& command : wishes.commands) feed_.subscriber().sendCommand(command);
        if (wishes.reset_view) scene_.resetView();
        if (wishes.centre_at)
            if (const auto p_W = pick(*wishes.centre_at)) scene_.camera().target_W = *p_W;
        if (wishes.removal_at) askForRemoval(*wishes.removal_at);
        if (!wishes.copy.empty()) window_.setClipboard(wishes.copy);
        if (const auto problem = changeLanguage(wishes.language)) notices_.show(*problem);
        if (wishes.notice) notices_.show(*wishes.notice);
        if (!wishes.asked.empty()) spdlog::info("asked: {}", wishes.asked);
        has_quit_ = has_quit_ || wishes.quit;
        if (wishes.session) chosen_ = wishes.session;
    }

    void askForRemoval(const PixelPoint& at) {
        const auto p_W = pick(at);
        if (!p_W) return notices_.show({tr("There is no bone under the mouse"), HudTone::kWarning});
        topics::Command command;
        command.mutable_replay()->mutable_removal_at()->mutable_p_m()->Assign(p_W->begin(), p_W->end());
        feed_.subscriber().sendCommand(command);
    }

    std::optional<Eigen::Vector3d> pick(const PixelPoint& at) { return scene_.pick(int(at.x), int(at.y)); }

    // The panel hides what lies under it, and a mouse that does something else asks for no name.
    std::optional<std::pair<int, int>> mouseOverScene(int width, int height) {
        const auto at = controls_.hovering();
        if (!at || is_over_panel_ || at->x < 0 || at->y < 0 || at->x >= width || at->y >= height)
            return std::nullopt;
        return std::pair(int(at->x), int(at->y));
    }

    void announce() {
        const auto at = controls_.pointing();
        const bool is_holding = controls_.toolHold().isHolding();
        const bool is_news = std::exchange(was_holding_, is_holding) != is_holding;
        const Clock::time_point now = Clock::now();
        const std::optional<Camera> seen = seenForRecording();
        const bool has_moved = seen && eye_watch_.isDue(now, *seen);
        if (!announce_clock_.isDue(now, at.has_value()) && !is_news && !has_moved) return;
        pointer_W_ = at ? pick(*at) : std::nullopt;
        if (seen) eye_watch_.told(now, *seen);
        feed_.subscriber().announce(frame_rate_.perSecond(), pointer_W_, is_holding,
                                    seen ? std::optional(eyeOf(*seen)) : std::nullopt);
    }

    // Who operates, or was named as the trainee, is recorded with what it sees.
    std::optional<Camera> seenForRecording() const {
        const SubscriberOptions& self = options_.subscriber;
        if (!self.is_trainee && self.role != topics::Viewer::OPERATOR) return std::nullopt;
        if (!scene_.hasSceneInfo()) return std::nullopt;
        return scene_.viewCamera();
    }

    // Returns the others, and the user while it points: the laser is seen where it is held, too.
    std::vector<topics::Viewer> watchers(const SessionView& session) const {
        std::vector<topics::Viewer> watchers = session.others;
        if (!pointer_W_) return watchers;
        topics::Viewer& self = watchers.emplace_back();
        self.set_name(session.name);
        self.set_role(session.role);
        self.set_frame_rate_hz(session.frame_rate_hz);
        self.set_is_complete(session.is_complete);
        self.mutable_pointer_m()->Assign(pointer_W_->begin(), pointer_W_->end());
        return watchers;
    }

    // The bone that an attempt has left, as whoever sits here sees it, and nothing over it.
    void pictureAttempt(const SessionView& session) {
        const std::string stem = attempt_ends_.take(session);
        if (stem.empty()) return;
        const ViewSettings shown = scene_.settings();
        scene_.settings().show_hud = false;
        scene_.settings().stereo = StereoMode::kOff;
        scene_.settings().slices.are_shown = false;
        scene_.draw(PastList::kPictureWidth, PastList::kPictureHeight, 1);
        past_.keep(stem, readPicture(window_.gl(), PastList::kPictureWidth, PastList::kPictureHeight));
        scene_.settings() = shown;
    }

    void showFile(const std::string& file) {
        if (std::error_code none; !std::filesystem::exists(file, none))
            notices_.show({tr("{1} is not there yet", {file}), HudTone::kWarning});
        else if (!startApart({"xdg-open", file}))
            notices_.show(
                {tr("This desktop opens no files by itself: look at {1}", {file}), HudTone::kWarning});
    }

    // From the moment that is seen on.
    void goOnOtherwise(const std::vector<std::string>& otherwise) {
        char moment[32];
        std::snprintf(moment, sizeof moment, "%.3f", replayedS());
        std::vector<std::string> words{options_.launcher,
                                       "what-if",
                                       options_.recording,
                                       "--at",
                                       moment,
                                       "--domain",
                                       std::to_string(options_.subscriber.domain)};
        words.insert(words.end(), otherwise.begin(), otherwise.end());
        notices_.show(
            startApart(words)
                ? HudNotice{tr("It is worked out; a window of its own will show both"), HudTone::kPlain}
                : HudNotice{tr("{1} cannot be started", {options_.launcher}), HudTone::kWarning});
    }
    double replayedS() { return feed_.subscriber().status() ? feed_.subscriber().status()->session_s() : 0; }

    void replay(const std::string& result) {
        if (std::error_code none; !std::filesystem::exists(result, none))
            notices_.show({tr("{1} is not there yet", {result}), HudTone::kWarning});
        else if (!startApart({options_.launcher, "replay", result, "--domain",
                              std::to_string(options_.subscriber.domain)}))
            notices_.show({tr("{1} cannot be started", {options_.launcher}), HudTone::kWarning});
        else
            notices_.show({tr("The replay opens in a window of its own, if the attempt was recorded"),
                           HudTone::kPlain});
    }

    const ClientOptions& options_;
    PreferenceKeeper& keeper_;
    GlfwWindow window_;
    RenderScene scene_;
    SoundFeed sound_;
    SceneFeed feed_;
    ViewerControls controls_;
    HandFeed hand_;
    RemarkFeed remarks_;
    Panel panel_;
    PanelPainter painter_;
    Notices notices_;
    Attendance attendance_;
    Inviter inviter_;
    PastList past_;
    ClipMaker clips_;
    AttemptEnds attempt_ends_;
    FrameRate frame_rate_;
    QualityPicker quality_;
    Camera last_camera_;  // of the last picture
    Preferences start_;   // as the window began
    AnnounceClock announce_clock_;
    EyeReporter eye_watch_;
    std::optional<Eigen::Vector3d> pointer_W_;  // where the user points, as announced last
    Clock::time_point last_picture_ = Clock::now();
    bool was_holding_ = false;  // as announced last
    bool has_quit_ = false;
    bool is_over_panel_ = false;           // the mouse
    std::optional<SessionList> sessions_;  // where none was asked for
    std::vector<OfferedSession> offered_;
    Clock::time_point alone_since_ = Clock::now();
    std::optional<uint32_t> chosen_;  // to be joined
};

}  // namespace

void runWindow(const ClientOptions& options) {
    if (options.language.empty()) speak(wantedLanguage());
    ClientOptions chosen = options;
    if (options.chooses_session) chosen.subscriber.session = kNoSession;
    PreferenceKeeper keeper(preferenceFile());
    startAs(keeper.kept(), chosen);
    while (const std::optional<uint32_t> session = WindowViewer(chosen, keeper).run()) {
        spdlog::info("session {}", *session);
        chosen.subscriber.session = *session;
        chosen.chooses_session = false;
    }
}

}  // namespace bonemill
