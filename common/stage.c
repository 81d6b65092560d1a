#define _GNU_SOURCE /* vasprintf */
#include "stage.h"

#include "clock.h"
#include "context.h"
#include "fail.h"

#include <cglm/cglm.h>
#include <dirent.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- Where files are ---- */

const char *project_folder(void) {
    static char folder[PATH_MAX];
    if (folder[0]) return folder;
    ssize_t length = readlink("/proc/self/exe", folder, sizeof folder - 1);
    if (length <= 0) fail("/proc/self/exe cannot be read, so the program cannot find its files");
    for (char *slash; (slash = strrchr(folder, '/'));) {
        char *lessons = text("%s/lessons", folder);
        bool here = access(lessons, F_OK) == 0;
        free(lessons);
        if (here) return folder;
        *slash = '\0';
    }
    fail("no folder lessons/ at or above the program's own place");
}

char *project_path(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    char *inside;
    if (vasprintf(&inside, format, arguments) < 0) fail("out of memory");
    va_end(arguments);
    char *path = text("%s/%s", project_folder(), inside);
    free(inside);
    return path;
}

/* ---- The key of a truth: a hash (64-bit FNV-1a) of all that it depends on ---- */

static void hash_bytes(uint64_t *hash, const void *bytes, size_t count) {
    for (size_t i = 0; i < count; i++) *hash = (*hash ^ ((const unsigned char *)bytes)[i]) * 0x100000001b3u;
}

static void hash_file(uint64_t *hash, const char *path) {
    FILE *file = path ? fopen(path, "rb") : NULL;
    if (!file) return;
    unsigned char buffer[1 << 16];
    for (size_t count; (count = fread(buffer, 1, sizeof buffer, file)) > 0;) hash_bytes(hash, buffer, count);
    fclose(file);
}

static uint64_t truth_key(const Stage *stage) {
    uint64_t hash = 0xcbf29ce484222325u;
    const Options *options = &stage->options;
    hash_file(&hash,
              "/proc/self/exe"); /* the scene's truth is in the program, the shapes are in the library */
    static const char *const libraries[] = {"libtexel.so", "libtexel-files.so"};
    for (int i = 0; i < 2; i++) {
        char *library = project_path("build/%s", libraries[i]);
        hash_file(&hash, library);
        free(library);
    }
    hash_bytes(&hash, stage->scene->name, strlen(stage->scene->name));
    hash_bytes(&hash, &options->scale, sizeof options->scale);
    if (stage->scene->colour && *stage->scene->colour) hash_file(&hash, options->colour);
    hash_file(&hash, options->height);
    for (int i = 0; i < 2; i++) hash_file(&hash, options->other[i]);
    return hash;
}

/* ---- Opening and closing ---- */

static const char *asset(const char *chosen, const char *name) {
    if (!name || (!*name && !chosen)) return NULL;
    return chosen ? text("%s", chosen) : project_path("build/assets/%s", name);
}

Stage stage_open(const Lesson *lesson, const Scene *scene, const Options *options) {
    Stage stage = {
        .lesson = lesson, .scene = scene, .options = {.scene = scene->name, .scale = options->scale}};
    stage.options.colour = asset(options->colour, scene->colour);
    stage.options.height = asset(options->height, scene->height);
    for (int i = 0; i < 2; i++) stage.options.other[i] = asset(NULL, scene->other[i]);
    stage.folder = project_path("lessons/%s", lesson->name);
    stage.common = project_path("common");
    stage.cache = project_path("build/truth");
    stage.data = scene->load(&stage.options);
    stage.truth = (Truth){scene->truth, stage.data, scene->background, truth_key(&stage), stage.cache, NULL};
    return stage;
}

void stage_close(Stage *stage) {
    stage->scene->unload(stage->data);
    for (int i = 0; i < TECHNIQUES_MAX; i++) program_destroy(&stage->programs[i]);
    if (stage->plain.framebuffer) target_destroy(&stage->plain);
    if (stage->full.framebuffer) target_destroy(&stage->full);
    free((void *)stage->options.colour);
    free((void *)stage->options.height);
    for (int i = 0; i < 2; i++) free((void *)stage->options.other[i]);
    free(stage->folder);
    free(stage->common);
    free(stage->cache);
    *stage = (Stage){0};
}

/* ---- Drawing ---- */

Frame stage_frame(const Stage *stage, const Technique *technique, double knob, const View *view, int width,
                  int height) {
    return (Frame){.scene = stage->scene,
                   .technique = technique,
                   .knob = knob,
                   .data = stage->data,
                   .view = view,
                   .camera = view->camera,
                   .width = width,
                   .height = height};
}

static char *build(Stage *stage, const Technique *technique, Program *program) {
    return program_build(program, stage->folder, stage->common, technique->vertex, technique->fragment,
                         GLSL_330);
}

static Program *program_of(Stage *stage, const Technique *technique) {
    Program *program = &stage->programs[technique - stage->scene->techniques];
    if (program->id) return program;
    char *log = build(stage, technique, program);
    if (log) fail("%s", log);
    return program;
}

