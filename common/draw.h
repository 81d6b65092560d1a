/* OpenGL's objects without its ceremony: programs, textures, meshes on the GPU, targets to draw into.
 * All need a current context (context.h). A mistake here is the programmer's, so it ends the program with one
 * line; only a shader's errors are returned, for they come from a student's editor. */
#ifndef TEXEL_DRAW_H
#define TEXEL_DRAW_H

#include "camera.h"
#include "image.h"
#include "mesh.h"

/* ---- Shaders ---- */

typedef enum { GLSL_330, GLSL_ES_300 } Glsl;

typedef struct {
    unsigned id; /* 0: none */
    int units;   /* texture units in use since program_use */
} Program;

/* Compiles and links two files of one lesson, without #version lines, under the header of a dialect. A file,
 * and what it includes by #include "NAME" (no more than once each), is sought in folder, then in common.
 * Returns NULL, or the compiler's log with file names and lines, which the caller frees; program is then left
 * as it was. */
char *program_build(Program *program, const char *folder, const char *common, const char *vertex,
                    const char *fragment, Glsl dialect);
/* The same from one text of a fragment shader (which may include), called name in the log. */
char *program_build_text(Program *program, const char *folder, const char *common, const char *vertex,
                         const char *name, const char *fragment, Glsl dialect);
void program_destroy(Program *program);

/* Makes it the one that draws. The setters below are for the program in use; a name that the shader does not
 * have, or does not need, is passed over. */
void program_use(Program *program);
void program_number(const Program *program, const char *name, double value);
void program_integer(const Program *program, const char *name, int value);
void program_vector(const Program *program, const char *name, double x, double y, double z, double w);
void program_matrix(const Program *program, const char *name, const float *columns, int size); /* 3 or 4 */

/* ---- Textures ---- */

typedef enum {
    TEXTURE_SRGB8,  /* three channels, linear floats outside, eight bits of sRGB inside */
    TEXTURE_R16,    /* one channel of 0..1 in sixteen bits, which hold eight exactly too */
    TEXTURE_FLOAT,  /* one to four channels of 32-bit floats */
    TEXTURE_SRGBA8, /* for texture_write alone: four bytes a texel, red, green, blue in sRGB, and alpha as it
                       is */
    TEXTURE_RGBA16  /* for texture_write alone: four 16-bit numbers a texel */
} TextureFormat;

typedef enum { TEXTURE_NEAREST, TEXTURE_LINEAR, TEXTURE_MIP_NEAREST, TEXTURE_TRILINEAR } TextureFilter;

typedef struct {
    unsigned id;
    int width, height, levels;
} Texture;

/* A texture of `levels` images, each half its predecessor's size (rounded down, at least 1). It repeats in
 * both directions; the two mipmapping filters only make sense with several levels. */
Texture texture_create(const Image *levels, int count, TextureFormat format, TextureFilter filter);

/* What a lesson wants most: one level, bilinear, and what the file held, exactly. A colour image of 8 bits
 * becomes TEXTURE_SRGB8, a height of 8 or 16 bits TEXTURE_R16, anything else TEXTURE_FLOAT. */
Texture texture_of(const Image *image, ImageKind kind);

/* A texture that is written again and again: texels that C has made, packed as the format says, row 0 first.
 * It does not repeat: beyond its edges the outermost texels go on. What it holds before is not defined. */
Texture texture_empty(int width, int height, TextureFormat format, TextureFilter filter);
void texture_write(const Texture *texture, TextureFormat format, const void *texels);
/* The same for width x height texels whose lower left one is (x, y). TEXTURE_SRGB8: three bytes a texel. */
void texture_write_part(const Texture *texture, TextureFormat format, int x, int y, int width, int height,
                        const void *texels);

/* A texture that a shader reads by texelFetch alone. PACKED_U8 to PACKED_U32X4: whole numbers, one a texel or
 * four, for a usampler2D. PACKED_BC1, PACKED_BC7: blocks of 4 x 4 texels of sRGB as the GPU itself compresses
 * them, eight and sixteen bytes; width and height are multiples of 4. Rows of texels or of blocks follow one
 * another; what `bytes` leave out of the last row is not defined. Ends the program where OpenGL cannot. */
typedef enum { PACKED_U8, PACKED_U16, PACKED_U32, PACKED_U32X4, PACKED_BC1, PACKED_BC7 } TexturePacking;
Texture texture_packed(int width, int height, TexturePacking packing, const void *data, size_t bytes);

void texture_mipmap(Texture *texture); /* glGenerateMipmap, and TEXTURE_TRILINEAR */
void texture_destroy(Texture *texture);

/* Binds it to the sampler of that name. */
void program_texture(Program *program, const char *name, const Texture *texture);

/* ---- Meshes ---- */

typedef struct {
    unsigned vertex_array, vertices, indices;
    int index_count;
} Shape;

/* A mesh copied to the GPU: attributes 0 position, 1 normal, 2 tangent (xyz, handedness), 3 uv. */
Shape shape_create(const Mesh *mesh);
void shape_draw(const Shape *shape);
void shape_destroy(Shape *shape);

/* One triangle over the whole target, without a mesh: for a .vert that makes its corners from gl_VertexID.
 */
void draw_everywhere(void);

/* ---- Targets and pictures ---- */

/* What a technique's picture holds: colour has three channels of linear light, lookup four: u, v, depth
 * (world units from the eye along the ray) and hit (1 or 0). Row 0 is the bottom row. */
typedef struct {
    Image colour, lookup;
} Picture;

Picture picture_create(int width, int height, bool lookup);
void picture_destroy(Picture *picture);

typedef struct {
    int width, height;
    unsigned framebuffer, colour, lookup, depth;
} Target;

/* Floats to draw into: colour, and at location 1 the lookup if asked. Ends the program where memory ends. */
Target target_create(int width, int height, bool lookup);
void target_destroy(Target *target);

/* Makes it what is drawn into: sets the viewport, clears to the background, and lookup to 0, depth test on.
 */
void target_begin(const Target *target, Vec3 background);

/* Waits until all is drawn and copies it to a picture of the target's size (its lookup only if it has one).
 */
void target_read(const Target *target, Picture *picture);

/* Ends the program with what and OpenGL's error, if there was one. */
void draw_check(const char *what);

#endif
