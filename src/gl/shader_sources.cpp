#include "gl/shader_sources.h"

#include <vector>

#include "base/error.h"

namespace lightband::gl {
namespace {

const char* find(std::string_view file) {
    for (unsigned i = 0; i < embedded_shader_count; ++i)
        if (file == embedded_shaders[i].file) return embedded_shaders[i].text;
    throw Error(LB_ERROR_INTERNAL, text("there is no shader ", file));
}

// lists: the definitions, of which a line "LIST a.glsl b.glsl" names the files of "#include LIST".
void append(std::string_view file, const std::string& lists, std::string* out) {
    constexpr std::string_view directive = "#include ";
    for (std::string_view line : split(find(file), '\n')) {
        if (line.substr(0, directive.size()) == directive) {
            line.remove_prefix(directive.size());
            if (line.front() == '"') {
                append(line.substr(1, line.find('"', 1) - 1), lists, out);
                continue;
            }
            for (const std::string_view definition : split(lists, '\n')) {
                if (definition.substr(0, definition.find(' ')) != line) continue;
                const std::vector<std::string_view> words = split(definition, ' ');
                for (size_t i = 1; i < words.size(); ++i) append(words[i], lists, out);
            }
        } else {
            out->append(line).push_back('\n');
        }
    }
}

}  // namespace

std::string shader_source(const std::string& file, const std::string& definitions) {
    std::string source = "#version 450 core\n";
    for (const std::string_view line : split(definitions, '\n'))
        if (!line.empty() && line.find(".glsl") == line.npos) source.append("#define ").append(line).push_back('\n');
    append(file, definitions, &source);
    return source;
}

}  // namespace lightband::gl
