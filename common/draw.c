#include "draw.h"

#include "context.h"
#include "fail.h"

#include <stdlib.h>
#include <string.h>

void draw_check(const char *what) {
    GLenum error = gl.GetError();
    if (error == GL_OUT_OF_MEMORY) fail("%s: OpenGL is out of memory", what);
    if (error != GL_NO_ERROR) fail("%s: OpenGL error 0x%04x", what, error);
}

/* ---- Textures ---- */

static void upload(const Image *image, int level, TextureFormat format) {
    static const GLenum layouts[] = {0, GL_RED, GL_RG, GL_RGB, GL_RGBA};
    static const GLint floats[] = {0, GL_R32F, GL_RG32F, GL_RGB32F, GL_RGBA32F};
    size_t count = (size_t)image->width * image->height;
    const void *pixels = image->pixels;
    unsigned char *bytes = NULL; /* sRGB is encoded here: OpenGL would store linear floats as they are */
    GLint stored = floats[image->channels];
    if (format == TEXTURE_SRGB8) {
        stored = GL_SRGB8_ALPHA8;
        pixels = bytes = allocate(count, 3);
        for (size_t i = 0; i < 3 * count; i++)
            bytes[i] = (unsigned char)lround(255.0 * srgb_encode(clamp(image->pixels[i], 0.0, 1.0)));
    }
    if (format == TEXTURE_R16) stored = GL_R16;
    gl.TexImage2D(GL_TEXTURE_2D, level, stored, image->width, image->height, 0, layouts[image->channels],
                  bytes ? GL_UNSIGNED_BYTE : GL_FLOAT, pixels);
    free(bytes);
}

static void set_filter(TextureFilter filter) {
    static const GLint minify[] = {GL_NEAREST, GL_LINEAR, GL_NEAREST_MIPMAP_NEAREST, GL_LINEAR_MIPMAP_LINEAR};
    bool smooth = filter == TEXTURE_LINEAR || filter == TEXTURE_TRILINEAR;
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, minify[filter]);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, smooth ? GL_LINEAR : GL_NEAREST);
}

Texture texture_create(const Image *levels, int count, TextureFormat format, TextureFilter filter) {
    Texture texture = {.width = levels[0].width, .height = levels[0].height, .levels = count};
    if (format == TEXTURE_SRGB8 && levels[0].channels != 3) fail("an sRGB texture needs three channels");
    if (format == TEXTURE_R16 && levels[0].channels != 1) fail("a 16-bit texture needs one channel");
    gl.GenTextures(1, &texture.id);
    gl.BindTexture(GL_TEXTURE_2D, texture.id);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, count - 1);
    set_filter(filter);
    for (int i = 0; i < count; i++) upload(&levels[i], i, format);
    draw_check("making a texture");
    return texture;
}

Texture texture_of(const Image *image, ImageKind kind) {
    TextureFormat format = TEXTURE_FLOAT;
    if (kind == IMAGE_COLOUR && image->bits == 8) format = TEXTURE_SRGB8;
    if (kind == IMAGE_HEIGHT && image->bits <= 16) format = TEXTURE_R16;
    return texture_create(image, 1, format, TEXTURE_LINEAR);
}

Texture texture_empty(int width, int height, TextureFormat format, TextureFilter filter) {
    Texture texture = {.width = width, .height = height, .levels = 1};
    gl.GenTextures(1, &texture.id);
    gl.BindTexture(GL_TEXTURE_2D, texture.id);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    set_filter(filter);
    gl.TexImage2D(GL_TEXTURE_2D, 0, format == TEXTURE_SRGBA8 ? GL_SRGB8_ALPHA8 : GL_RGBA16, width, height, 0,
                  GL_RGBA, format == TEXTURE_SRGBA8 ? GL_UNSIGNED_BYTE : GL_UNSIGNED_SHORT, NULL);
    draw_check("making an empty texture");
    return texture;
}

void texture_write_part(const Texture *texture, TextureFormat format, int x, int y, int width, int height,
                        const void *texels) {
    gl.BindTexture(GL_TEXTURE_2D, texture->id);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl.TexSubImage2D(GL_TEXTURE_2D, 0, x, y, width, height, format == TEXTURE_SRGB8 ? GL_RGB : GL_RGBA,
                     format == TEXTURE_RGBA16 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE, texels);
    draw_check("writing a texture");
}

