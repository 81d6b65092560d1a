/* Shaders from files: the dialect's header in front, #include by concatenation, the log mapped back to
 * file names. */
#define _GNU_SOURCE /* open_memstream, getline */
#include "draw.h"

#include "context.h"
#include "fail.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const headers[] = {
    [GLSL_330] = "#version 330 core\n",
    [GLSL_ES_300] =
        "#version 300 es\n"
        "precision highp float;\nprecision highp int;\n"
        "precision highp sampler2D;\nprecision highp sampler2DArray;\nprecision highp sampler3D;\n"
        "precision highp isampler2D;\nprecision highp usampler2D;\nprecision highp samplerCube;\n"};

/* The files of one shader: file number N of a #line directive is names[N]. */
enum { FILES_MAX = 16 };
typedef struct {
    const char *folder, *common;
    char *names[FILES_MAX];
    int count;
} Files;

static FILE *find(const Files *files, const char *name, char **path) {
    const char *const folders[] = {files->folder, files->common};
    for (int i = 0; i < 2; i++) {
        *path = text("%s/%s", folders[i], name);
        FILE *file = fopen(*path, "r");
        if (file) return file;
        free(*path);
    }
    *path = NULL;
    return NULL;
}

static int add_name(Files *files, char *path) {
    if (files->count == FILES_MAX) fail("%s: more than %d shader files include each other", path, FILES_MAX);
    files->names[files->count] = path;
    return files->count++;
}

static bool include_file(FILE *out, Files *files, const char *name, char **error);

/* Copies the lines of a file to out, with what they include in its place. */
static bool include_lines(FILE *out, Files *files, FILE *in, int number, char **error) {
    char *line = NULL, name[256];
    size_t size = 0;
    bool good = true;
    fprintf(out, "#line 1 %d\n", number);
    for (int at = 1; good && getline(&line, &size, in) >= 0; at++) {
        if (sscanf(line, " #include \"%255[^\"]\"", name) == 1) {
            good = include_file(out, files, name, error);
            if (!good && !*error) *error = text("%s:%d: no file %s", files->names[number], at, name);
            fprintf(out, "#line %d %d\n", at + 1, number);
        } else {
            fputs(line, out);
        }
    }
    fputc('\n', out); /* a last line without an end would swallow the next directive */
    free(line);
    return good;
}

static bool include_file(FILE *out, Files *files, const char *name, char **error) {
    char *path;
    FILE *in = find(files, name, &path);
    if (!in) return false;
    bool good = true, seen = false;
    for (int i = 0; i < files->count; i++) seen = seen || strcmp(files->names[i], path) == 0;
    if (seen)
        free(path);
    else
        good = include_lines(out, files, in, add_name(files, path), error);
    fclose(in);
    return good;
}

/* Rewrites a log's places, "N:LINE(COLUMN): " (Mesa) or "N(LINE) : " (NVIDIA), as "FILE:LINE: ". */
static char *map_log(const Files *files, const char *log) {
    char *result = NULL;
    size_t size;
    FILE *out = open_memstream(&result, &size);
    while (*log) {
        int number, line, length = 0;
        bool placed = sscanf(log, "%d:%d(%*d): %n", &number, &line, &length) == 2 && length;
        placed = placed || (sscanf(log, "%d(%d) : %n", &number, &line, &length) == 2 && length);
        placed = placed || (sscanf(log, "%*[A-Z]: %d:%d: %n", &number, &line, &length) == 2 && length);
        if (placed && number >= 0 && number < files->count) {
            fprintf(out, "%s:%d: ", files->names[number], line);
            log += length;
        }
        size_t rest = strcspn(log, "\n");
        fprintf(out, "%.*s\n", (int)rest, log);
        log += rest + (log[rest] == '\n');
    }
    fclose(out);
    while (size && result[size - 1] == '\n') result[--size] = '\0';
    return result;
}

