// These are the OpenGL 3.3 core functions that this program uses, loaded from whichever context is current,
// and what is made with them: objects and shader programs.
//
// A GlApi belongs to the thread whose context was current when it was loaded. It is not RT-safe.
#pragma once

#include <GL/glcorearb.h>

#include <Eigen/Core>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

#define BONEMILL_GL_FUNCTIONS(X)                                               \
    X(PFNGLACTIVETEXTUREPROC, ActiveTexture)                                   \
    X(PFNGLATTACHSHADERPROC, AttachShader)                                     \
    X(PFNGLBEGINQUERYPROC, BeginQuery)                                         \
    X(PFNGLBINDBUFFERPROC, BindBuffer)                                         \
    X(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer)                               \
    X(PFNGLBINDRENDERBUFFERPROC, BindRenderbuffer)                             \
    X(PFNGLBINDTEXTUREPROC, BindTexture)                                       \
    X(PFNGLBINDVERTEXARRAYPROC, BindVertexArray)                               \
    X(PFNGLBLENDFUNCPROC, BlendFunc)                                           \
    X(PFNGLBLITFRAMEBUFFERPROC, BlitFramebuffer)                               \
    X(PFNGLBUFFERDATAPROC, BufferData)                                         \
    X(PFNGLCHECKFRAMEBUFFERSTATUSPROC, CheckFramebufferStatus)                 \
    X(PFNGLCLEARPROC, Clear)                                                   \
    X(PFNGLCLEARBUFFERFVPROC, ClearBufferfv)                                   \
    X(PFNGLCLEARCOLORPROC, ClearColor)                                         \
    X(PFNGLCLEARDEPTHPROC, ClearDepth)                                         \
    X(PFNGLCOLORMASKPROC, ColorMask)                                           \
    X(PFNGLCOMPILESHADERPROC, CompileShader)                                   \
    X(PFNGLCREATEPROGRAMPROC, CreateProgram)                                   \
    X(PFNGLCREATESHADERPROC, CreateShader)                                     \
    X(PFNGLCULLFACEPROC, CullFace)                                             \
    X(PFNGLDELETEBUFFERSPROC, DeleteBuffers)                                   \
    X(PFNGLDELETEFRAMEBUFFERSPROC, DeleteFramebuffers)                         \
    X(PFNGLDELETEPROGRAMPROC, DeleteProgram)                                   \
    X(PFNGLDELETEQUERIESPROC, DeleteQueries)                                   \
    X(PFNGLDELETERENDERBUFFERSPROC, DeleteRenderbuffers)                       \
    X(PFNGLDELETESHADERPROC, DeleteShader)                                     \
    X(PFNGLDELETETEXTURESPROC, DeleteTextures)                                 \
    X(PFNGLDELETEVERTEXARRAYSPROC, DeleteVertexArrays)                         \
    X(PFNGLDEPTHFUNCPROC, DepthFunc)                                           \
    X(PFNGLDEPTHMASKPROC, DepthMask)                                           \
    X(PFNGLDISABLEPROC, Disable)                                               \
    X(PFNGLDRAWARRAYSPROC, DrawArrays)                                         \
    X(PFNGLDRAWARRAYSINSTANCEDPROC, DrawArraysInstanced)                       \
    X(PFNGLDRAWBUFFERPROC, DrawBuffer)                                         \
    X(PFNGLDRAWBUFFERSPROC, DrawBuffers)                                       \
    X(PFNGLDRAWELEMENTSPROC, DrawElements)                                     \
    X(PFNGLENABLEPROC, Enable)                                                 \
    X(PFNGLENABLEVERTEXATTRIBARRAYPROC, EnableVertexAttribArray)               \
    X(PFNGLENDQUERYPROC, EndQuery)                                             \
    X(PFNGLFINISHPROC, Finish)                                                 \
    X(PFNGLFRAMEBUFFERRENDERBUFFERPROC, FramebufferRenderbuffer)               \
    X(PFNGLFRAMEBUFFERTEXTURE2DPROC, FramebufferTexture2D)                     \
    X(PFNGLGENBUFFERSPROC, GenBuffers)                                         \
    X(PFNGLGENFRAMEBUFFERSPROC, GenFramebuffers)                               \
    X(PFNGLGENQUERIESPROC, GenQueries)                                         \
    X(PFNGLGENRENDERBUFFERSPROC, GenRenderbuffers)                             \
    X(PFNGLGENTEXTURESPROC, GenTextures)                                       \
    X(PFNGLGENVERTEXARRAYSPROC, GenVertexArrays)                               \
    X(PFNGLGETERRORPROC, GetError)                                             \
    X(PFNGLGETINTEGERVPROC, GetIntegerv)                                       \
    X(PFNGLGETPROGRAMINFOLOGPROC, GetProgramInfoLog)                           \
    X(PFNGLGETPROGRAMIVPROC, GetProgramiv)                                     \
    X(PFNGLGETQUERYOBJECTUIVPROC, GetQueryObjectuiv)                           \
    X(PFNGLGETSHADERINFOLOGPROC, GetShaderInfoLog)                             \
    X(PFNGLGETSHADERIVPROC, GetShaderiv)                                       \
    X(PFNGLGETSTRINGPROC, GetString)                                           \
    X(PFNGLGETUNIFORMLOCATIONPROC, GetUniformLocation)                         \
    X(PFNGLLINKPROGRAMPROC, LinkProgram)                                       \
    X(PFNGLPIXELSTOREIPROC, PixelStorei)                                       \
    X(PFNGLREADBUFFERPROC, ReadBuffer)                                         \
    X(PFNGLREADPIXELSPROC, ReadPixels)                                         \
    X(PFNGLRENDERBUFFERSTORAGEMULTISAMPLEPROC, RenderbufferStorageMultisample) \
    X(PFNGLSCISSORPROC, Scissor)                                               \
    X(PFNGLSHADERSOURCEPROC, ShaderSource)                                     \
    X(PFNGLSTENCILFUNCPROC, StencilFunc)                                       \
    X(PFNGLSTENCILMASKPROC, StencilMask)                                       \
    X(PFNGLSTENCILOPPROC, StencilOp)                                           \
    X(PFNGLSTENCILOPSEPARATEPROC, StencilOpSeparate)                           \
    X(PFNGLTEXIMAGE2DPROC, TexImage2D)                                         \
    X(PFNGLTEXIMAGE2DMULTISAMPLEPROC, TexImage2DMultisample)                   \
    X(PFNGLTEXIMAGE3DPROC, TexImage3D)                                         \
    X(PFNGLTEXPARAMETERIPROC, TexParameteri)                                   \
    X(PFNGLTEXSUBIMAGE3DPROC, TexSubImage3D)                                   \
    X(PFNGLUNIFORM1FPROC, Uniform1f)                                           \
    X(PFNGLUNIFORM1IPROC, Uniform1i)                                           \
    X(PFNGLUNIFORM2FPROC, Uniform2f)                                           \
    X(PFNGLUNIFORM3FPROC, Uniform3f)                                           \
    X(PFNGLUNIFORM4FPROC, Uniform4f)                                           \
    X(PFNGLUNIFORMMATRIX3FVPROC, UniformMatrix3fv)                             \
    X(PFNGLUNIFORMMATRIX4FVPROC, UniformMatrix4fv)                             \
    X(PFNGLUSEPROGRAMPROC, UseProgram)                                         \
    X(PFNGLVERTEXATTRIBDIVISORPROC, VertexAttribDivisor)                       \
    X(PFNGLVERTEXATTRIBPOINTERPROC, VertexAttribPointer)                       \
    X(PFNGLVIEWPORTPROC, Viewport)

