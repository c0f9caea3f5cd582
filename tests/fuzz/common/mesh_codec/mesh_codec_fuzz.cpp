// The decoder gets bytes that never were a mesh, and meshes with damaged bytes. It tells most
// with -DBONEMILL_SANITIZE=address,undefined.
#include <gtest/gtest.h>

#include <cstdlib>

#include "common/mesh_codec/mesh_codec.h"
#include "proto/topics.pb.h"
#include "tests/support/node_meshes.h"

namespace bonemill {
namespace {

// BONEMILL_FUZZ_SEED repeats or varies a run.
unsigned fuzzSeed() {
    const char* text = std::getenv("BONEMILL_FUZZ_SEED");
    return text ? unsigned(std::strtoul(text, nullptr, 10)) : 20120601u;
}

class MeshCodecFuzz : public testing::Test {
  protected:
    MeshCodecFuzz() : random_(fuzzSeed()) { RecordProperty("seed", std::to_string(fuzzSeed())); }

    int below(size_t limit) { return int(std::uniform_int_distribution<size_t>(0, limit - 1)(random_)); }
    std::string randomBytes(size_t size) {
        std::string bytes(size, '\0');
        for (char& c : bytes) c = char(below(256));
        return bytes;
    }
    void damage(std::string& bytes) {
        for (int n = 1 + below(4); n > 0 && !bytes.empty(); --n) {
            const size_t at = size_t(below(bytes.size()));
            switch (below(4)) {
                case 0:
                    bytes[at] = char(below(256));
                    break;
                case 1:
                    bytes[at] = char(bytes[at] ^ 1 << below(8));
                    break;
                case 2:
                    bytes.erase(at, size_t(1 + below(8)));
                    break;
                default:
                    bytes.insert(at, randomBytes(size_t(1 + below(8))));
                    break;
            }
        }
    }
    // Whatever is accepted must be safe to draw.
    void decodeAndCheck(const std::string& bytes) {
        const auto decoded = decodeNodeMesh(bytes, 3);
        if (!decoded) return;
        const NodeMesh* mesh = &decoded->mesh;
        ++accepted_;
        EXPECT_TRUE(mesh->origin.allFinite() && mesh->step.allFinite());
        EXPECT_EQ(mesh->indices.size() % 3, 0u);
        EXPECT_LE(mesh->indices.size(), 3 * bytes.size());
        EXPECT_LE(mesh->vertices.size(), mesh->indices.size());
        for (const uint32_t index : mesh->indices) ASSERT_LT(index, mesh->vertices.size());
        EXPECT_TRUE(mesh->materials.empty() || mesh->materials.size() == mesh->vertices.size());
    }
    NodeMesh anyMesh(int n) {
        return n % 2 ? test::sheetMesh(1 + below(8), unsigned(n))
                     : test::colouredSheetMesh(1 + below(8), unsigned(n));
    }

    std::mt19937 random_;
    int accepted_ = 0;
};

TEST_F(MeshCodecFuzz, RandomBytes) {
    for (int n = 0; n < 20000; ++n) decodeAndCheck(randomBytes(size_t(below(400))));
}

TEST_F(MeshCodecFuzz, DamagedMessages) {
    for (int n = 0; n < 20000; ++n) {
        std::string bytes = encodeNodeMesh(anyMesh(n), {}).bytes;
        damage(bytes);
        decodeAndCheck(bytes);
    }
    EXPECT_GT(accepted_, 0) << "the damage never got past the outer checks";
}

// Aims straight at meshoptimizer's decoders: a well-formed message stands around damaged buffers and
// lying counts.
TEST_F(MeshCodecFuzz, DamagedBuffersInsideAWellFormedMessage) {
    for (int n = 0; n < 20000; ++n) {
        topics::NodeMesh message;
        ASSERT_TRUE(message.ParseFromString(encodeNodeMesh(anyMesh(n), {}).bytes));
        if (below(2) == 0) damage(*message.mutable_vertices());
        if (below(2) == 0) damage(*message.mutable_indices());
        if (below(2) == 0) damage(*message.mutable_materials());
        if (below(4) == 0) message.set_vertex_count(message.vertex_count() + uint32_t(below(9)) - 4);
        if (below(4) == 0) message.set_index_count(message.index_count() + 3 * (uint32_t(below(9)) - 4));
        decodeAndCheck(message.SerializeAsString());
    }
    EXPECT_GT(accepted_, 0);
}

TEST_F(MeshCodecFuzz, RandomBuffersInsideAWellFormedMessage) {
    for (int n = 0; n < 20000; ++n) {
        topics::NodeMesh message;
        for (int axis = 0; axis < 3; ++axis) {
            message.add_origin_m(0);
            message.add_step_m(1);
        }
        message.set_vertices(randomBytes(size_t(below(200))));
        message.set_indices(randomBytes(size_t(below(200))));
        message.set_materials(randomBytes(size_t(below(20))));
        // The headers are valid, as otherwise nearly every try would end at the first byte.
        if (!message.vertices().empty()) (*message.mutable_vertices())[0] = char(0xa0);
        if (!message.indices().empty()) (*message.mutable_indices())[0] = char(0xe1);
        message.set_vertex_count(uint32_t(below(300)));
        message.set_index_count(3 * uint32_t(below(200)));
        decodeAndCheck(message.SerializeAsString());
    }
}

}  // namespace
}  // namespace bonemill