/* One stage from a text that was put together; NULL and an id, or a log. */
static char *compile(GLenum stage, const char *source, const Files *files, GLuint *id) {
    GLint good, length;
    *id = gl.CreateShader(stage);
    gl.ShaderSource(*id, 1, &source, NULL);
    gl.CompileShader(*id);
    gl.GetShaderiv(*id, GL_COMPILE_STATUS, &good);
    if (good) return NULL;
    gl.GetShaderiv(*id, GL_INFO_LOG_LENGTH, &length);
    char *log = allocate((size_t)length + 1, 1);
    gl.GetShaderInfoLog(*id, length + 1, NULL, log);
    char *mapped = map_log(files, log);
    free(log);
    gl.DeleteShader(*id);
    return mapped;
}

/* One stage: the file `name`, or the text given under that name. */
static char *build_stage(GLenum stage, const char *folder, const char *common, const char *name,
                         const char *given, Glsl dialect, GLuint *id) {
    Files files = {.folder = folder, .common = common};
    char *source = NULL, *error = NULL;
    size_t size;
    FILE *out = open_memstream(&source, &size);
    fputs(headers[dialect], out);
    bool good;
    if (given) {
        FILE *in = fmemopen((void *)(uintptr_t)given, strlen(given), "r"); /* "r" does not write to it */
        good = in && include_lines(out, &files, in, add_name(&files, text("%s", name)), &error);
        if (in) fclose(in);
    } else {
        good = include_file(out, &files, name, &error);
    }
    fclose(out);
    if (!good && !error) error = text("%s/%s: %s", folder, name, strerror(errno));
    if (good) error = compile(stage, source, &files, id);
    for (int i = 0; i < files.count; i++) free(files.names[i]);
    free(source);
    return error;
}

static char *link_program(GLuint vertex, GLuint fragment, Program *program) {
    GLint good, length;
    GLuint id = gl.CreateProgram();
    gl.AttachShader(id, vertex);
    gl.AttachShader(id, fragment);
    gl.LinkProgram(id);
    gl.GetProgramiv(id, GL_LINK_STATUS, &good);
    if (good) {
        program_destroy(program);
        *program = (Program){.id = id};
        return NULL;
    }
    gl.GetProgramiv(id, GL_INFO_LOG_LENGTH, &length);
    char *log = allocate((size_t)length + 1, 1);
    gl.GetProgramInfoLog(id, length + 1, NULL, log);
    gl.DeleteProgram(id);
    return log;
}

char *program_build_text(Program *program, const char *folder, const char *common, const char *vertex,
                         const char *name, const char *fragment, Glsl dialect) {
    GLuint stages[2];
    char *error = build_stage(GL_VERTEX_SHADER, folder, common, vertex, NULL, dialect, &stages[0]);
    if (error) return error;
    error = build_stage(GL_FRAGMENT_SHADER, folder, common, name, fragment, dialect, &stages[1]);
    if (!error) {
        error = link_program(stages[0], stages[1], program);
        gl.DeleteShader(stages[1]);
    }
    gl.DeleteShader(stages[0]);
    return error;
}

char *program_build(Program *program, const char *folder, const char *common, const char *vertex,
                    const char *fragment, Glsl dialect) {
    return program_build_text(program, folder, common, vertex, fragment, NULL, dialect);
}

void program_destroy(Program *program) {
    if (program->id) gl.DeleteProgram(program->id);
    *program = (Program){0};
}

void program_use(Program *program) {
    gl.UseProgram(program->id);
    program->units = 0;
}

static GLint place(const Program *program, const char *name) {
    return gl.GetUniformLocation(program->id, name); /* -1, which GL passes over, where there is none */
}

void program_number(const Program *program, const char *name, double value) {
    gl.Uniform1f(place(program, name), (float)value);
}

void program_integer(const Program *program, const char *name, int value) {
    gl.Uniform1i(place(program, name), value);
}

void program_vector(const Program *program, const char *name, double x, double y, double z, double w) {
    gl.Uniform4f(place(program, name), (float)x, (float)y, (float)z, (float)w);
}

void program_matrix(const Program *program, const char *name, const float *columns, int size) {
    GLint location = place(program, name);
    if (size == 3)
        gl.UniformMatrix3fv(location, 1, GL_FALSE, columns);
    else
        gl.UniformMatrix4fv(location, 1, GL_FALSE, columns);
}