namespace bonemill {

// It says that the driver refused something: a missing function, a shader, a framebuffer, a call.
class GlError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

struct GlApi {
#define BONEMILL_GL_MEMBER(type, name) type name = nullptr;
    BONEMILL_GL_FUNCTIONS(BONEMILL_GL_MEMBER)
#undef BONEMILL_GL_MEMBER

    // Takes each function from address_of, such as address_of("glClear"), for the current context. Throws
    // GlError that names the first missing one.
    static GlApi load(const std::function<void*(const char*)>& address_of);

    // Returns true when the processor draws, and not a graphics card.
    bool isSoftware() const;

    // Names renderer and version of the current context, for people.
    std::string describe() const;

    // The texture that is bound to this target is read so between its texels, and beyond its edges.
    void setSampling(GLenum target, GLint filter, GLint wrap = GL_CLAMP_TO_EDGE) const;
    // Binds the texture to this unit; unit 0 is active afterwards.
    void bindTexture(GLenum unit, GLenum target, GLuint texture) const;
    // An attribute of vertices of `stride` bytes in the bound buffer is so many floats at this offset.
    void setFloats(GLuint attribute, GLint floats, size_t stride, size_t offset) const;

    // Throws GlError with the code and `where` when an earlier call failed.
    void check(const char* where) const;
};

// These own OpenGL names. A name is deleted with its object, which therefore must die before its context and
// on its thread.
using GenFunction = void(APIENTRY*)(GLsizei, GLuint*);
using DeleteFunction = void(APIENTRY*)(GLsizei, const GLuint*);

// The GlApi must outlive the object.
template <GenFunction GlApi::*Gen, DeleteFunction GlApi::*Delete>
class GlObject {
  public:
    explicit GlObject(const GlApi& gl) : gl_(&gl) { (gl.*Gen)(1, &name_); }
    GlObject(GlObject&& other) noexcept : gl_(other.gl_), name_(std::exchange(other.name_, 0)) {}
    GlObject& operator=(GlObject&& other) noexcept {
        std::swap(gl_, other.gl_);
        std::swap(name_, other.name_);
        return *this;
    }
    GlObject(const GlObject&) = delete;
    GlObject& operator=(const GlObject&) = delete;
    ~GlObject() {
        if (name_) (gl_->*Delete)(1, &name_);
    }
    GLuint name() const noexcept { return name_; }

