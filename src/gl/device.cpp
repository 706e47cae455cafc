#include "gl/device.h"

#include <vector>

#include "base/error.h"
#include "base/host_thread.h"
#include "base/process.h"
#include "gl/objects.h"
#include "gl/shader_sources.h"

namespace lightband::gl {
namespace {

void APIENTRY on_debug_message(GLenum, GLenum type, GLuint, GLenum, GLsizei, const GLchar* message, const void* user) {
    if (type != GL_DEBUG_TYPE_ERROR && type != GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR) return;
    try {
        static_cast<const Device*>(user)->log(message);
    } catch (...) {  // the driver's code stands between: a call that its callback gave up ends at the next checkpoint
    }
}

std::string info_log(const Functions& gl, GLuint object, bool program) {
    GLint length = 0;
    (program ? gl.GetProgramiv(object, GL_INFO_LOG_LENGTH, &length)
             : gl.GetShaderiv(object, GL_INFO_LOG_LENGTH, &length));
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
    if (!linked)
        throw Error(LB_ERROR_DEVICE, text("program ", name, " does not link: ", info_log(gl, program->name(), true)));
    return program;
}

}  // namespace

Device::Device(uint32_t device, lb_log_callback callback, void* user) : log_(callback), log_user_(user) {
    run([&] {
        contents_.context = EglContext::create(device);
        warm_up();
        ContextThread::rest_at_exit();
        gl().GetIntegerv(GL_MAX_TEXTURE_SIZE, &max_texture_size_);
        gl().GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &max_texture_buffer_texels_);
        if (callback == nullptr) return;
        gl().Enable(GL_DEBUG_OUTPUT);
        gl().Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        gl().DebugMessageCallback(on_debug_message, this);
    });
}

// Compilers have static objects that they make when they first compile and destroy by exit handlers: made before the
// library's own handler is registered, they are destroyed after it has brought contexts to rest. A triangle is drawn
// rather than a program dispatched: llvmpipe may find programs in its cache on disk, but compiles in every process how
// triangles are set up.
void Device::warm_up() {
    const Texture image = Texture::image(gl(), GL_RGBA16F, 1, 1);
    const Framebuffer framebuffer(gl());
    gl().NamedFramebufferTexture(framebuffer.name(), GL_COLOR_ATTACHMENT0, image.name(), 0);
    gl().BindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    const uint32_t corners[] = {0, 1, 2};
    const Buffer indices(gl(), sizeof corners, corners);
    const VertexArray vertices(gl());
    gl().VertexArrayElementBuffer(vertices.name(), indices.name());
    gl().BindVertexArray(vertices.name());
    graphics("warm_up").use();
    gl().DrawElements(GL_TRIANGLES, 3, GL_UNSIGNED_INT, nullptr);
    gl().Finish();
    contents_.programs.clear();
}

Device::~Device() = default;

Device::Contents::Contents(ContextThread& its_thread) : thread(its_thread) {}

Device::Contents::~Contents() {
    try {
        thread.run(
            [&] {
                programs.clear();
                context.reset();
            },
            ContextThread::Callbacks::refused);
    } catch (...) {  // of a fork, or of a process that ends: both are left as they are
        (void)context.release();
    }
}

void Device::log(const std::string& message) const {
    if (log_ == nullptr) return;
    auto call = [&] { log_(log_user_, message.c_str()); };
    if (thread_.is_current()) return thread_.call_back(call);
    const HostThread::Callback running;
    call();
}

// Every pass asks for its program first: there a call is left off when the process ends.
const Program& Device::compute(const std::string& name, const std::string& definitions) {
    checkpoint();
    const std::string key = name + '\n' + definitions;
    const auto known = contents_.programs.find(key);
    if (known != contents_.programs.end()) return *known->second;
    ContextThread::rest_at_exit();  // after what the compiler has registered for the programs before
    return *contents_.programs.emplace(key, link(gl(), name, definitions, {{GL_COMPUTE_SHADER, name + ".glsl"}}))
                .first->second;
}

const Program& Device::graphics(const std::string& name) {
    checkpoint();
    const auto known = contents_.programs.find(name);
    if (known != contents_.programs.end()) return *known->second;
    ContextThread::rest_at_exit();
    auto made = link(gl(), name, "", {{GL_VERTEX_SHADER, name + ".vert"}, {GL_FRAGMENT_SHADER, name + ".frag"}});
    return *contents_.programs.emplace(name, std::move(made)).first->second;
}

void Device::check(const char* where) const {
    const GLenum error = gl().GetError();
    if (error == GL_NO_ERROR) return;
    if (error == GL_OUT_OF_MEMORY) throw Error(LB_ERROR_LIMIT, text(where, ": the device is out of memory"));
    throw Error(LB_ERROR_DEVICE, text(where, ": OpenGL error ", error));
}

// Errors are recorded until they are asked for: those of a call that fails are taken now, or the next call would fail
// for them.
void Device::rethrow_without_errors() const {
    // A process that ends goes on to the driver's exit handlers: what earlier passes have left to it must be done.
    if (process_ends() && contents_.context != nullptr) gl().Finish();
    constexpr int most_errors = 64;  // more than there are kinds of them; a context that was lost gives one for ever
    bool out_of_memory = false;
    GLenum error = contents_.context != nullptr ? gl().GetError() : GL_NO_ERROR;
    for (int i = 0; i < most_errors && error != GL_NO_ERROR; ++i, error = gl().GetError())
        out_of_memory = out_of_memory || error == GL_OUT_OF_MEMORY;
    try {
        throw;
    } catch (const Error& failure) {
        // What fails after memory ran out, as an incomplete framebuffer does, is its consequence.
        if (out_of_memory && failure.code() == LB_ERROR_DEVICE)
            throw Error(LB_ERROR_LIMIT, text("the device is out of memory (", failure.what(), ")"));
        throw;
    }
}

}  // namespace lightband::gl
