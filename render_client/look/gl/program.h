// It is a vertex and a fragment shader, linked. The rules of gl_object.h for thread and lifetime
// hold here too.
#pragma once

#include <Eigen/Core>
#include <string>

#include "render_client/look/gl/gl_api.h"

namespace bonemill {

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
