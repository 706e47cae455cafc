#include "gl/shader_sources.h"

#include <sstream>

#include "base/error.h"

namespace lightband::gl {
namespace {

const char* find(const std::string& file) {
    for (unsigned i = 0; i < embedded_shader_count; ++i)
        if (file == embedded_shaders[i].file) return embedded_shaders[i].text;
    throw Error(LB_ERROR_INTERNAL, text("there is no shader ", file));
}

void append(const std::string& file, std::string* out) {
    std::istringstream lines(find(file));
    for (std::string line; std::getline(lines, line);) {
        const std::string directive = "#include \"";
        if (line.compare(0, directive.size(), directive) == 0)
            append(line.substr(directive.size(), line.find('"', directive.size()) - directive.size()), out);
        else
            *out += line + '\n';
    }
}

}  // namespace

std::string shader_source(const std::string& file, const std::string& definitions) {
    std::string source = "#version 450 core\n";
    std::istringstream lines(definitions);
    for (std::string line; std::getline(lines, line);) source += "#define " + line + '\n';
    append(file, &source);
    return source;
}

}  // namespace lightband::gl
