#include "render_client/case_window/case_desk/case_desk.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <utility>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "haptic_server/scans/import/import_volume.h"
#include "render_client/case_window/case_desk/coarse_bone.h"
#include "render_client/language/language.h"

namespace bonemill {
namespace {

constexpr double kStep = 0.1;        // mm: finer no mouse is
constexpr double kHandAway = 60;     // mm from the region's middle: where from_mm is put
constexpr double kMinArrow = 15e-3;  // m

std::vector<double> inSteps(const Eigen::Vector3d& p_W) {
    std::vector<double> mm;
    for (const double metres : p_W) mm.push_back(std::round(metres * kPerMillimetre / kStep) * kStep);
    // Multiples of 0.1 are written as short as they are meant.
    for (double& value : mm) value = std::round(value * 10) / 10 + 0.0;
    return mm;
}

ImportOptions importOptionsOf(const CaseRequest& request) {
    ImportOptions options{request.series, request.acquisition};
    if (const auto& mm = request.spacing_mm; !mm.empty())
        options.spacing_mm = Eigen::Vector3d(mm[0], mm[1], mm[2]);
    return options;
}

std::optional<IsoProposal> proposalOf(const RawVolume& scan) {
    if (scan.surface_value) return std::nullopt;
    try {
        return proposeIso(scan);
    } catch (const UserError&) {
        return std::nullopt;  // findBone() says why
    }
}

// Sliders end where numbers of single precision do.
void requireShowable(const RawVolume& scan) {
    constexpr double kMaxValue = 1e30;
    const ValueRange& range = scan.values.range();
    if (range.low > range.high)
        throw UserError(tr("the scan holds no finite value ({1})", {scan.description}));
    if (std::max(-range.low, range.high) > kMaxValue)
        throw UserError(tr("the scan's values reach beyond 1e30: it is damaged ({1})", {scan.description}));
}

// Of CT what radiologists see bone in; else all of the range that has voxels.
GreyWindow firstWindow(const RawVolume& scan, const Histogram& histogram) {
    if (scan.is_hounsfield) return {.width = 2500, .level = 600};
    const double width = histogram.width * double(histogram.count.size());
    return {.width = std::max(width, 1e-6), .level = histogram.low + width / 2};
}

}  // namespace

CaseDesk::CaseDesk(CaseRequest request, std::string version, std::string command)
    : request_(std::move(request)), version_(std::move(version)), command_(std::move(command)) {
    wants_series_ = !request_.scan.empty();
    wants_labels_ = !request_.labels.empty();
    if (request_.out.empty()) request_.out = freeFolder("cases/case");
}

void CaseDesk::begin(const std::string& what, std::function<Worker::Done()> work) {
    busy_with_ = what;
    worker_.start(std::move(work));
}

void CaseDesk::poll() {
    try {
        worker_.poll();
    } catch (const std::bad_alloc&) {
        say(DeskLine::Kind::kError, tr("there is not enough memory; close other programs"));
    } catch (const std::exception& error) {
        say(DeskLine::Kind::kError, error.what());
    }
    if (worker_.isBusy()) return;
    busy_with_.clear();
    is_making_ = false;
    if (std::exchange(wants_series_, false)) return listSeriesOf();
    if (std::exchange(wants_scan_, false)) return readScan();
    if (std::exchange(wants_labels_, false)) return readLabels();
    if (scan_ && sought_key_ != keyOfNow()) return is_held_ ? void() : lookForBone();
    if (std::exchange(wants_case_, false)) makeIt();
}

CaseRequest CaseDesk::request() const {
    CaseRequest request = request_;
    request.label_words = labelWordsOf(structures_);
    if (request.label_words.empty()) request.labels.clear();
    return request;
}

std::string CaseDesk::whyNotYet() const {
    if (!scan_) return tr("open a scan first");
    if (worker_.isBusy()) return tr("wait: {1}", {busy_with_});
    if (!bone_ || !isBoneOfNow()) return tr("no bone was found; move the iso-value");
    if (!plan_) return plan_problem_;
    return request_.out.empty() ? tr("name a folder for the case") : "";
}

// The scan

void CaseDesk::open(const std::string& path) {
    CaseRequest fresh;
    fresh.scan = path;
    fresh.size_mm = request_.size_mm;
    fresh.tools = request_.tools;
    fresh.out = request_.out;
    fresh.figures = request_.figures;
    request_ = fresh;
    structures_.clear();
    labels_.reset();
    series_.clear();
    lines_.clear();
    dropWishToMake(tr("another scan was opened"));
    wants_labels_ = false;
    wants_series_ = true;
}

std::optional<size_t> CaseDesk::chosenSeries() const {
    for (size_t row = 0; row < series_.size(); ++row) {
        const std::string acquisition = series_[row].acquisition == "-" ? "" : series_[row].acquisition;
        if (series_[row].uid == request_.series && acquisition == request_.acquisition) return row;
    }
    return series_.size() == 1 ? std::optional<size_t>(0) : std::nullopt;
}

void CaseDesk::takeSeries(const SeriesRow& row) {
    request_.series = row.uid;
    request_.acquisition = row.acquisition == "-" ? "" : row.acquisition;
    wants_scan_ = true;
}

// What was chosen of another scan means nothing in this one.
void CaseDesk::chooseSeries(size_t row) {
    dropWishToMake(tr("another series was chosen"));
    request_.iso.reset();
    request_.at_mm.clear();
    request_.from_mm.clear();
    request_.drop_pieces.clear();
    takeSeries(series_[row]);
}

// A file that has no series is read all the same.
void CaseDesk::listSeriesOf() {
    begin(tr("looking for series"), [this, path = request_.scan]() -> Worker::Done {
        std::vector<SeriesRow> rows;
        try {
            rows = rowsOfTable(listSeries(path));
        } catch (const UserError&) {
        }
        return [this, path, rows] {
            if (path != request_.scan) return;  // another one was opened meanwhile
            series_ = rows;
            wants_scan_ = true;
            if (rows.size() < 2 || !request_.series.empty()) return;
            const auto best = std::ranges::find(rows, true, &SeriesRow::is_recommended);
            if (best != rows.end()) takeSeries(*best);
        };
    });
}

void CaseDesk::readScan() {
    scan_.reset();
    bone_.reset();
    sought_key_.reset();
    plan_.reset();
    surface_.clear();
    ++surface_version_;
    cross_W_.reset();
    proposed_.reset();
    begin(tr("reading the scan"),
          [this, path = request_.scan, options = importOptionsOf(request_)]() -> Worker::Done {
              auto scan = std::make_shared<RawVolume>(importVolume(path, options));
              requireShowable(*scan);
              const Histogram histogram = histogramOf(ValueCounts(scan->values), scan->values.range());
              return [this, path, scan, histogram, proposed = proposalOf(*scan)] {
                  if (path == request_.scan) takeScan(std::move(*scan), histogram, proposed);
              };
          });
}

void CaseDesk::takeScan(RawVolume&& scan, const Histogram& histogram,
                        const std::optional<IsoProposal>& proposed) {
    scan_ = std::make_shared<const RawVolume>(std::move(scan));
    histogram_ = histogram;
    proposed_ = proposed;
    window = firstWindow(*scan_, histogram_);
    say(DeskLine::Kind::kPlain, scan_->description);
}

// The bone

std::optional<double> CaseDesk::iso() const {
    if (request_.iso) return request_.iso;
    if (scan_ && scan_->surface_value) return scan_->surface_value;
    return proposed_ ? std::optional(proposed_->value) : std::nullopt;
}

// Pieces go by their place in a list that is another one then.
void CaseDesk::setIso(std::optional<double> iso) {
    if (iso == request_.iso) return;
    request_.iso = iso;
    request_.drop_pieces.clear();
}

bool CaseDesk::isBoneOfNow() const {
    return bone_ && found_key_ == keyOfNow();
}

void CaseDesk::keepPiece(size_t piece, bool is_kept) {
    const auto number = uint32_t(piece + 1);
    if (!found_key_ || found_key_->iso != request_.iso)
        return say(DeskLine::Kind::kWarning,
                   tr("piece {1} was of another iso-value; choose among those of this one",
                      {std::to_string(number)}));
    std::erase(request_.drop_pieces, number);
    if (!is_kept) request_.drop_pieces.push_back(number);
    std::ranges::sort(request_.drop_pieces);
}

void CaseDesk::lookForBone() {
    sought_key_ = keyOfNow();
    begin(tr("looking for bone"),
          [this, scan = scan_, request = request_, key = keyOfNow()]() -> Worker::Done {
              try {
                  const auto bone = std::make_shared<const CaseBone>(findBone(*scan, request));
                  return
                      [this, bone, surface = coarseBone(bone->volume), key] { takeBone(bone, surface, key); };
              } catch (const UserError& error) {
                  return [this, text = std::string(error.what()), key] {
                      takeBone(nullptr, {}, key);
                      say(DeskLine::Kind::kError, text);
                  };
              }
          });
}

void CaseDesk::takeBone(const std::shared_ptr<const CaseBone>& bone, const std::vector<NodeMesh>& surface,
                        const BoneKey& key) {
    bone_ = bone;
    surface_ = surface;
    ++surface_version_;
    found_key_ = key;
    replan();
}

// The place

void CaseDesk::replan() {
    plan_.reset();
    plan_problem_.clear();
    if (!bone_) return;
    try {
        plan_ = planCase(*bone_, request_);
    } catch (const UserError& error) {
        plan_problem_ = error.what();
    }
}

void CaseDesk::millPart(bool is_wanted) {
    if (is_wanted == isOfPart()) return;
    if (is_wanted) return placeAt(cross_W_ || !plan_ ? marks().cross_W : plan_->start);
    request_.at_mm.clear();
    replan();
}

void CaseDesk::placeAt(const Eigen::Vector3d& p_W) {
    request_.at_mm = inSteps(p_W);
    replan();
}

void CaseDesk::setSizeMm(double size_mm) {
    request_.size_mm = size_mm;
    replan();
}

Eigen::Vector3d CaseDesk::middle() const {
    if (!isOfPart()) return bone_->middle;
    return Eigen::Vector3d(request_.at_mm[0], request_.at_mm[1], request_.at_mm[2]) * kMillimetre;
}

void CaseDesk::bringHandFrom(const Eigen::Vector3d& outwards_W) {
    request_.from_mm = inSteps(middle() + kHandAway * kMillimetre * outwards_W.normalized());
    replan();
}

void CaseDesk::bringHandFromOutside() {
    request_.from_mm.clear();
    replan();
}

double CaseDesk::handLength() const {
    return std::max(kMinArrow,
                    isOfPart() ? 0.9 * request_.size_mm * kMillimetre : 0.25 * scanBox().sizes().maxCoeff());
}

CaseMarks CaseDesk::marks() const {
    CaseMarks marks;
    if (!scan_) return marks;
    marks.cross_W = cross_W_.value_or(isOfPart() || bone_ ? middle() : scanBox().center());
    if (isOfPart()) {
        const Eigen::Vector3d half = Eigen::Vector3d::Constant(request_.size_mm * kMillimetre / 2);
        marks.region_W = Eigen::AlignedBox3d(middle() - half, middle() + half);
    }
    if (plan_) {
        marks.start_W = plan_->start;
        marks.hand_W = plan_->start + handLength() * plan_->outwards;
    }
    return marks;
}

void CaseDesk::moveCross(const Eigen::Vector3d& p_W) {
    const Eigen::AlignedBox3d box = scanBox();
    cross_W_ = p_W.cwiseMax(box.min()).cwiseMin(box.max());
}

void CaseDesk::drag(Grip grip, const ScanPane& pane, const Eigen::Vector2d& pixel) {
    const CaseMarks now = marks();
    if (grip == Grip::kCross) return moveCross(pane.toWorld(pixel));
    if (grip == Grip::kRegion && now.region_W) return placeAt(pane.moved(now.region_W->center(), pixel));
    if (grip == Grip::kHand && now.hand_W) bringHandFrom(turnedHand(pane, *now.start_W, *now.hand_W, pixel));
}

// The structures

void CaseDesk::openLabels(const std::string& path) {
    request_.labels = path;
    request_.label_words.clear();
    structures_.clear();
    labels_.reset();
    wants_labels_ = !path.empty();
}

void CaseDesk::readLabels() {
    begin(tr("reading the labels"),
          [this, path = request_.labels, words = request_.label_words]() -> Worker::Done {
              const auto map = std::make_shared<const RawVolume>(importVolume(path));
              std::vector<StructureRow> rows = structuresOf(*map);
              takeWords(words, rows);
              return [this, path, map, rows] {
                  if (path != request_.labels) return;
                  labels_ = map;
                  structures_ = rows;
              };
          });
}

std::string freeFolder(const std::filesystem::path& folder) {
    std::error_code ignored;
    std::filesystem::path free = folder;
    for (int n = 2; std::filesystem::exists(free, ignored); ++n)
        free = folder.string() + "_" + std::to_string(n);
    return free.string();
}

}  // namespace bonemill