void texture_write(const Texture *texture, TextureFormat format, const void *texels) {
    texture_write_part(texture, format, 0, 0, texture->width, texture->height, texels);
}

static void pack_numbers(int width, int height, TexturePacking packing, const uint8_t *data, size_t bytes) {
    static const struct {
        GLint stored;
        GLenum layout, type;
        size_t bytes;
    } numbers[] = {{GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE, 1},
                   {GL_R16UI, GL_RED_INTEGER, GL_UNSIGNED_SHORT, 2},
                   {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 4},
                   {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, 16}};
    GLenum layout = numbers[packing].layout, type = numbers[packing].type;
    size_t row = numbers[packing].bytes * (size_t)width;
    int whole = (int)(bytes / row), rest = (int)(bytes % row / numbers[packing].bytes);
    gl.TexImage2D(GL_TEXTURE_2D, 0, numbers[packing].stored, width, height, 0, layout, type, NULL);
    if (whole) gl.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, whole, layout, type, data);
    if (rest) gl.TexSubImage2D(GL_TEXTURE_2D, 0, 0, whole, rest, 1, layout, type, data + row * (size_t)whole);
}

/* From EXT_texture_compression_s3tc with EXT_texture_sRGB, and ARB_texture_compression_bptc. */
enum { SRGB_S3TC_DXT1 = 0x8c4c, SRGB_ALPHA_BPTC_UNORM = 0x8e8d };

Texture texture_packed(int width, int height, TexturePacking packing, const void *data, size_t bytes) {
    Texture texture = {.width = width, .height = height, .levels = 1};
    gl.GenTextures(1, &texture.id);
    gl.BindTexture(GL_TEXTURE_2D, texture.id);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    set_filter(TEXTURE_NEAREST);
    if (packing < PACKED_BC1)
        pack_numbers(width, height, packing, data, bytes);
    else
        gl.CompressedTexImage2D(GL_TEXTURE_2D, 0,
                                packing == PACKED_BC1 ? SRGB_S3TC_DXT1 : SRGB_ALPHA_BPTC_UNORM, width, height,
                                0, (GLsizei)bytes, data);
    draw_check("making a packed texture");
    return texture;
}

void texture_mipmap(Texture *texture) {
    gl.BindTexture(GL_TEXTURE_2D, texture->id);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 1000);
    gl.GenerateMipmap(GL_TEXTURE_2D);
    gl.Finish(); /* OSMesa was seen to hand out levels, by glGetTexImage, that were not there yet */
    set_filter(TEXTURE_TRILINEAR);
    for (int size = texture->width > texture->height ? texture->width : texture->height; size > 1; size /= 2)
        texture->levels++;
    draw_check("making a mipmap");
}

void texture_destroy(Texture *texture) {
    gl.DeleteTextures(1, &texture->id);
    *texture = (Texture){0};
}

void program_texture(Program *program, const char *name, const Texture *texture) {
    gl.ActiveTexture(GL_TEXTURE0 + program->units);
    gl.BindTexture(GL_TEXTURE_2D, texture->id);
    program_integer(program, name, program->units++);
}

/* ---- Meshes ---- */

Shape shape_create(const Mesh *mesh) {
    Shape shape = {.index_count = mesh->index_count};
    gl.GenVertexArrays(1, &shape.vertex_array);
    gl.BindVertexArray(shape.vertex_array);
    gl.GenBuffers(1, &shape.vertices);
    gl.BindBuffer(GL_ARRAY_BUFFER, shape.vertices);
    gl.BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(sizeof(Vertex) * mesh->vertex_count), mesh->vertices,
                  GL_STATIC_DRAW);
    gl.GenBuffers(1, &shape.indices);
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, shape.indices);
    gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(sizeof(uint32_t) * mesh->index_count), mesh->indices,
                  GL_STATIC_DRAW);
    static const struct {
        int size;
        size_t offset;
    } attributes[] = {{3, offsetof(Vertex, position)},
                      {3, offsetof(Vertex, normal)},
                      {4, offsetof(Vertex, tangent)},
                      {2, offsetof(Vertex, uv)}};
    for (unsigned i = 0; i < 4; i++) {
        gl.EnableVertexAttribArray(i);
        gl.VertexAttribPointer(i, attributes[i].size, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                               (const void *)attributes[i].offset);
    }
    draw_check("making a mesh");
    return shape;
}

