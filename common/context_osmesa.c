/* OpenGL in memory, drawn by the processor: no display and no GPU needed. */
#include "context.h"

#include "fail.h"

#include <GL/osmesa.h>
#include <stdlib.h>

/* OSMesa draws into memory that it is handed. We draw into framebuffer objects, so one pixel will do; it
 * must outlive the context. */
static unsigned char pixel[4];

static void (*function(const char *name))(void) { return OSMesaGetProcAddress(name); }

static void destroy(void *handle) { OSMesaDestroyContext(handle); }

Context *context_offscreen(void) {
    static const ContextKind osmesa = {"OSMesa", function, destroy};
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_DEPTH_BITS,
                              0,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              3,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              3,
                              0};
    OSMesaContext handle = OSMesaCreateContextAttribs(attributes, NULL);
    if (!handle || !OSMesaMakeCurrent(handle, pixel, GL_UNSIGNED_BYTE, 1, 1))
        fail("no off-screen OpenGL 3.3: OSMesa cannot make a core context");
    return context_adopt(&osmesa, handle, false);
}
