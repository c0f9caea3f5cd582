#include "render_client/look/model/tool_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/base/units.h"

namespace bonemill {
namespace {

constexpr int kTubeSides = 40;
constexpr float kSharpEdge = 0.7f;       // cosine between the slopes of two neighbours
constexpr float kShaftPart = 0.3f;       // of the tool's length: the shaft's radius is measured there
constexpr float kThickestShaft = 0.35f;  // of its length; what is thicker is no shaft
constexpr float kMm = float(kMillimetre);

using Stations = std::vector<TubeStation>;

// The columns are behind the shaft's end, to the side (-z of T), and the radius, in mm.
struct Outline {
    float behind, aside, radius;
};

// What holds the shaft is thicker than the shaft.
Stations stationsOf(const std::vector<Outline>& outline, const ShaftEnd& shaft) {
    Stations stations;
    for (const Outline& at : outline) {
        const float radius = at.radius > 0 ? std::max(at.radius * kMm, shaft.radius + 0.4f * kMm) : 0;
        stations.push_back({{0, shaft.y + at.behind * kMm, -at.aside * kMm}, radius});
    }
    return stations;
}

// A motor of a pen's size, with its cable.
const std::vector<Outline> kStraightBody = {
    {0, 0, 0},      {0, 0, 2.0f},   {1, 0, 2.6f},   {11, 0, 3.1f}, {11.5f, 0, 3.6f}, {14, 0, 3.6f},
    {24, 0, 5.6f},  {28, 0, 6.3f},  {31, 0, 6.5f},  {32, 0, 6.0f}, {34, 0, 6.0f},    {35, 0, 6.5f},
    {37, 0, 6.5f},  {38, 0, 6.0f},  {40, 0, 6.0f},  {41, 0, 6.5f}, {43, 0, 6.5f},    {44, 0, 6.0f},
    {46, 0, 6.0f},  {47, 0, 6.6f},  {78, 0, 7.2f},  {79, 0, 7.9f}, {104, 0, 7.9f},   {108, 0, 7.2f},
    {112, 0, 4.0f}, {122, 0, 2.2f}, {150, 0, 2.2f}, {150, 0, 0}};

// A contra-angle's head stands across its neck.
const std::vector<Outline> kHead = {{0, 0, 0},        {0, 0, 2.4f},     {0.7f, 0, 3.9f},  {1.6f, 0, 4.6f},
                                    {2.6f, 0, 4.8f},  {10.2f, 0, 4.8f}, {10.4f, 0, 4.5f}, {11.6f, 0, 4.4f},
                                    {12.6f, 0, 3.8f}, {13.2f, 0, 2.6f}, {13.4f, 0, 0}};
const std::vector<Outline> kNeck = {{6.4f, 1, 0},    {6.4f, 1, 3.9f},   {6.5f, 6, 3.7f}, {7.6f, 13, 3.5f},
                                    {10, 21, 3.7f},  {13.5f, 30, 4.4f}, {18, 40, 5.6f},  {20, 44, 6.3f},
                                    {20.4f, 45, 7},  {31, 68, 7.6f},    {42, 92, 7.6f},  {44, 96, 6.6f},
                                    {51, 111, 6.4f}, {53, 115, 3.6f},   {62, 135, 2.6f}, {62, 135, 0}};

topics::TriangleMesh contraAngle(const ShaftEnd& shaft) {
    topics::TriangleMesh mesh;
    addTube(stationsOf(kHead, shaft), &mesh);
    addTube(stationsOf(kNeck, shaft), &mesh);
    return mesh;
}

// A sleeve around the shaft, with a handle; the drill's body is behind it.
topics::TriangleMesh drillGuide(const ShaftEnd& shaft) {
    constexpr float kSleeveBegin = 0.66f, kSleeveEnd = 0.9f;  // of the shaft's length
    const float inner = shaft.radius + 0.15f * kMm, outer = shaft.radius + 1.3f * kMm;
    const float begin = kSleeveBegin * shaft.y, end = kSleeveEnd * shaft.y;
    const auto onAxis = [](float y, float radius) { return TubeStation{{0, y, 0}, radius}; };
    topics::TriangleMesh mesh;
    addTube({onAxis(begin, inner), onAxis(begin, outer), onAxis(end - 3 * kMm, outer),
             onAxis(end - kMm, outer + 1.2f * kMm), onAxis(end, outer + 1.2f * kMm), onAxis(end, inner)},
            &mesh);
    const Eigen::Vector3f hold(0, end - 2 * kMm, -outer);
    const auto onHandle = [&](float out, float radius) {
        return TubeStation{hold + out * kMm * Eigen::Vector3f(0, 0.35f, -0.94f), radius * kMm};
    };
    addTube({onHandle(-0.5f, 0), onHandle(-0.5f, 1.6f), onHandle(22, 1.6f), onHandle(24, 4.2f),
             onHandle(28, 5.2f), onHandle(80, 5.6f), onHandle(84, 4.8f), onHandle(86, 3), onHandle(86.5f, 0)},
            &mesh);
    addTube(stationsOf(kStraightBody, shaft), &mesh);
    return mesh;
}

// Returns the direction of the tube at a station; stations at the same place have the same one.
Eigen::Vector3f directionAt(const Stations& stations, size_t n) {
    size_t before = n, after = n;
    while (before > 0 && stations[before].center == stations[n].center) --before;
    while (after + 1 < stations.size() && stations[after].center == stations[n].center) ++after;
    const Eigen::Vector3f along = stations[after].center - stations[before].center;
    return along.isZero(0) ? Eigen::Vector3f(Eigen::Vector3f::UnitY()) : Eigen::Vector3f(along.normalized());
}

// The slope of the outline between two stations: how much of the normal goes outwards, and along the tube.
Eigen::Vector2f slopeOf(const TubeStation& a, const TubeStation& b) {
    const Eigen::Vector2f slope((b.center - a.center).norm(), a.radius - b.radius);
    return slope.isZero(0) ? Eigen::Vector2f(1, 0) : Eigen::Vector2f(slope.normalized());
}

void addRing(const TubeStation& station, const Eigen::Vector3f& along, const Eigen::Vector2f& slope,
             topics::TriangleMesh* mesh) {
    const Eigen::Vector3f right = Eigen::Vector3f::UnitX();  // tubes bend in the plane x = 0
    const Eigen::Vector3f up = along.cross(right).normalized();
    for (int s = 0; s <= kTubeSides; ++s) {
        const float angle = 2 * float(M_PI) * float(s) / kTubeSides;
        const Eigen::Vector3f out = std::cos(angle) * right + std::sin(angle) * up;
        const Eigen::Vector3f p = station.center + station.radius * out;
        const Eigen::Vector3f n = slope.x() * out + slope.y() * along;
        for (int axis = 0; axis < 3; ++axis) {
            mesh->add_vertices_m(p[axis]);
            mesh->add_normals(n[axis]);
        }
    }
}

void check(const topics::TriangleMesh& mesh) {
    const auto& positions = mesh.vertices_m();
    const auto vertex_count = uint32_t(positions.size() / 3);
    if (positions.size() % 3 != 0 || mesh.normals_size() != positions.size() || mesh.indices_size() % 3 != 0)
        throw std::invalid_argument("tool mesh: lists of different lengths");
    if (std::ranges::any_of(mesh.indices(), [&](uint32_t i) { return i >= vertex_count; }))
        throw std::invalid_argument("tool mesh: a triangle without its vertex");
}

void append(const topics::TriangleMesh& more, topics::TriangleMesh& mesh) {
    const auto first = uint32_t(mesh.vertices_m_size() / 3);
    mesh.mutable_vertices_m()->MergeFrom(more.vertices_m());
    mesh.mutable_normals()->MergeFrom(more.normals());
    for (const uint32_t index : more.indices()) mesh.add_indices(first + index);
}

Eigen::AlignedBox3f boxOf(const topics::TriangleMesh& mesh) {
    Eigen::AlignedBox3f box;
    const auto& p = mesh.vertices_m();
    for (int i = 0; i < p.size(); i += 3) box.extend(Eigen::Vector3f(p[i], p[i + 1], p[i + 2]));
    return box;
}

}  // namespace

std::optional<ShaftEnd> shaftEndOf(const topics::TriangleMesh& tool) {
    const auto& p = tool.vertices_m();
    ShaftEnd shaft{0, 0};
    for (int i = 0; i + 2 < p.size(); i += 3) shaft.y = std::max(shaft.y, p[i + 1]);
    for (int i = 0; i + 2 < p.size(); i += 3)
        if (p[i + 1] > (1 - kShaftPart) * shaft.y)
            shaft.radius = std::max(shaft.radius, std::hypot(p[i], p[i + 2]));
    if (!(shaft.y > 0) || shaft.radius > kThickestShaft * shaft.y) return std::nullopt;
    return shaft;
}

void addTube(const Stations& stations, topics::TriangleMesh* mesh) {
    const size_t segments = stations.size() - 1;
    std::vector<Eigen::Vector2f> slopes;
    for (size_t n = 0; n < segments; ++n) slopes.push_back(slopeOf(stations[n], stations[n + 1]));
    const auto smooth = [&](size_t n, size_t neighbour) -> Eigen::Vector2f {
        if (neighbour >= segments || slopes[n].dot(slopes[neighbour]) < kSharpEdge) return slopes[n];
        return (slopes[n] + slopes[neighbour]).normalized();
    };
    for (size_t n = 0; n < segments; ++n) {
        const auto first = uint32_t(mesh->vertices_m_size() / 3);
        addRing(stations[n], directionAt(stations, n), smooth(n, n - 1), mesh);
        addRing(stations[n + 1], directionAt(stations, n + 1), smooth(n, n + 1), mesh);
        for (uint32_t s = 0; s < kTubeSides; ++s) {
            const uint32_t a = first + s, b = a + kTubeSides + 1;
            for (const uint32_t i : {a, a + 1, b, b, a + 1, b + 1}) mesh->add_indices(i);
        }
    }
}

topics::TriangleMesh makeHandpiece(topics::SceneInfo::Handpiece kind, const ShaftEnd& shaft) {
    topics::TriangleMesh mesh;
    switch (kind) {
        case topics::SceneInfo::STRAIGHT:
            addTube(stationsOf(kStraightBody, shaft), &mesh);
            break;
        case topics::SceneInfo::CONTRA_ANGLE:
            mesh = contraAngle(shaft);
            break;
        case topics::SceneInfo::DRILL_GUIDE:
            mesh = drillGuide(shaft);
            break;
        default:  // none, or one that this viewer does not know
            break;
    }
    return mesh;
}

void ToolMesh::set(const topics::TriangleMesh& tool, topics::SceneInfo::Handpiece handpiece) {
    check(tool);
    const auto shaft = shaftEndOf(tool);
    const topics::TriangleMesh behind = shaft ? makeHandpiece(handpiece, *shaft) : topics::TriangleMesh();
    topics::TriangleMesh mesh = tool;
    append(behind, mesh);
    box_ = boxOf(tool);
    full_box_ = boxOf(mesh);
    const auto& positions = mesh.vertices_m();
    const auto& normals = mesh.normals();
    const auto& indices = mesh.indices();
    const GLsizeiptr half = GLsizeiptr(size_t(positions.size()) * sizeof(float));
    std::vector<float> packed(positions.begin(), positions.end());
    packed.insert(packed.end(), normals.begin(), normals.end());

    gl_.BindVertexArray(layout_.name());
    gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_.name());
    gl_.BufferData(GL_ARRAY_BUFFER, 2 * half, packed.data(), GL_STATIC_DRAW);
    gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
    gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(size_t(indices.size()) * sizeof(uint32_t)),
                   indices.data(), GL_STATIC_DRAW);
    gl_.setFloats(0, 3, 0, 0);
    gl_.setFloats(1, 3, 0, size_t(half));
    gl_.BindVertexArray(0);
    ++revision_;
    tool_indices_ = GLsizei(tool.indices_size());
    all_indices_ = GLsizei(indices.size());
}

void ToolMesh::draw(bool with_handpiece) const {
    gl_.BindVertexArray(layout_.name());
    gl_.DrawElements(GL_TRIANGLES, with_handpiece ? all_indices_ : tool_indices_, GL_UNSIGNED_INT, nullptr);
    gl_.BindVertexArray(0);
}

}  // namespace bonemill