  private:
    const GlApi* gl_;
    GLuint name_ = 0;
};

using GlBuffer = GlObject<&GlApi::GenBuffers, &GlApi::DeleteBuffers>;
using GlVertexArray = GlObject<&GlApi::GenVertexArrays, &GlApi::DeleteVertexArrays>;
using GlTexture = GlObject<&GlApi::GenTextures, &GlApi::DeleteTextures>;
using GlFramebuffer = GlObject<&GlApi::GenFramebuffers, &GlApi::DeleteFramebuffers>;
using GlQuery = GlObject<&GlApi::GenQueries, &GlApi::DeleteQueries>;
using GlRenderbuffer = GlObject<&GlApi::GenRenderbuffers, &GlApi::DeleteRenderbuffers>;

// It is a vertex and a fragment shader, linked. The rules of GlObject for thread and lifetime hold here too.
class Program {
  public:
    // Sources are GLSL 3.30 without the #version line. Throws GlError with `name`, the stage and the
    // compiler's log.
    Program(const GlApi& gl, const std::string& name, const std::string& vertex_source,
            const std::string& fragment_source);
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    ~Program();

    void use() const { gl_.UseProgram(program_); }

    // Returns the location for the setters below; it is -1, which OpenGL ignores, when the
    // linker dropped the uniform.
    GLint uniform(const char* uniform_name) const { return gl_.GetUniformLocation(program_, uniform_name); }

    // The program must be in use.
    void set(GLint location, int value) const { gl_.Uniform1i(location, value); }
    void set(GLint location, float value) const { gl_.Uniform1f(location, value); }
    void set(GLint location, const Eigen::Vector2f& v) const { gl_.Uniform2f(location, v.x(), v.y()); }
    void set(GLint location, const Eigen::Vector3f& v) const { gl_.Uniform3f(location, v.x(), v.y(), v.z()); }
    void set(GLint location, const Eigen::Vector4f& v) const {
        gl_.Uniform4f(location, v.x(), v.y(), v.z(), v.w());
    }
    void set(GLint location, const Eigen::Matrix3f& m) const {
        gl_.UniformMatrix3fv(location, 1, GL_FALSE, m.data());
    }
    void set(GLint location, const Eigen::Matrix4f& m) const {
        gl_.UniformMatrix4fv(location, 1, GL_FALSE, m.data());
    }
    template <class T>
    void set(const char* uniform_name, const T& value) const {
        set(uniform(uniform_name), value);
    }

  private:
    const GlApi& gl_;
    GLuint program_ = 0;
};

}  // namespace bonemill
