#include "context.h"

#include "fail.h"

#include <stdio.h>
#include <stdlib.h>

GL gl;

struct Context {
    const ContextKind *kind;
    void *handle;
    bool window;
};

Context *context_adopt(const ContextKind *kind, void *handle, bool window) {
#define LOAD(upper, member)                                                                                  \
    gl.member = (PFNGL##upper##PROC)kind->function("gl" #member);                                            \
    if (!gl.member) fail("OpenGL by %s lacks gl%s", kind->name, #member);
    GL_FUNCTIONS(LOAD)
#undef LOAD
    Context *context = allocate(1, sizeof *context);
    *context = (Context){kind, handle, window};
    return context;
}

void context_destroy(Context *context) {
    if (!context) return;
    context->kind->destroy(context->handle);
    free(context);
}

void *context_handle(Context *context) { return context->window ? context->handle : NULL; }
