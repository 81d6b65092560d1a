/* OpenGL contexts of two kinds behind one interface, in one binary: a window (GLFW) or memory (OSMesa).
 * And OpenGL's functions themselves: `gl.Clear` is the current context's glClear. Nothing calls a gl function
 * by its linked name, for that would silently be OSMesa's even in a window. */
#ifndef TEXEL_CONTEXT_H
#define TEXEL_CONTEXT_H

#include <GL/glcorearb.h>
#include <stdbool.h>

/* The functions of OpenGL 3.3 core that the library uses: as in the type PFNGL...PROC, and as in gl... */
/* clang-format off */
#define GL_FUNCTIONS(X) \
    X(ACTIVETEXTURE, ActiveTexture) X(ATTACHSHADER, AttachShader) X(BINDBUFFER, BindBuffer) \
    X(BINDFRAMEBUFFER, BindFramebuffer) X(BINDRENDERBUFFER, BindRenderbuffer) X(BINDTEXTURE, BindTexture) \
    X(BINDVERTEXARRAY, BindVertexArray) X(BLENDFUNC, BlendFunc) X(BLITFRAMEBUFFER, BlitFramebuffer) \
    X(BUFFERDATA, BufferData) X(CHECKFRAMEBUFFERSTATUS, CheckFramebufferStatus) X(CLEAR, Clear) \
    X(CLEARBUFFERFV, ClearBufferfv) X(CLEARCOLOR, ClearColor) X(COMPILESHADER, CompileShader) \
    X(COMPRESSEDTEXIMAGE2D, CompressedTexImage2D) \
    X(CREATEPROGRAM, CreateProgram) X(CREATESHADER, CreateShader) X(DELETEBUFFERS, DeleteBuffers) \
    X(DELETEFRAMEBUFFERS, DeleteFramebuffers) X(DELETEPROGRAM, DeleteProgram) \
    X(DELETERENDERBUFFERS, DeleteRenderbuffers) X(DELETESHADER, DeleteShader) \
    X(DELETETEXTURES, DeleteTextures) X(DELETEVERTEXARRAYS, DeleteVertexArrays) X(DISABLE, Disable) \
    X(DRAWARRAYS, DrawArrays) X(DRAWBUFFERS, DrawBuffers) X(DRAWELEMENTS, DrawElements) X(ENABLE, Enable) \
    X(ENABLEVERTEXATTRIBARRAY, EnableVertexAttribArray) X(FINISH, Finish) \
    X(FRAMEBUFFERRENDERBUFFER, FramebufferRenderbuffer) X(FRAMEBUFFERTEXTURE2D, FramebufferTexture2D) \
    X(GENBUFFERS, GenBuffers) X(GENERATEMIPMAP, GenerateMipmap) X(GENFRAMEBUFFERS, GenFramebuffers) \
    X(GENRENDERBUFFERS, GenRenderbuffers) X(GENTEXTURES, GenTextures) X(GENVERTEXARRAYS, GenVertexArrays) \
    X(GETERROR, GetError) X(GETINTEGERV, GetIntegerv) X(GETPROGRAMINFOLOG, GetProgramInfoLog) \
    X(GETPROGRAMIV, GetProgramiv) X(GETSHADERINFOLOG, GetShaderInfoLog) X(GETSHADERIV, GetShaderiv) \
    X(GETSTRING, GetString) X(GETTEXIMAGE, GetTexImage) X(GETUNIFORMLOCATION, GetUniformLocation) \
    X(LINKPROGRAM, LinkProgram) X(PIXELSTOREI, PixelStorei) X(READBUFFER, ReadBuffer) \
    X(READPIXELS, ReadPixels) X(RENDERBUFFERSTORAGE, RenderbufferStorage) X(SCISSOR, Scissor) \
    X(SHADERSOURCE, ShaderSource) X(TEXIMAGE2D, TexImage2D) X(TEXPARAMETERI, TexParameteri) \
    X(TEXSUBIMAGE2D, TexSubImage2D) \
    X(UNIFORM1F, Uniform1f) X(UNIFORM1I, Uniform1i) X(UNIFORM4F, Uniform4f) \
    X(UNIFORMMATRIX3FV, UniformMatrix3fv) X(UNIFORMMATRIX4FV, UniformMatrix4fv) X(USEPROGRAM, UseProgram) \
    X(VERTEXATTRIBPOINTER, VertexAttribPointer) X(VIEWPORT, Viewport)
/* clang-format on */

#define GL_MEMBER(upper, member) PFNGL##upper##PROC member;
typedef struct {
    GL_FUNCTIONS(GL_MEMBER)
} GL;
#undef GL_MEMBER

extern GL gl; /* the current context's functions */

typedef struct Context Context;

/* An OpenGL 3.3 core context, made current. Off-screen ends the program when it cannot be had; the window
 * (of width x height screen units) returns NULL and the reason when there is no display.
 * context_destroy frees it. One context at a time is current; only its thread may use gl. */
Context *context_offscreen(void);
Context *context_window(int width, int height, const char *title, const char **reason);
void context_destroy(Context *context);

/* The window's own handle (a GLFWwindow), NULL for an off-screen context. */
void *context_handle(Context *context);

/* What each kind of context provides; a third kind is one more file with one more of these. */
typedef struct {
    const char *name;
    void (*(*function)(const char *name))(void); /* the address of glNAME in the current context */
    void (*destroy)(void *handle);
} ContextKind;

/* For the kinds: wraps their handle, whose context is current, and loads gl. */
Context *context_adopt(const ContextKind *kind, void *handle, bool window);

#endif
