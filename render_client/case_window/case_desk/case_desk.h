// All that the window of make-case knows: the scan, the bone that was found in it, and what the teacher
// wants.
//
// What is wanted is one CaseRequest, the very one that the command line makes; makeCase() gets it as it is.
// Reading a scan, looking for bone and making the case go on beside the window; poll() takes what has come of
// it. It belongs to the thread of the window.
#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/is_ready.h"
#include "common/geometry/node_mesh.h"
#include "haptic_server/cases/casework/case_plan.h"
#include "haptic_server/scans/dicom/series_table.h"
#include "haptic_server/scans/find_bone/value_histogram.h"
#include "render_client/case_window/case_desk/scan_slice.h"
#include "render_client/case_window/case_desk/structure_list.h"
#include "render_client/look/camera/view_settings.h"

namespace bonemill {

// Does long work beside the window, one piece at a time.
//
// It belongs to the thread of the window. Its end waits for the work that is under way.
class Worker {
  public:
    using Done = std::function<void()>;
    // Runs `work` in a thread of its own; what it returns is called by poll(). The worker must not be busy.
    void start(std::function<Done()> work) { future_ = std::async(std::launch::async, std::move(work)); }
    bool isBusy() const { return future_.valid(); }
    // If the work is over, calls what it returned, or throws what it threw.
    void poll() {
        if (!isReady(future_)) return;
        const Done done = std::exchange(future_, {}).get();
        if (done) done();
    }

  private:
    std::future<Done> future_;
};

// What was said, for people.
struct DeskLine {
    enum class Kind : uint8_t { kPlain, kWarning, kError } kind = Kind::kPlain;
    std::string text;
};

class CaseDesk {
  public:
    // Begins with what `request` says already, and reads its scan if it has one. `version` goes into the
    // case; `command` is what people type before the request's words.
    CaseDesk(CaseRequest request, std::string version, std::string command);

    // Takes what is done, and begins what is to be done next.
    void poll();
    // What goes on beside the window, in words; empty: nothing.
    const std::string& busyWith() const { return busy_with_; }
    const std::vector<DeskLine>& lines() const { return lines_; }
    // What makeCase() gets, the command line that does the same, and what speaks against it now; empty:
    // nothing.
    CaseRequest request() const;
    std::string commandLine() const;
    std::string whyNotYet() const;

    // The scan. Another one forgets what was chosen of the last.
    void open(const std::string& path);
    const std::string& path() const { return request_.scan; }
    const std::vector<SeriesRow>& series() const { return series_; }
    std::optional<size_t> chosenSeries() const;
    void chooseSeries(size_t row);
    const RawVolume* scan() const { return scan_.get(); }
    Eigen::AlignedBox3d scanBox() const { return boxOfScan(scan_->geometry); }
    const Histogram& histogram() const { return histogram_; }

    // The bone. While the value is held (a slider is being moved) no thread looks for bone.
    const std::optional<IsoProposal>& proposed() const { return proposed_; }
    std::optional<double> iso() const;
    void setIso(std::optional<double> iso);
    void hold(bool is_held) { is_held_ = is_held; }
    const CaseBone* bone() const { return bone_.get(); }
    bool isBoneOfNow() const;
    // Of pieces that are no longer those of the iso-value this is refused, and said.
    void keepPiece(size_t piece, bool is_kept);
    // The bone's surface (V, m), and a number that changes with it.
    const std::vector<NodeMesh>& surface() const { return surface_; }
    int surfaceVersion() const { return surface_version_; }

    // The place. `plan` is missing where there is no bone for it; then the problem says so.
    const std::optional<CasePlan>& plan() const { return plan_; }
    const std::string& planProblem() const { return plan_problem_; }
    bool isOfPart() const { return !request_.at_mm.empty(); }
    // The part lies at the cross, or where the hand begins as long as the cross has not been moved.
    void millPart(bool is_wanted);
    void placeAt(const Eigen::Vector3d& p_W);
    double sizeMm() const { return request_.size_mm; }
    void setSizeMm(double size_mm);
    bool isHandChosen() const { return !request_.from_mm.empty(); }
    void bringHandFrom(const Eigen::Vector3d& outwards_W);
    void bringHandFromOutside();
    CaseMarks marks() const;
    void moveCross(const Eigen::Vector3d& p_W);
    void drag(Grip grip, const ScanPane& pane, const Eigen::Vector2d& pixel);

    // The structures of a label map.
    void openLabels(const std::string& path);
    const std::string& labelPath() const { return request_.labels; }
    const RawVolume* labels() const { return labels_.get(); }
    std::vector<StructureRow>& structures() { return structures_; }
    const std::vector<StructureRow>& structures() const { return structures_; }

    // Tools, folder and title, as the request has them.
    std::string& tools() { return request_.tools; }
    std::string& out() { return request_.out; }
    std::string& title() { return request_.title; }
    // Work that is under way is waited for; then the case is made, or is said why not.
    void make();
    bool takesMake() const { return (worker_.isBusy() && !is_making_) || whyNotYet().empty(); }
    bool waitsToMake() const { return wants_case_; }
    // The scene of the case that was made last; empty: none was.
    const std::string& madeScene() const { return made_scene_; }

    GreyWindow window;

  private:
    struct BoneKey {
        std::optional<double> iso;
        std::vector<uint32_t> drop_pieces;
        bool operator==(const BoneKey&) const = default;
    };
    BoneKey keyOfNow() const { return {request_.iso, request_.drop_pieces}; }
    void begin(const std::string& what, std::function<Worker::Done()> work);
    void say(DeskLine::Kind kind, const std::string& text) { lines_.push_back({kind, text}); }
    void listSeriesOf();
    void takeSeries(const SeriesRow& row);
    void readScan();
    void takeScan(RawVolume&& scan, const Histogram& histogram, const std::optional<IsoProposal>& proposed);
    void lookForBone();
    void takeBone(const std::shared_ptr<const CaseBone>& bone, const std::vector<NodeMesh>& surface,
                  const BoneKey& key);
    void readLabels();
    void dropWishToMake(const char* why);
    void makeIt();
    void takeReport(const std::string& report);
    void replan();
    Eigen::Vector3d middle() const;  // W, m: of the part, or of the bone that is there
    double handLength() const;

    CaseRequest request_;
    std::string version_, command_;
    std::vector<DeskLine> lines_;
    Worker worker_;
    std::string busy_with_;
    bool wants_series_ = false, wants_scan_ = false, wants_labels_ = false, wants_case_ = false;
    bool is_making_ = false;

    std::vector<SeriesRow> series_;
    std::shared_ptr<const RawVolume> scan_;
    Histogram histogram_;
    std::optional<IsoProposal> proposed_;
    bool is_held_ = false;
    std::optional<BoneKey> sought_key_, found_key_;  // of the bone that is looked for, and that is there
    std::shared_ptr<const CaseBone> bone_;
    std::vector<NodeMesh> surface_;
    int surface_version_ = 0;
    std::optional<CasePlan> plan_;
    std::string plan_problem_;
    std::optional<Eigen::Vector3d> cross_W_;
    std::shared_ptr<const RawVolume> labels_;
    std::vector<StructureRow> structures_;
    std::string made_scene_;
};

// The first of FOLDER, FOLDER_2, FOLDER_3 ... that does not exist.
std::string freeFolder(const std::filesystem::path& folder);

}  // namespace bonemill
