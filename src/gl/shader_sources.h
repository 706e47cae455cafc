// The files of shaders/, embedded at build time.
#pragma once

#include <string>

namespace lightband::gl {

// Text of shaders/<file> with its includes in place and "#define <line>" for each line of definitions, ready to
// compile. A line of names of shaders, "LIST a.glsl b.glsl", stands for what "#include LIST" includes; without one,
// that is nothing.
std::string shader_source(const std::string& file, const std::string& definitions);

// One embedded file; the build writes the table (cmake/EmbedShaders.cmake).
struct EmbeddedShader {
    const char* file;
    const char* text;
};
extern const EmbeddedShader embedded_shaders[];
extern const unsigned embedded_shader_count;

}  // namespace lightband::gl
