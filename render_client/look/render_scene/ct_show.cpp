#include "render_client/look/render_scene/ct_show.h"

#include <algorithm>
#include <cstdio>
#include <unordered_set>
#include <utility>

#include "render_client/language/language.h"
#include "render_client/look/slices/slice_image.h"
#include "render_client/look/slices/slice_plane.h"

namespace bonemill {
namespace {

constexpr uint16_t kMilled = 65535;
constexpr double kInsideBone =
    0.03;  // of all densities: a wall lay so far above the surface's, or it is the scan's

// Tells apart what is here of the bricks; never 0.
uint64_t stampOf(const std::vector<uint32_t>& bricks, const DensityStore& store) {
    uint64_t stamp = 1469598103934665603u;  // FNV-1a
    for (const uint32_t number : bricks) {
        const DensityBrick* const brick = store.find(number);
        stamp = (stamp ^ (brick ? uint64_t(brick->revision) + 2 : 1)) * 1099511628211u;
    }
    return stamp | 1;
}

std::vector<NodeStore::VertexScan> scanOf(const NodeMesh& mesh, const DensitySampler& sampler, double least) {
    std::vector<NodeStore::VertexScan> scan;
    scan.reserve(mesh.vertices.size());
    for (const PackedVertex& vertex : mesh.vertices) {
        const Eigen::Vector3f steps(vertex.x, vertex.y, vertex.z);
        const Eigen::Vector3f p_V = mesh.origin + mesh.step.cwiseProduct(steps);
        const SampledDensity sample = sampler.at(p_V.cast<double>());
        const bool is_milled = sample.was_changed && sample.scanned >= least;
        scan.push_back({sample.scanned, is_milled ? kMilled : uint16_t(0)});
    }
    return scan;
}

constexpr int kMaxFacePixels = 1024;  // per side

std::string millimetres(const char* axis, double metres) {
    char text[32];
    std::snprintf(text, sizeof text, "%s %.1f mm", axis, metres * 1e3);
    return text;
}

}  // namespace

void MilledScan::update(const DensitySampler& sampler, const DensityStore& store, NodeStore& nodes) {
    const DensityGrid& grid = *store.grid();
    const double least = densityOf(grid, grid.iso_value) + kInsideBone * 65535;
    struct Due {
        uint32_t leaf;
        uint64_t stamp;
        std::vector<NodeStore::VertexScan> scan;
    };
    std::vector<Due> due;
    bricks_.clear();
    nodes.visitMilled([&](const NodeMesh& mesh, const Eigen::AlignedBox3f& box, uint64_t stamp) {
        const std::vector<uint32_t> around = bricksIn(grid, box.cast<double>());
        bricks_.insert(bricks_.end(), around.begin(), around.end());
        const uint64_t now = stampOf(around, store);
        if (now != stamp) due.push_back({mesh.leaf, now, scanOf(mesh, sampler, least)});
    });
    for (const Due& node : due) nodes.setScan(node.leaf, node.scan, node.stamp);
}

void CtShow::setPalette(const std::vector<Eigen::Vector4f>& palette) {
    bone_colours_ = boneColoursOf(palette);
    face_slices_ = {};
}

Eigen::AlignedBox3f CtShow::update(const View& view, NodeStore& nodes) {
    width_ = view.width;
    height_ = view.height;
    columns_ = paneColumns(view.settings, view.width, view.height);
    const auto& grid = store_.grid();
    if (std::exchange(grid_, grid) != grid) {
        pane_slices_ = {};
        face_slices_ = {};
        painted_ = {};
    }
    window_.reset();
    if (grid) window_ = view.settings.slices.window.value_or(startWindow(*grid));
    updatePanes(view);
    const Eigen::AlignedBox3f changed = updateFaces(view);
    updateMilled(view, nodes);
    sampler_.reset();
    wantAll();
    return changed;
}

void CtShow::updatePanes(const View& view) {
    panes_.reset();
    if (columns_ == 0) {
        pane_slices_ = {};
        painted_ = {};
        return;
    }
    if (!painter_) painter_ = std::make_unique<SlicePainter>(gl_);
    const std::array<PaneRect, 3> rects = paneRects(view.settings, view.width, view.height);
    if (!store_.grid()) return showNoGrid(view);
    panes_.emplace();
    for (size_t axis = 0; axis < 3; ++axis) {
        Pane& pane = (*panes_)[axis];
        pane = makePane(*store_.grid(), view.X_WV, view.settings.slices, axis, rects[axis], view.burr);
        are_scrolled_[axis] = view.settings.slices.positions[axis].has_value();
        if (!pane_slices_[axis]) pane_slices_[axis].emplace();
        ShownSlice& slice = *pane_slices_[axis];
        if (!look(slice, pane.plane) && painted_[axis] == window_) continue;
        painted_[axis] = window_;
        painter_->setPixels(axis, coloursOf(slice.image, *store_.grid(), *window_), slice.image.width,
                            slice.image.height);
    }
}

// The server has not told of a scan: it may be an older one, or nothing has come yet.
void CtShow::showNoGrid(const View& view) {
    pane_slices_ = {};
    painted_ = {};
    const std::array<PaneRect, 3> rects = paneRects(view.settings, view.width, view.height);
    panes_.emplace();
    for (size_t axis = 0; axis < 3; ++axis) {
        Pane& pane = (*panes_)[axis];
        pane.axis = axis;
        pane.rect = rects[axis];
        SliceImage nothing{pane.rect.width, pane.rect.height, {}, {}, {}, {}};
        nothing.state.resize(size_t(pane.rect.width) * size_t(pane.rect.height), SliceState::kLoading);
        painter_->setPixels(axis, coloursOf(nothing, {}, {}), nothing.width, nothing.height);
    }
}

Eigen::AlignedBox3f CtShow::updateFaces(const View& view) {
    const bool wants_faces =
        view.settings.slices.ct != CtShown::kNowhere && store_.grid() && !view.bone_W.isEmpty();
    const CutPlanes cuts = cutPlanes(view.settings.cuts, view.bone_W);
    const BoneColours* const colours =
        view.settings.slices.ct == CtShown::kMaterialsOnCuts ? &bone_colours_ : nullptr;
    shows_faces_ = wants_faces && cuts.any();
    if (shows_faces_ && !faces_) faces_ = std::make_unique<CtFaces>(gl_);
    Eigen::AlignedBox3f changed;
    if (!faces_) return changed;
    for (size_t axis = 0; axis < 3; ++axis) {
        std::optional<ShownSlice>& slice = face_slices_[axis];
        if (!shows_faces_ || !cuts.is_on[axis]) {
            changed.extend(faces_->remove(axis));
            slice.reset();
            continue;
        }
        const Eigen::Index i = Eigen::Index(axis);
        const double position_W =
            view.bone_W.min()[i] + view.settings.cuts[axis].position * view.bone_W.sizes()[i];
        if (!slice) slice.emplace();
        if (look(*slice, facePlane(*store_.grid(), view.X_WV, axis, position_W, view.bone_W, kMaxFacePixels),
                 colours))
            changed.extend(faces_->set(axis, slice->plane, slice->image));
    }
    if (shows_faces_) changed.extend(faces_->setWindow(*store_.grid(), *window_));
    return changed;
}

void CtShow::updateMilled(const View& view, NodeStore& nodes) {
    milled_grey_.reset();
    if (view.settings.slices.ct != CtShown::kOnCutsAndMilled || !grid_) return milled_.clear();
    milled_.update(sampler(), store_, nodes);
    milled_grey_ = greyOfDensity(*grid_, *window_).cast<float>();
}

bool CtShow::look(ShownSlice& slice, const SlicePlane& plane, const BoneColours* colours) {
    const bool is_coloured = !slice.image.colours.empty();
    if (slice.is_known && slice.plane == plane && slice.changes == store_.changes() &&
        is_coloured == (colours != nullptr))
        return false;
    if (!slice.is_known || slice.plane != plane) {
        slice.plane = plane;
        slice.bricks = bricksOf(*store_.grid(), plane);
    }
    SliceImage image = sampler().image(plane, colours);
    slice.changes = store_.changes();
    const bool is_new = !slice.is_known || image != slice.image;
    slice.image = std::move(image);
    slice.is_known = true;
    return is_new;
}

const DensitySampler& CtShow::sampler() {
    if (!sampler_) sampler_.emplace(store_);
    return *sampler_;
}

// What the burr is near comes first: each plane's bricks are in that order, and the panes take turns.
void CtShow::wantAll() {
    std::vector<const std::vector<uint32_t>*> lists;
    for (const auto* slices : {&pane_slices_, &face_slices_})
        for (const auto& slice : *slices)
            if (slice) lists.push_back(&slice->bricks);
    lists.push_back(&milled_.bricks());
    std::vector<uint32_t> wanted;
    std::unordered_set<uint32_t> known;
    size_t longest = 0;
    for (const auto* list : lists) longest = std::max(longest, list->size());
    for (size_t i = 0; i < longest; ++i)
        for (const auto* list : lists)
            if (i < list->size() && known.insert((*list)[i]).second) wanted.push_back((*list)[i]);
    store_.want(std::move(wanted));
}

void CtShow::paintPanes(GLuint target) const {
    if (panes_) painter_->paint(*panes_, columns_, width_, height_, target);
}

std::optional<SeenPanes> CtShow::seenPanes() const {
    if (!panes_ || !grid_) return std::nullopt;
    return SeenPanes{*panes_, *grid_, *window_};
}

// A few bricks that come anew, as bone is milled, are not worth a word.
bool CtShow::isLoading(const std::optional<ShownSlice>& slice) {
    constexpr int kShare = 4;
    if (!slice) return true;
    const auto& state = slice->image.state;
    return kShare * size_t(std::ranges::count(state, SliceState::kLoading)) > state.size();
}

std::vector<HudPane> CtShow::texts(bool are_patients_axes) const {
    constexpr const char* kAxes[] = {"x", "y", "z"};
    std::vector<HudPane> texts;
    if (!panes_) return texts;
    for (const Pane& pane : *panes_) {
        const SliceLabels& labels = sliceLabelsOf(pane.axis, are_patients_axes);
        HudPane text;
        text.x = float(pane.rect.x), text.y = float(pane.rect.y);
        text.width = float(pane.rect.width), text.height = float(pane.rect.height);
        text.title = tr(labels.title);
        text.left = labels.left, text.right = labels.right, text.top = labels.top,
        text.bottom = labels.bottom;
        if (window_) {
            text.window = textOf(*window_);
            text.place = millimetres(kAxes[pane.axis], pane.position_W);
            text.is_scrolled = are_scrolled_[pane.axis];
            if (isLoading(pane_slices_[pane.axis])) text.problem = tr("loading");
        } else {
            text.problem = tr("no scan from this server yet");
        }
        texts.push_back(std::move(text));
    }
    return texts;
}

}  // namespace bonemill