char *stage_reload(Stage *stage) {
    char *first = NULL;
    for (int i = 0; i < technique_count(stage->scene); i++) {
        const Technique *technique = &stage->scene->techniques[i];
        char *log = technique->fragment ? build(stage, technique, &stage->programs[i]) : NULL;
        if (first)
            free(log);
        else
            first = log;
    }
    return first;
}

static uint64_t folder_stamp(const char *folder) {
    static const char *const endings[] = {".vert", ".frag", ".glsl", ".inc"};
    uint64_t stamp = 0;
    DIR *listing = opendir(folder);
    for (struct dirent *entry; listing && (entry = readdir(listing));) {
        const char *ending = strrchr(entry->d_name, '.');
        struct stat status;
        bool shader = false;
        for (int i = 0; ending && i < 4; i++) shader = shader || strcmp(ending, endings[i]) == 0;
        if (!shader || fstatat(dirfd(listing), entry->d_name, &status, 0) != 0) continue;
        uint64_t hash = 0xcbf29ce484222325u;
        hash_bytes(&hash, entry->d_name, strlen(entry->d_name));
        hash_bytes(&hash, &status.st_mtim, sizeof status.st_mtim);
        hash_bytes(&hash, &status.st_size, sizeof status.st_size);
        stamp += hash; /* a sum, for a folder's order may change */
    }
    if (listing) closedir(listing);
    return stamp;
}

uint64_t stage_stamp(const Stage *stage) { return folder_stamp(stage->folder) + folder_stamp(stage->common); }

static const Target *target_of(Target *target, int width, int height, bool lookup) {
    if (target->framebuffer && (target->width != width || target->height != height)) target_destroy(target);
    if (!target->framebuffer) *target = target_create(width, height, lookup);
    return target;
}

/* What every shader may ask for. */
static void set_uniforms(const Frame *frame) {
    const Program *program = frame->program;
    static const float identity[16] = {[0] = 1, [5] = 1, [10] = 1, [15] = 1};
    mat4 view, projection, view_projection;
    camera_matrices(&frame->camera, frame->width, frame->height, view, projection);
    glm_mat4_mul(projection, view, view_projection);
    program_matrix(program, "view_projection", view_projection[0], 4);
    program_matrix(program, "model", identity, 4);
    const Camera *camera = &frame->camera; /* eye - w * p points toward the eye from any point p */
    if (camera->fov_y_degrees > 0.0) {
        program_vector(program, "eye", camera->eye.x, camera->eye.y, camera->eye.z, 1.0);
    } else {
        Vec3 toward = vec3_normalize(vec3_sub(camera->eye, camera->target));
        program_vector(program, "eye", toward.x, toward.y, toward.z, 0.0);
        program_number(program, "eye_plane", vec3_dot(camera->eye, toward)); /* how far the eye is that way */
    }
    program_number(program, "knob", frame->knob);
    program_integer(program, "variant", frame->technique->variant);
    program_vector(program, "size", frame->width, frame->height, 0.0, 0.0);
}

static void draw(Stage *stage, const Frame *frame, const Target *target) {
    Frame drawn = *frame;
    drawn.program = program_of(stage, frame->technique);
    target_begin(target, frame->scene->background);
    program_use(drawn.program);
    set_uniforms(&drawn);
    frame->scene->draw(&drawn);
}

static void paint(const Frame *frame, Picture *picture) {
    Vec3 background = frame->scene->background;
    size_t count = (size_t)frame->width * frame->height;
    for (size_t i = 0; i < count; i++) {
        picture->colour.pixels[3 * i + 0] = (float)background.x;
        picture->colour.pixels[3 * i + 1] = (float)background.y;
        picture->colour.pixels[3 * i + 2] = (float)background.z;
    }
    if (picture->lookup.pixels) memset(picture->lookup.pixels, 0, 4 * count * sizeof(float));
    frame->technique->paint(frame, picture);
}

void stage_draw(Stage *stage, const Frame *frame, Picture *picture) {
    Frame drawn = *frame;
    drawn.looking = picture->lookup.pixels != NULL;
    if (drawn.technique->prepare) drawn.technique->prepare(&drawn);
    if (drawn.technique->paint) {
        paint(&drawn, picture);
        return;
    }
    const Target *target =
        target_of(drawn.looking ? &stage->full : &stage->plain, drawn.width, drawn.height, drawn.looking);
    draw(stage, &drawn, target);
    target_read(target, picture);
}

Cost stage_time(Stage *stage, const Frame *frame, Picture *scratch) {
    const Technique *technique = frame->technique;
    double start = clock_seconds();
    if (technique->prepare) technique->prepare(frame);
    gl.Finish(); /* what was asked of GL before belongs to the preparation */
    double prepared = clock_seconds();
    if (technique->paint) {
        paint(frame, scratch);
    } else {
        draw(stage, frame, target_of(&stage->plain, frame->width, frame->height, false));
        gl.Finish();
    }
    return (Cost){1e9 * (prepared - start), 1e9 * (clock_seconds() - prepared)};
}
