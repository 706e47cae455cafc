# Writes OUTPUT, a C++ source with the text of every file in SHADERS (a list), for src/gl/shader_sources.h.
#   cmake -DOUTPUT=... -DSHADERS="a;b" -P EmbedShaders.cmake
set(source "// Written by cmake/EmbedShaders.cmake.\n#include \"gl/shader_sources.h\"\n\nnamespace lightband::gl {\n\n")
string(APPEND source "const EmbeddedShader embedded_shaders[] = {\n")
set(count 0)
foreach(shader IN LISTS SHADERS)
  get_filename_component(file ${shader} NAME)
  file(READ ${shader} text)
  string(APPEND source "    {\"${file}\", R\"glsl(${text})glsl\"},\n")
  math(EXPR count "${count} + 1")
endforeach()
string(APPEND source "};\nconst unsigned embedded_shader_count = ${count};\n\n}  // namespace lightband::gl\n")
file(WRITE ${OUTPUT} "${source}")
