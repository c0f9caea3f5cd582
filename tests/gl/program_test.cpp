#include <gtest/gtest.h>

#include "render_client/look/gl/gl_api.h"
#include "render_client/look/offscreen/osmesa_context.h"

namespace bonemill {
namespace {

TEST(Program, ABadShaderIsNamedWithTheCompilersLog) {
    const OsmesaContext context(64, 64);
    try {
        const Program program(context.gl(), "broken", "void main() { gl_Position = vec4(0); }",
                              "out vec4 c; void main() { c = nonsense; }");
        FAIL() << "compiled";
    } catch (const GlError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("broken"), std::string::npos) << message;
        EXPECT_NE(message.find("fragment"), std::string::npos) << message;
        EXPECT_NE(message.find("nonsense"), std::string::npos) << message;
    }
}

TEST(Program, StagesThatDoNotFitDoNotLink) {
    const OsmesaContext context(64, 64);
    EXPECT_THROW(
        Program(context.gl(), "unlinked", "out vec2 v; void main() { v = vec2(0); gl_Position = vec4(0); }",
                "in vec3 v; out vec4 c; void main() { c = vec4(v, 1); }"),
        GlError);
}

TEST(GlApi, NamesTheMissingFunction) {
    try {
        GlApi::load([](const char*) -> void* { return nullptr; });
        FAIL() << "loaded";
    } catch (const GlError& error) {
        EXPECT_NE(std::string(error.what()).find("glActiveTexture"), std::string::npos);
    }
}

}  // namespace
}  // namespace bonemill
