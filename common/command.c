#define _GNU_SOURCE /* program_invocation_name */
#include "command.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* In quotes where a shell would read it otherwise. */
static void print_word(const char *word) {
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+./,:=@%";
    bool quote = word[strspn(word, plain)] != '\0';
    if (quote) putchar('\'');
    for (; *word; word++) *word == '\'' ? fputs("'\\''", stdout) : putchar(*word);
    if (quote) putchar('\'');
}

static void print_option(const char *option, const char *value) {
    printf(" %s ", option);
    print_word(value);
}

static void print_camera(const Camera *camera) {
    Vec3 eye = camera->eye, target = camera->target, up = camera->up;
    bool perspective = camera->fov_y_degrees > 0.0;
    printf(" --view %.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g%s", eye.x, eye.y, eye.z, target.x, target.y, target.z,
           perspective ? camera->fov_y_degrees : camera->height, perspective ? "" : "o");
    if (up.x != 0.0 || up.z != 0.0 || up.y <= 0.0) printf(",%.9g,%.9g,%.9g", up.x, up.y, up.z);
}

void command_print(const Frame *frame, const Camera *camera, const Options *options) {
    const Scene *scene = frame->scene;
    print_word(program_invocation_name);
    print_option("--scene", scene->name);
    print_option("--technique", frame->technique->name);
    if (frame->technique->knob.name) printf(" --knob %g", frame->knob);
    if (camera)
        print_camera(camera);
    else
        print_option("--view", frame->view->name);
    printf(" --size %dx%d", frame->width, frame->height);
    if (scene->colour && options->colour) print_option("--colour", options->colour);
    if (scene->height && options->height) print_option("--height", options->height);
    if (scene->height && !isnan(options->scale)) printf(" --scale %.17g", options->scale);
    printf(" --render build/pictures\n");
    fflush(stdout);
}

bool command_camera(const char *argument, Camera *camera) {
    double n[10] = {[8] = 1.0}; /* eye, target, angle or height, up */
    int count = 0;
    bool orthographic = false;
    for (const char *at = argument; count < 10;) {
        char *end;
        n[count] = strtod(at, &end);
        if (end == at || !isfinite(n[count])) return false;
        count++;
        if (count == 7 && *end == 'o') orthographic = true, end++;
        at = end + 1;
        if (!*end && (count == 7 || count == 10)) break;
        if (*end != ',' || count == 10) return false;
    }
    *camera = (Camera){.eye = v3(n[0], n[1], n[2]),
                       .target = v3(n[3], n[4], n[5]),
                       .up = v3(n[7], n[8], n[9]),
                       .near = 0.01,
                       .far = 1000.0};
    if (orthographic)
        camera->height = n[6];
    else
        camera->fov_y_degrees = n[6];
    Vec3 forward = vec3_sub(camera->target, camera->eye);
    bool sees = vec3_length(vec3_cross(forward, camera->up)) > 1e-9 * vec3_length(forward);
    return sees && n[6] > 0.0 && (orthographic || n[6] < 180.0);
}
