// These are the OpenGL 3.3 core functions that this program uses, loaded from whichever context is current.
//
// A GlApi belongs to the thread whose context was current when it was loaded. It is not RT-safe.
#pragma once

#include <GL/glcorearb.h>

#include <functional>
#include <stdexcept>
#include <string>

#define BONEMILL_GL_FUNCTIONS(X)                                               \
    X(PFNGLACTIVETEXTUREPROC, ActiveTexture)                                   \
    X(PFNGLATTACHSHADERPROC, AttachShader)                                     \
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
    X(PFNGLDRAWELEMENTSPROC, DrawElements)                                     \
    X(PFNGLENABLEPROC, Enable)                                                 \
    X(PFNGLENABLEVERTEXATTRIBARRAYPROC, EnableVertexAttribArray)               \
    X(PFNGLFINISHPROC, Finish)                                                 \
    X(PFNGLFRAMEBUFFERRENDERBUFFERPROC, FramebufferRenderbuffer)               \
    X(PFNGLFRAMEBUFFERTEXTURE2DPROC, FramebufferTexture2D)                     \
    X(PFNGLGENBUFFERSPROC, GenBuffers)                                         \
    X(PFNGLGENFRAMEBUFFERSPROC, GenFramebuffers)                               \
    X(PFNGLGENRENDERBUFFERSPROC, GenRenderbuffers)                             \
    X(PFNGLGENTEXTURESPROC, GenTextures)                                       \
    X(PFNGLGENVERTEXARRAYSPROC, GenVertexArrays)                               \
    X(PFNGLGETERRORPROC, GetError)                                             \
    X(PFNGLGETINTEGERVPROC, GetIntegerv)                                       \
    X(PFNGLGETPROGRAMINFOLOGPROC, GetProgramInfoLog)                           \
    X(PFNGLGETPROGRAMIVPROC, GetProgramiv)                                     \
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

    // Throws GlError with the code and `where` when an earlier call failed.
    void check(const char* where) const;
};

}  // namespace bonemill
