#include "gl/device.h"

#include <vector>

#include "base/error.h"
#include "gl/objects.h"
#include "gl/shader_sources.h"

namespace lightband::gl {
namespace {

void APIENTRY on_debug_message(GLenum, GLenum type, GLuint, GLenum, GLsizei, const GLchar* message, const void* user) {
    if (type == GL_DEBUG_TYPE_ERROR || type == GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR)
        static_cast<const Device*>(user)->log(message);
}

std::string info_log(const Functions& gl, GLuint object, bool program) {
    GLint length = 0;
    (program ? gl.GetProgramiv(object, GL_INFO_LOG_LENGTH, &length) : gl.GetShaderiv(object, GL_INFO_LOG_LENGTH, &length));
    std::vector<GLchar> characters(size_t(length) + 1);
    if (program)
        gl.GetProgramInfoLog(object, length, nullptr, characters.data());
    else
        gl.GetShaderInfoLog(object, length, nullptr, characters.data());
    return characters.data();
}

// One stage of a program while it is linked.
class Shader : public Object {
public:
    Shader(const Functions& gl, GLenum stage) : Object(gl, gl.CreateShader(stage)) {}
    ~Shader() { gl_->DeleteShader(name_); }
};

std::unique_ptr<Program> link(const Functions& gl, const std::string& name, const std::string& definitions,
                              const std::vector<std::pair<GLenum, std::string>>& stages) {
    auto program = std::make_unique<Program>(gl);
    for (const auto& [stage, file] : stages) {
        const std::string source = shader_source(file, definitions);
        const GLchar* characters = source.c_str();
        const Shader shader(gl, stage);
        gl.ShaderSource(shader.name(), 1, &characters, nullptr);
        gl.CompileShader(shader.name());
        GLint compiled = GL_FALSE;
        gl.GetShaderiv(shader.name(), GL_COMPILE_STATUS, &compiled);
        if (!compiled)
            throw Error(LB_ERROR_DEVICE,
                        text("shader ", file, " does not compile: ", info_log(gl, shader.name(), false)));
        gl.AttachShader(program->name(), shader.name());
    }
    gl.LinkProgram(program->name());
    GLint linked = GL_FALSE;
    gl.GetProgramiv(program->name(), GL_LINK_STATUS, &linked);
    if (!linked) throw Error(LB_ERROR_DEVICE, text("program ", name, " does not link: ", info_log(gl, program->name(), true)));
    return program;
}

}  // namespace

Device::Device(uint32_t device, lb_log_callback callback, void* user)
    : context_(EglContext::create(device)), log_(callback), log_user_(user) {
    const EglContext::Current current(*context_);
    gl().GetIntegerv(GL_MAX_TEXTURE_SIZE, &max_texture_size_);
    gl().GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &max_texture_buffer_texels_);
    if (callback != nullptr) {
        gl().Enable(GL_DEBUG_OUTPUT);
        gl().Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        gl().DebugMessageCallback(on_debug_message, this);
    }
    log(text("rendering on ", name()));
}

Device::~Device() {
    const EglContext::Current current(*context_);
    programs_.clear();
}

void Device::log(const std::string& message) const {
    if (log_ != nullptr) log_(log_user_, message.c_str());
}

const Program& Device::compute(const std::string& name, const std::string& definitions) {
    const std::string key = name + '\n' + definitions;
    const auto known = programs_.find(key);
    if (known != programs_.end()) return *known->second;
    return *programs_.emplace(key, link(gl(), name, definitions, {{GL_COMPUTE_SHADER, name + ".glsl"}})).first->second;
}

const Program& Device::graphics(const std::string& name) {
    const auto known = programs_.find(name);
    if (known != programs_.end()) return *known->second;
    auto made = link(gl(), name, "", {{GL_VERTEX_SHADER, name + ".vert"}, {GL_FRAGMENT_SHADER, name + ".frag"}});
    return *programs_.emplace(name, std::move(made)).first->second;
}

void Device::check(const char* where) const {
    const GLenum error = gl().GetError();
    if (error == GL_NO_ERROR) return;
    if (error == GL_OUT_OF_MEMORY) throw Error(LB_ERROR_LIMIT, text(where, ": the device is out of memory"));
    throw Error(LB_ERROR_DEVICE, text(where, ": OpenGL error ", error));
}

Device::Guard::Guard(std::shared_ptr<Device> device)
    : device_(std::move(device)), lock_(device_->mutex_), current_(*device_->context_) {}

}  // namespace lightband::gl
