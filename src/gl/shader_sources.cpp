#include "gl/shader_sources.h"

#include "base/error.h"

namespace lightband::gl {
namespace {

const char* find(std::string_view file) {
    for (unsigned i = 0; i < embedded_shader_count; ++i)
        if (file == embedded_shaders[i].file) return embedded_shaders[i].text;
    throw Error(LB_ERROR_INTERNAL, text("there is no shader ", file));
}

void append(std::string_view file, std::string* out) {
    constexpr std::string_view directive = "#include \"";
    for (std::string_view line : split(find(file), '\n')) {
        if (line.substr(0, directive.size()) == directive) {
            line.remove_prefix(directive.size());
            append(line.substr(0, line.find('"')), out);
        } else {
            out->append(line).push_back('\n');
        }
    }
}

}  // namespace

std::string shader_source(const std::string& file, const std::string& definitions) {
    std::string source = "#version 450 core\n";
    for (const std::string_view line : split(definitions, '\n'))
        if (!line.empty()) source.append("#define ").append(line).push_back('\n');
    append(file, &source);
    return source;
}

}  // namespace lightband::gl
