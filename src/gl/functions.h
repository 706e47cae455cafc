// OpenGL 4.5 entry points, loaded at run time into a table per context; the types come from the Khronos headers.
#pragma once

#include <GL/glcorearb.h>

#define LIGHTBAND_GL_FUNCTIONS(X)                          \
    X(PFNGLATTACHSHADERPROC, AttachShader)                 \
    X(PFNGLBINDBUFFERBASEPROC, BindBufferBase)             \
    X(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer)           \
    X(PFNGLBINDIMAGETEXTUREPROC, BindImageTexture)         \
    X(PFNGLBINDTEXTUREUNITPROC, BindTextureUnit)           \
    X(PFNGLBINDVERTEXARRAYPROC, BindVertexArray)           \
    X(PFNGLCHECKNAMEDFRAMEBUFFERSTATUSPROC, CheckNamedFramebufferStatus) \
    X(PFNGLCLEARNAMEDBUFFERDATAPROC, ClearNamedBufferData) \
    X(PFNGLCLEARNAMEDFRAMEBUFFERFVPROC, ClearNamedFramebufferfv) \
    X(PFNGLCLEARTEXIMAGEPROC, ClearTexImage)               \
    X(PFNGLCOPYIMAGESUBDATAPROC, CopyImageSubData)         \
    X(PFNGLCLIPCONTROLPROC, ClipControl)                   \
    X(PFNGLCOMPILESHADERPROC, CompileShader)               \
    X(PFNGLCREATEBUFFERSPROC, CreateBuffers)               \
    X(PFNGLCREATEFRAMEBUFFERSPROC, CreateFramebuffers)     \
    X(PFNGLCREATEPROGRAMPROC, CreateProgram)               \
    X(PFNGLCREATESHADERPROC, CreateShader)                 \
    X(PFNGLCREATETEXTURESPROC, CreateTextures)             \
    X(PFNGLCREATEVERTEXARRAYSPROC, CreateVertexArrays)     \
    X(PFNGLDEBUGMESSAGECALLBACKPROC, DebugMessageCallback) \
    X(PFNGLDELETEBUFFERSPROC, DeleteBuffers)               \
    X(PFNGLDELETEFRAMEBUFFERSPROC, DeleteFramebuffers)     \
    X(PFNGLDELETEPROGRAMPROC, DeleteProgram)               \
    X(PFNGLDELETESHADERPROC, DeleteShader)                 \
    X(PFNGLDELETETEXTURESPROC, DeleteTextures)             \
    X(PFNGLDELETEVERTEXARRAYSPROC, DeleteVertexArrays)     \
    X(PFNGLDEPTHFUNCPROC, DepthFunc)                       \
    X(PFNGLDISABLEPROC, Disable)                           \
    X(PFNGLDISPATCHCOMPUTEPROC, DispatchCompute)           \
    X(PFNGLDRAWELEMENTSPROC, DrawElements)                 \
    X(PFNGLENABLEPROC, Enable)                             \
    X(PFNGLENABLEVERTEXARRAYATTRIBPROC, EnableVertexArrayAttrib) \
    X(PFNGLFRONTFACEPROC, FrontFace)                       \
    X(PFNGLFINISHPROC, Finish)                             \
    X(PFNGLFLUSHPROC, Flush)                               \
    X(PFNGLGETERRORPROC, GetError)                         \
    X(PFNGLGETINTEGERVPROC, GetIntegerv)                   \
    X(PFNGLGETNAMEDBUFFERSUBDATAPROC, GetNamedBufferSubData) \
    X(PFNGLGETPROGRAMINFOLOGPROC, GetProgramInfoLog)       \
    X(PFNGLGETPROGRAMIVPROC, GetProgramiv)                 \
    X(PFNGLGETSHADERINFOLOGPROC, GetShaderInfoLog)         \
    X(PFNGLGETSHADERIVPROC, GetShaderiv)                   \
    X(PFNGLGETSTRINGPROC, GetString)                       \
    X(PFNGLGETTEXTUREIMAGEPROC, GetTextureImage)           \
    X(PFNGLGETUNIFORMLOCATIONPROC, GetUniformLocation)     \
    X(PFNGLLINKPROGRAMPROC, LinkProgram)                   \
    X(PFNGLMEMORYBARRIERPROC, MemoryBarrier)               \
    X(PFNGLNAMEDBUFFERSTORAGEPROC, NamedBufferStorage)     \
    X(PFNGLNAMEDBUFFERSUBDATAPROC, NamedBufferSubData)     \
    X(PFNGLNAMEDFRAMEBUFFERDRAWBUFFERSPROC, NamedFramebufferDrawBuffers) \
    X(PFNGLNAMEDFRAMEBUFFERTEXTUREPROC, NamedFramebufferTexture) \
    X(PFNGLPIXELSTOREIPROC, PixelStorei)                   \
    X(PFNGLPROGRAMUNIFORM1FPROC, ProgramUniform1f)         \
    X(PFNGLPROGRAMUNIFORM1IPROC, ProgramUniform1i)         \
    X(PFNGLPROGRAMUNIFORM1UIPROC, ProgramUniform1ui)       \
    X(PFNGLPROGRAMUNIFORM1UIVPROC, ProgramUniform1uiv)     \
    X(PFNGLPROGRAMUNIFORM2IPROC, ProgramUniform2i)         \
    X(PFNGLPROGRAMUNIFORM3FPROC, ProgramUniform3f)         \
    X(PFNGLPROGRAMUNIFORM4FPROC, ProgramUniform4f)         \
    X(PFNGLPROGRAMUNIFORMMATRIX3FVPROC, ProgramUniformMatrix3fv) \
    X(PFNGLPROGRAMUNIFORMMATRIX4FVPROC, ProgramUniformMatrix4fv) \
    X(PFNGLSHADERSOURCEPROC, ShaderSource)                 \
    X(PFNGLTEXTUREBUFFERPROC, TextureBuffer)               \
    X(PFNGLTEXTUREPARAMETERIPROC, TextureParameteri)       \
    X(PFNGLTEXTURESTORAGE2DPROC, TextureStorage2D)         \
    X(PFNGLTEXTURESTORAGE3DPROC, TextureStorage3D)         \
    X(PFNGLTEXTURESUBIMAGE2DPROC, TextureSubImage2D)       \
    X(PFNGLUSEPROGRAMPROC, UseProgram)                     \
    X(PFNGLVERTEXARRAYATTRIBBINDINGPROC, VertexArrayAttribBinding) \
    X(PFNGLVERTEXARRAYATTRIBFORMATPROC, VertexArrayAttribFormat) \
    X(PFNGLVERTEXARRAYELEMENTBUFFERPROC, VertexArrayElementBuffer) \
    X(PFNGLVERTEXARRAYVERTEXBUFFERPROC, VertexArrayVertexBuffer) \
    X(PFNGLVIEWPORTPROC, Viewport)

namespace lightband::gl {

struct Functions {
#define LIGHTBAND_GL_MEMBER(type, name) type name = nullptr;
    LIGHTBAND_GL_FUNCTIONS(LIGHTBAND_GL_MEMBER)
#undef LIGHTBAND_GL_MEMBER
};

}  // namespace lightband::gl
