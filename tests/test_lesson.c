/* A scene that makes its own colour and takes a user's: what its load is handed, and what --list says. */
#define _DEFAULT_SOURCE /* mkdtemp */
#include "lesson.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* ---- A lesson of three scenes: with an image, without one, and with its own ---- */

static void *load(const Options *options) {
    printf("loaded %s\n", options->colour ? options->colour : "nothing");
    return NULL;
}

static void unload(void *data) { (void)data; }

static void paint(const Frame *frame, Picture *picture) { (void)frame, (void)picture; }

static Sample miss(const void *data, Ray ray) {
    (void)data, (void)ray;
    return (Sample){0};
}

#define SCENE                                                                                                \
    .techniques = {{.name = "paint", .what = "nothing", .paint = paint}},                                    \
    .views = {{.name = "front",                                                                              \
               .camera = {.eye = {0, 0, 2}, .up = {0, 1, 0}, .fov_y_degrees = 40, .near = 0.1, .far = 10}}}, \
    .load = load, .unload = unload, .truth = miss

static const Lesson lesson = {.name = "18-light-field",
                              .title = "for a test",
                              .scenes = {{"image", "of an image", .colour = "checker.png", SCENE},
                                         {"none", "of no image", SCENE},
                                         {"own", "of its own", .colour = "", SCENE}}};

/* ---- Its command line, in a process of its own: both outputs, and the exit status ---- */

static char said[1 << 14];

static int run(const char *scene, const char *order, const char *value, const char *colour) {
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    fflush(stdout);
    pid_t child = fork();
    if (child == 0) {
        dup2(ends[1], 1), dup2(ends[1], 2);
        char *arguments[10] = {"lesson", "--scene", (char *)scene, (char *)order};
        int count = 4;
        if (value) arguments[count++] = (char *)value;
        arguments[count++] = "--size=8x8";
        if (colour) arguments[count++] = "--colour", arguments[count++] = (char *)colour;
        int status = lesson_run(&lesson, count, arguments);
        fflush(stdout);
        _exit(status);
    }
    close(ends[1]);
    size_t size = 0;
    for (ssize_t got; (got = read(ends[0], said + size, sizeof said - 1 - size)) > 0;) size += (size_t)got;
    said[size] = '\0';
    close(ends[0]);
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static void says(int status, const char *part) {
    if (status != 0 || !strstr(said, part)) fail_msg("status %d, expected \"%s\" in: %s", status, part, said);
}

static void lists_what_the_user_gave(void **state) {
    (void)state;
    says(run("image", "--list", NULL, NULL), "/build/assets/checker.png\n");
    says(run("own", "--list", NULL, NULL), "scene own: of its own\n  background"); /* and no colour */
    says(run("own", "--list", NULL, "/dev/null"), "scene own: of its own\n  colour /dev/null\n  background");
    assert_int_equal(run("none", "--list", NULL, "/dev/null"), 2);
    assert_non_null(strstr(said, "--colour: no scene chosen takes one"));
    assert_int_equal(run("own", "--list", NULL, "/dev/null/missing"), 1);
}

static void loads_what_the_user_gave(void **state) {
    (void)state;
    char folder[200];
    const char *temporary = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/texel-XXXXXX", temporary ? temporary : "/tmp");
    assert_non_null(mkdtemp(folder));
    says(run("image", "--render", folder, NULL), "/build/assets/checker.png\n");
    says(run("none", "--render", folder, NULL), "loaded nothing\n");
    says(run("own", "--render", folder, NULL), "loaded nothing\n");
    says(run("own", "--render", folder, "/dev/null"), "loaded /dev/null\n");
    static const char *const scenes[] = {"image", "none", "own"}, *const endings[] = {"exr", "png"};
    for (int i = 0; i < 6; i++) {
        char path[256];
        snprintf(path, sizeof path, "%s/%s-front-paint.%s", folder, scenes[i / 2], endings[i % 2]);
        assert_int_equal(remove(path), 0);
    }
    assert_int_equal(rmdir(folder), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_what_the_user_gave),
        cmocka_unit_test(loads_what_the_user_gave),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("lesson", tests, NULL, NULL);
}
