#include "common/mesh_codec/mesh_codec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "proto/topics.pb.h"
#include "tests/support/node_meshes.h"

namespace bonemill {
namespace {

constexpr uint64_t kEpoch = 1'700'000'000'123'456'789;

topics::NodeMesh messageOf(const NodeMesh& mesh) {
    topics::NodeMesh message;
    EXPECT_TRUE(message.ParseFromString(encodeNodeMesh(mesh, {.epoch = kEpoch}).bytes));
    return message;
}

bool isRefused(const topics::NodeMesh& message) {
    return !decodeNodeMesh(message.SerializeAsString(), 1).has_value();
}

TEST(MeshCodec, RoundTripKeepsTheSurface) {
    for (const int side : {1, 2, 7, 16, 40}) {
        const NodeMesh mesh = test::sheetMesh(side, unsigned(side));
        const NodeTag tag{.epoch = kEpoch, .batch = 7, .batch_nodes = 3, .cut_stamp_ns = -5};
        const EncodedNode encoded = encodeNodeMesh(mesh, tag);
        const auto decoded = decodeNodeMesh(encoded.bytes, mesh.leaf);
        ASSERT_TRUE(decoded.has_value());
        EXPECT_EQ(decoded->tag.epoch, kEpoch);
        EXPECT_EQ(decoded->tag.batch, 7u);
        EXPECT_EQ(decoded->tag.batch_nodes, 3u);
        EXPECT_EQ(decoded->tag.cut_stamp_ns, -5);
        EXPECT_EQ(decoded->content, encoded.content);
        const NodeMesh* back = &decoded->mesh;
        EXPECT_EQ(back->leaf, mesh.leaf);
        EXPECT_EQ(back->revision, mesh.revision);
        EXPECT_EQ(back->origin, mesh.origin);
        EXPECT_EQ(back->step, mesh.step);
        EXPECT_EQ(back->vertices.size(), mesh.vertices.size());
        EXPECT_EQ(test::triangleKeys(*back), test::triangleKeys(mesh));
    }
}

TEST(MeshCodec, EmptyMeshComesBackEmpty) {
    NodeMesh mesh;
    mesh.revision = 8;
    mesh.step.setConstant(1e-6f);
    const auto decoded = decodeNodeMesh(encodeNodeMesh(mesh, {.epoch = 5}).bytes, 77);
    ASSERT_TRUE(decoded.has_value());
    const NodeMesh* back = &decoded->mesh;
    EXPECT_TRUE(back->isEmpty());
    EXPECT_TRUE(back->vertices.empty());
    EXPECT_EQ(back->leaf, 77u);
    EXPECT_EQ(back->revision, 8u);
}

TEST(MeshCodec, EqualMeshesGiveEqualBytes) {
    EXPECT_EQ(encodeNodeMesh(test::sheetMesh(12, 3), {}).bytes,
              encodeNodeMesh(test::sheetMesh(12, 3), {}).bytes);
}

TEST(MeshCodec, CodedSizeIsFarBelowTheRawBuffers) {
    const NodeMesh mesh = test::sheetMesh(20, 1);
    const size_t raw = mesh.vertices.size() * sizeof(PackedVertex) + mesh.indices.size() * sizeof(uint32_t);
    EXPECT_LT(encodeNodeMesh(mesh, {}).bytes.size(), raw / 2);
}

TEST(MeshCodec, TheOrderOfTheTrianglesCostsFewBytes) {
    NodeMesh mesh = test::sheetMesh(40, 1);
    const size_t bytes = encodeNodeMesh(mesh, {}).bytes.size();
    std::vector<std::array<uint32_t, 3>> triangles(mesh.indices.size() / 3);
    std::memcpy(triangles.data(), mesh.indices.data(), mesh.indices.size() * sizeof(uint32_t));
    std::ranges::shuffle(triangles, std::mt19937(3));
    std::memcpy(mesh.indices.data(), triangles.data(), mesh.indices.size() * sizeof(uint32_t));
    EXPECT_LT(double(encodeNodeMesh(mesh, {}).bytes.size()), 1.1 * double(bytes));
}

TEST(MeshCodec, UnusedVerticesAreDropped) {
    NodeMesh mesh = test::sheetMesh(3, 1);
    mesh.vertices.push_back({1, 2, 3, 4, 5});
    const auto back = decodeNodeMesh(encodeNodeMesh(mesh, {}).bytes, 1);
    ASSERT_TRUE(back.has_value());
    EXPECT_EQ(back->mesh.vertices.size(), mesh.vertices.size() - 1);
}

TEST(MeshCodec, RefusesIndexBeyondTheVertices) {
    const topics::NodeMesh large = messageOf(test::sheetMesh(9, 1));
    topics::NodeMesh mixed = messageOf(test::sheetMesh(4, 1));
    mixed.set_indices(large.indices());
    mixed.set_index_count(large.index_count());
    EXPECT_TRUE(isRefused(mixed));
}

TEST(MeshCodec, RefusesCountsThatTheBytesCannotHold) {
    const topics::NodeMesh good = messageOf(test::sheetMesh(5, 1));
    ASSERT_FALSE(isRefused(good));
    for (const uint32_t count :
         {0u, 1u, 3u, good.index_count() - 3, good.index_count() + 3, 4294967295u, 4294967292u}) {
        topics::NodeMesh bad = good;
        bad.set_index_count(count);
        EXPECT_TRUE(isRefused(bad)) << count << " indices";
    }
    for (const uint32_t count : {0u, 1u, good.vertex_count() - 1, good.index_count() + 1, 4294967295u}) {
        topics::NodeMesh bad = good;
        bad.set_vertex_count(count);
        EXPECT_TRUE(isRefused(bad)) << count << " vertices";
    }
}

TEST(MeshCodec, RefusesBadOriginAndStep) {
    const topics::NodeMesh good = messageOf(test::sheetMesh(5, 1));
    const auto refusedWith = [&](auto change) {
        topics::NodeMesh bad = good;
        change(bad);
        return isRefused(bad);
    };
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInf = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(refusedWith([](auto& m) { m.clear_origin_m(); }));
    EXPECT_TRUE(refusedWith([](auto& m) { m.add_origin_m(0); }));
    EXPECT_TRUE(refusedWith([](auto& m) { m.set_origin_m(1, kNan); }));
    EXPECT_TRUE(refusedWith([](auto& m) { m.set_origin_m(2, kInf); }));
    EXPECT_TRUE(refusedWith([](auto& m) { m.clear_step_m(); }));
    EXPECT_TRUE(refusedWith([](auto& m) { m.set_step_m(0, kNan); }));
    EXPECT_TRUE(refusedWith([](auto& m) { m.set_step_m(0, 0); }));
    EXPECT_TRUE(refusedWith([](auto& m) { m.set_step_m(0, -1e-6f); }));
}

TEST(MeshCodec, EachVertexKeepsItsMaterial) {
    for (const int side : {1, 2, 7, 40}) {
        NodeMesh mesh = test::colouredSheetMesh(side, unsigned(side));
        mesh.vertices.push_back({1, 2, 3, 4, 5});  // named by no triangle
        mesh.materials.push_back(9);
        const EncodedNode encoded = encodeNodeMesh(mesh, {});
        const auto decoded = decodeNodeMesh(encoded.bytes, mesh.leaf);
        ASSERT_TRUE(decoded);
        EXPECT_EQ(decoded->content, encoded.content);
        EXPECT_EQ(decoded->mesh.materials.size(), decoded->mesh.vertices.size());
        EXPECT_EQ(test::triangleKeys(decoded->mesh), test::triangleKeys(mesh));
    }
}

TEST(MeshCodec, ALongRunOfOneMaterialTakesFewBytes) {
    NodeMesh mesh = test::sheetMesh(40, 1);
    const topics::NodeMesh plain = messageOf(mesh);
    mesh.materials.assign(mesh.vertices.size(), 200);
    const topics::NodeMesh coloured = messageOf(mesh);
    EXPECT_EQ(plain.materials().size(), 0u);
    EXPECT_EQ(coloured.materials().size(), 3u);
    EXPECT_EQ(coloured.vertices(), plain.vertices());
    EXPECT_EQ(coloured.indices(), plain.indices());
    EXPECT_EQ(decodeNodeMesh(coloured.SerializeAsString(), 1)->mesh.materials, mesh.materials);
}

TEST(MeshCodec, MaterialsAreContent) {
    NodeMesh mesh = test::colouredSheetMesh(5, 1);
    const uint64_t coloured = encodeNodeMesh(mesh, {}).content;
    mesh.materials.back() ^= 1;
    EXPECT_NE(encodeNodeMesh(mesh, {}).content, coloured);
    mesh.materials.clear();
    EXPECT_NE(encodeNodeMesh(mesh, {}).content, coloured);
}

TEST(MeshCodec, RefusesMaterialsThatAreNotOnePerVertex) {
    const topics::NodeMesh good = messageOf(test::sheetMesh(3, 1));
    ASSERT_EQ(good.vertex_count(), 16u);
    const auto refuses = [&](const std::string& materials) {
        topics::NodeMesh message = good;
        message.set_materials(materials);
        return isRefused(message);
    };
    EXPECT_FALSE(refuses("\x01\x10"));
    EXPECT_FALSE(refuses("\x01\x0f\x02\x01"));
    EXPECT_TRUE(refuses("\x01\x0f"));                              // too few
    EXPECT_TRUE(refuses("\x01\x11"));                              // too many
    EXPECT_TRUE(refuses("\x01\x10\x02"));                          // a run without its length
    EXPECT_TRUE(refuses("\x01\x90"));                              // a length that goes on
    EXPECT_TRUE(refuses(std::string("\x01\x10\x02\x00", 4)));      // an empty run
    EXPECT_TRUE(refuses("\x01\x90\x80\x80\x80\x80\x80\x80\x10"));  // a length without end
    EXPECT_TRUE(refuses("\x01\xff\xff\xff\xff\x7f"));              // far too many
}

// The message cut just before its counts is, byte for byte, that of an emptied leaf; nothing else may pass.
TEST(MeshCodec, NeverShowsPartOfATruncatedMesh) {
    const std::string bytes = encodeNodeMesh(test::sheetMesh(6, 1), {.epoch = kEpoch}).bytes;
    int accepted = 0;
    for (size_t length = 0; length < bytes.size(); ++length) {
        const auto node = decodeNodeMesh(std::string_view(bytes).substr(0, length), 1);
        if (!node) continue;
        ++accepted;
        EXPECT_TRUE(node->mesh.isEmpty() && node->mesh.vertices.empty()) << length;
    }
    EXPECT_LE(accepted, 1);
}

TEST(MeshCodec, RefusesBuffersWithoutCounts) {
    topics::NodeMesh message = messageOf(test::sheetMesh(5, 1));
    message.clear_vertex_count();
    message.clear_index_count();
    EXPECT_TRUE(isRefused(message));
}

}  // namespace
}  // namespace bonemill