void shape_draw(const Shape *shape) {
    gl.BindVertexArray(shape->vertex_array);
    gl.DrawElements(GL_TRIANGLES, shape->index_count, GL_UNSIGNED_INT, NULL);
}

void shape_destroy(Shape *shape) {
    gl.DeleteVertexArrays(1, &shape->vertex_array);
    gl.DeleteBuffers(1, &shape->vertices);
    gl.DeleteBuffers(1, &shape->indices);
    *shape = (Shape){0};
}

void draw_everywhere(void) {
    GLuint empty; /* a core profile draws nothing without a vertex array, though it may be empty */
    gl.GenVertexArrays(1, &empty);
    gl.BindVertexArray(empty);
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
    gl.DeleteVertexArrays(1, &empty);
}

/* ---- Targets and pictures ---- */

Picture picture_create(int width, int height, bool lookup) {
    Picture picture = {.colour = image_create(width, height, 3)};
    if (lookup) picture.lookup = image_create(width, height, 4);
    return picture;
}

void picture_destroy(Picture *picture) {
    image_destroy(&picture->colour);
    image_destroy(&picture->lookup);
}

static GLuint attach_floats(int width, int height, GLenum place) {
    GLuint texture;
    gl.GenTextures(1, &texture);
    gl.BindTexture(GL_TEXTURE_2D, texture);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, NULL);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    set_filter(TEXTURE_NEAREST);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, place, GL_TEXTURE_2D, texture, 0);
    return texture;
}

Target target_create(int width, int height, bool lookup) {
    static const GLenum places[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    Target target = {.width = width, .height = height};
    gl.GenFramebuffers(1, &target.framebuffer);
    gl.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    target.colour = attach_floats(width, height, GL_COLOR_ATTACHMENT0);
    if (lookup) target.lookup = attach_floats(width, height, GL_COLOR_ATTACHMENT1);
    gl.GenRenderbuffers(1, &target.depth);
    gl.BindRenderbuffer(GL_RENDERBUFFER, target.depth);
    gl.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, width, height);
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, target.depth);
    gl.DrawBuffers(lookup ? 2 : 1, places);
    if (gl.GetError() || gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        fail("a picture of %dx%d is more than OpenGL can draw here", width, height);
    return target;
}

void target_destroy(Target *target) {
    gl.DeleteFramebuffers(1, &target->framebuffer);
    gl.DeleteTextures(1, &target->colour);
    if (target->lookup) gl.DeleteTextures(1, &target->lookup);
    gl.DeleteRenderbuffers(1, &target->depth);
    *target = (Target){0};
}

void target_begin(const Target *target, Vec3 background) {
    const float colour[4] = {(float)background.x, (float)background.y, (float)background.z, 1.0f};
    const float nothing[4] = {0}, farthest = 1.0f;
    gl.BindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
    gl.Viewport(0, 0, target->width, target->height);
    gl.Enable(GL_DEPTH_TEST);
    gl.Disable(GL_BLEND);
    gl.ClearBufferfv(GL_COLOR, 0, colour);
    if (target->lookup) gl.ClearBufferfv(GL_COLOR, 1, nothing);
    gl.ClearBufferfv(GL_DEPTH, 0, &farthest);
}

void target_read(const Target *target, Picture *picture) {
    gl.Finish();
    gl.BindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl.ReadBuffer(GL_COLOR_ATTACHMENT0);
    gl.ReadPixels(0, 0, target->width, target->height, GL_RGB, GL_FLOAT, picture->colour.pixels);
    if (target->lookup && picture->lookup.pixels) {
        gl.ReadBuffer(GL_COLOR_ATTACHMENT1);
        gl.ReadPixels(0, 0, target->width, target->height, GL_RGBA, GL_FLOAT, picture->lookup.pixels);
    }
    draw_check("drawing");
}
