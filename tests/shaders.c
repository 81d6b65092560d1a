/* Whether every shader of common and of every lesson compiles in both dialects, and whether every technique
 * file keeps to what GLSL and C++ share. Prints TAP. Run from the root of the tree. */
#define _GNU_SOURCE /* strsep, and \< in patterns */
#include "context.h"
#include "draw.h"
#include "fail.h"

#include <glob.h>
#include <regex.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char nothing[] = "layout(location = 0) out vec4 colour;\nvoid main() { colour = vec4(1.0); }\n";
static const char *const dialects[] = {[GLSL_330] = "GLSL 3.30", [GLSL_ES_300] = "GLSL ES 3.00"};

static int tests, failures;

/* One test's line, with the reason (freed here) when it failed. */
static void report(const char *path, const char *what, char *reason) {
    char *rest = reason;
    for (char *line; (line = strsep(&rest, "\n"));) printf("# %s\n", line);
    printf("%s %d - %s: %s\n", reason ? "not ok" : "ok", ++tests, path, what);
    failures += reason != NULL;
    free(reason);
}

/* The files of a folder with an ending, in alphabetical order; globfree frees them. */
static glob_t files_of(const char *folder, const char *ending) {
    glob_t files;
    char *pattern = text("%s/*%s", folder, ending);
    int status = glob(pattern, 0, NULL, &files);
    if (status && status != GLOB_NOMATCH) fail("%s cannot be read", pattern);
    free(pattern);
    return files;
}

static const char *file_name(const char *path) { return strrchr(path, '/') + 1; }

/* ---- Compiling ---- */

/* NULL, or the log, which the caller frees. */
static char *try(const char *folder, const char *vertex, const char *fragment, const char *source,
                 Glsl dialect) {
    Program program = {0};
    char *log = program_build_text(&program, folder, "common", vertex, fragment, source, dialect);
    program_destroy(&program);
    return log;
}

/* The same with any of the vertex shaders of a folder: one must give the fragment what it reads. log is that
 * of the attempts before, and grows. */
static char *try_vertices(const char *folder, const char *vertices, const char *fragment, Glsl dialect,
                          char *log) {
    glob_t files = files_of(vertices, ".vert");
    for (size_t i = 0; log && i < files.gl_pathc; i++) {
        const char *vertex = file_name(files.gl_pathv[i]);
        char *more = try(folder, vertex, fragment, NULL, dialect);
        bool known = more && strstr(log, more); /* a mistake in the fragment itself is the same with each */
        char *all = !more ? NULL : known ? text("%s", log) : text("%s\nwith %s:\n%s", log, vertex, more);
        free(log), free(more);
        log = all;
    }
    globfree(&files);
    return log;
}

static void compile_folder(const char *folder, Glsl dialect) {
    glob_t files = files_of(folder, ".vert");
    for (size_t i = 0; i < files.gl_pathc; i++)
        report(files.gl_pathv[i], dialects[dialect],
               try(folder, file_name(files.gl_pathv[i]), "nothing", nothing, dialect));
    globfree(&files);
    files = files_of(folder, ".frag");
    for (size_t i = 0; i < files.gl_pathc; i++) {
        const char *name = file_name(files.gl_pathv[i]);
        char *log = try_vertices(folder, folder, name, dialect, text("links with no vertex shader"));
        if (strcmp(folder, "common") != 0) log = try_vertices(folder, "common", name, dialect, log);
        report(files.gl_pathv[i], dialects[dialect], log);
    }
    globfree(&files);
    files = files_of(folder, ".glsl");
    for (size_t i = 0; i < files.gl_pathc; i++) {
        char *source = text("#include \"%s\"\n%s", file_name(files.gl_pathv[i]), nothing);
        report(files.gl_pathv[i], dialects[dialect],
               try(folder, "everywhere.vert", "nothing", source, dialect));
        free(source);
    }
    globfree(&files);
}

/* ---- Reading ---- */

static char *read_file(const char *path) {
    char *result = NULL;
    size_t size = 0;
    FILE *file = fopen(path, "r");
    if (!file || getdelim(&result, &size, '\0', file) < 0) fail("%s cannot be read", path);
    fclose(file);
    return result;
}

/* Replaces comments by spaces, but keeps their lines. */
static void blank_comments(char *at) {
    while ((at = strchr(at, '/'))) {
        const char *end = at[1] == '/' ? "\n" : at[1] == '*' ? "*/" : NULL;
        if (!end) {
            at++;
            continue;
        }
        char *stop = strstr(at + 2, end);
        stop = stop ? stop + (*end == '*' ? 2 : 0) : at + strlen(at);
        for (; at < stop; at++)
            if (*at != '\n') *at = ' ';
    }
}

/* What a technique file may not hold: what is not pure, what is not C++, what is another dialect's. */
static const char forbidden[] =
    "\\<texture[[:space:]]*\\(|\\<(dFdx|dFdy|fwidth|discard|uniform|out|inout)\\>|\\<gl_|"
    "\\<(lowp|mediump|highp|precision)\\>|#[[:space:]]*version|\\][[:space:]]*\\(";

static void read_technique(const char *path) {
    char *source = read_file(path), *reason = NULL;
    regex_t pattern;
    regmatch_t match;
    if (regcomp(&pattern, forbidden, REG_EXTENDED) != 0) fail("the pattern is wrong");
    blank_comments(source);
    if (regexec(&pattern, source, 1, &match, 0) == 0) {
        int line = 1;
        for (int i = 0; i < match.rm_so; i++) line += source[i] == '\n';
        reason = text("%s:%d: a technique file may not hold '%.*s'", path, line,
                      (int)(match.rm_eo - match.rm_so), source + match.rm_so);
    }
    report(path, "pure functions only", reason);
    regfree(&pattern);
    free(source);
}

static void read_folder(const char *folder) {
    glob_t files = files_of(folder, ".glsl");
    for (size_t i = 0; i < files.gl_pathc; i++) read_technique(files.gl_pathv[i]);
    globfree(&files);
}

int main(int argc, char **argv) {
    glob_t folders = {0};
    if (argc > 1) fail_usage("%s: no argument is known", argv[1]);
    if (glob("common", 0, NULL, &folders) != 0) fail("no folder common: run this from the root of the tree");
    if (glob("lessons/[0-9][0-9]-*", GLOB_APPEND, NULL, &folders) != 0) fail("no lessons");
    Context *context = context_offscreen();
    for (size_t i = 0; i < folders.gl_pathc; i++) {
        compile_folder(folders.gl_pathv[i], GLSL_330);
        compile_folder(folders.gl_pathv[i], GLSL_ES_300);
        read_folder(folders.gl_pathv[i]);
    }
    context_destroy(context);
    globfree(&folders);
    printf("1..%d\n", tests);
    return failures ? STATUS_FAILURE : 0;
}
