#define _GNU_SOURCE /* program_invocation_name */
/* A lesson's command line. */
#include "lesson.h"

#include "command.h"
#include "context.h"
#include "fail.h"
#include "measure.h"
#include "window.h"

#include <errno.h>
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- Counting what the descriptor's arrays hold ---- */

int technique_count(const Scene *scene) {
    int count = 0;
    while (count < TECHNIQUES_MAX && scene->techniques[count].name) count++;
    return count;
}

int view_count(const Scene *scene) {
    int count = 0;
    while (count < VIEWS_MAX && scene->views[count].name) count++;
    return count;
}

int scene_count(const Lesson *lesson) {
    int count = 0;
    while (count < SCENES_MAX && lesson->scenes[count].name) count++;
    return count;
}

int knob_count(const Technique *technique) {
    int count = 0;
    while (count < KNOBS_MAX && technique->knob.values[count] > 0.0) count++;
    return technique->knob.name ? count : 1;
}

int scene_samples(const Scene *scene) { return scene->samples ? scene->samples : SAMPLES; }

static double first_number(double a, double b, double c) { return !isnan(a) ? a : !isnan(b) ? b : c; }

double options_scale(const Options *options, const Image *height) {
    double scale = first_number(options->scale, height->scale, 0.1);
    if (!(scale >= 0.0 && scale <= SCALE_MAX))
        fail("%s: its scale is %g texture widths; 0 to %d can be drawn", options->height, scale, SCALE_MAX);
    return scale;
}

/* ---- --list ---- */

static void list_camera(const char *role, const char *name, const Camera *c) {
    printf("  %s %s %s eye %.17g %.17g %.17g target %.17g %.17g %.17g up %.17g %.17g %.17g ", role, name,
           c->fov_y_degrees > 0.0 ? "perspective" : "orthographic", c->eye.x, c->eye.y, c->eye.z, c->target.x,
           c->target.y, c->target.z, c->up.x, c->up.y, c->up.z);
    if (c->fov_y_degrees > 0.0)
        printf("fov_y_degrees %.17g", c->fov_y_degrees);
    else
        printf("height %.17g", c->height);
    printf(" near %.17g far %.17g\n", c->near, c->far);
}

static void list_asset(const char *role, const char *chosen, const char *name) {
    if (name && chosen) printf("  %s %s\n", role, chosen);
    if (name && *name && !chosen) printf("  %s %s/build/assets/%s\n", role, project_folder(), name);
}

/* The scale that the scene will have, from --scale or the height's file, which is all that is read of it
 * here. */
static void list_scale(const Scene *scene, const Options *options) {
    if (!scene->height) return;
    char *path =
        options->height ? text("%s", options->height) : project_path("build/assets/%s", scene->height);
    Image height = image_load(path, IMAGE_HEIGHT);
    Options complete = {.height = path, .scale = options->scale};
    printf("  scale %.17g texture widths\n", options_scale(&complete, &height));
    if (!isnan(height.base)) printf("  base_of_file %.17g\n", height.base);
    image_destroy(&height);
    free(path);
}

static void list_scene(const Scene *scene, const Options *options) {
    printf("scene %s: %s\n", scene->name, scene->what);
    list_asset("colour", options->colour, scene->colour);
    list_asset("height", options->height, scene->height);
    for (int i = 0; i < 2; i++) list_asset("image", NULL, scene->other[i]);
    list_scale(scene, options);
    printf("  background %.17g %.17g %.17g linear\n", scene->background.x, scene->background.y,
           scene->background.z);
    for (int i = 0; i < FACTS_MAX && scene->facts[i].name; i++)
        printf("  fact %s %.17g %s\n", scene->facts[i].name, scene->facts[i].value, scene->facts[i].unit);
    if (scene->list) scene->list(scene);
    for (int i = 0; i < technique_count(scene); i++) {
        const Technique *technique = &scene->techniques[i];
        printf("  technique %s: %s\n", technique->name, technique->what);
        if (!technique->knob.name) continue;
        printf("    knob %s", technique->knob.name);
        for (int k = 0; k < knob_count(technique); k++) printf(" %g", technique->knob.values[k]);
        putchar('\n');
    }
    for (int i = 0; i < view_count(scene); i++)
        list_camera("view", scene->views[i].name, &scene->views[i].camera);
    for (int i = 0; i < 2 && scene->path[0].far > 0.0; i++)
        list_camera("path", i ? "to" : "from", &scene->path[i]);
}

static void list(const Lesson *lesson, const Options *options, const Choice *choice) {
    printf("lesson %s: %s\n", lesson->name, lesson->title);
    printf("size %d %d pixels\n", choice->width, choice->height);
    for (int i = 0; i < scene_count(lesson); i++)
        if (!choice->scene || !strcmp(choice->scene, lesson->scenes[i].name))
            list_scene(&lesson->scenes[i], options);
}

/* ---- The command line ---- */

/* The size of pictures without --size. */
static Choice lesson_size(const Lesson *lesson) {
    return lesson->width ? (Choice){.width = lesson->width, .height = lesson->height}
                         : (Choice){.width = 640, .height = 480};
}

static void print_help(const Lesson *lesson) {
    printf("%s: %s\n\n"
           "%s                      a window; H there lists its keys\n"
           "   --list                scenes, techniques, knobs, views; cameras, sizes, scales to 17 digits\n"
           "   --render DIR          every picture: DIR/SCENE-VIEW-TECHNIQUE[-KNOB].exr and .png\n"
           "   --truth DIR           the exact ones: DIR/SCENE-VIEW-truth.exr and .png\n"
           "   --errors DIR          the differences: DIR/SCENE-VIEW-TECHNIQUE[-KNOB]-error.png\n"
           "   --measure FILE.csv    the table of speed and error; its curves in FILE-curves.csv\n"
           "   --only FILE.csv       measure only the rows that it names, as an expect.csv does\n"
           "   --brief               measure extra views, but picture and time the main ones alone\n"
           "   --scene S --technique T --knob K --view V\n"
           "                         narrow those, or set the window's first state; a view may be a camera:\n"
           "                         EX,EY,EZ,TX,TY,TZ,F (eye, target, vertical angle in degrees); F may be\n"
           "                         Ho (orthographic: the height that it shows), and ,UX,UY,UZ (up) follow\n"
           "   --size WxH            pixels, 1 to %d a side; %dx%d without it\n"
           "   --colour FILE --height FILE --scale X\n"
           "                         your own images; the height's range in texture widths, 0 to %d\n"
           "   --help                this\n",
           lesson->name, lesson->title, program_invocation_name, IMAGE_SIDE_MAX, lesson_size(lesson).width,
           lesson_size(lesson).height, SCALE_MAX);
}

static double parse_number(const char *option, const char *argument, double least, double most) {
    char *end;
    errno = 0;
    double value = strtod(argument, &end);
    if (end == argument || *end || errno || !(value >= least && value <= most))
        fail_usage("%s %s: expected a number from %g to %g", option, argument, least, most);
    return value;
}

static int parse_side(const char *argument, const char *digits, char **end) {
    errno = 0;
    long value = digits[0] >= '0' && digits[0] <= '9' ? strtol(digits, end, 10) : 0;
    if (value < 1 || value > IMAGE_SIDE_MAX || errno)
        fail_usage("--size %s: expected WIDTHxHEIGHT, each from 1 to %d", argument, IMAGE_SIDE_MAX);
    return (int)value;
}

static void parse_size(const char *argument, Choice *choice) {
    char *end = NULL;
    choice->width = parse_side(argument, argument, &end);
    if (*end != 'x') fail_usage("--size %s: expected WIDTHxHEIGHT", argument);
    choice->height = parse_side(argument, end + 1, &end);
    if (*end) fail_usage("--size %s: expected WIDTHxHEIGHT", argument);
}

/* Every name on the command line must be that of something in a scene that is left. */
static void check_choice(const Lesson *lesson, const Options *options, Choice *choice) {
    static View custom = {.name = "camera"};
    bool scene_found = false, technique_found = false, view_found = false, colour_found = false;
    bool height_found = false, knob_found = false;
    if (choice->view && command_camera(choice->view, &custom.camera)) choice->custom = &custom;
    for (int i = 0; i < scene_count(lesson); i++) {
        const Scene *scene = &lesson->scenes[i];
        if (choice->scene && strcmp(choice->scene, scene->name)) continue;
        scene_found = true;
        colour_found = colour_found || scene->colour;
        height_found = height_found || scene->height;
        for (int k = 0; k < technique_count(scene); k++) {
            if (choice->technique && strcmp(choice->technique, scene->techniques[k].name)) continue;
            technique_found = true;
            knob_found = knob_found || scene->techniques[k].knob.name;
        }
        for (int k = 0; k < view_count(scene); k++)
            view_found = view_found || (choice->view && !strcmp(choice->view, scene->views[k].name));
    }
    if (!scene_found) fail_usage("--scene %s: no such scene; --list names them", choice->scene);
    if (!technique_found)
        fail_usage("--technique %s: no such technique; --list names them", choice->technique);
    if (choice->view && strchr(choice->view, ',') && !choice->custom)
        fail_usage("--view %s: no camera: expected EX,EY,EZ,TX,TY,TZ,F of finite numbers, a target that is "
                   "not the eye, "
                   "an angle between 0 and 180 (or a height, Ho), and an up not along the view",
                   choice->view);
    if (choice->view && !view_found && !choice->custom)
        fail_usage("--view %s: no such view; --list names them", choice->view);
    if (choice->knob > 0.0 && !knob_found)
        fail_usage("--knob %g: no technique chosen has a knob", choice->knob);
    if (options->colour && !colour_found) fail_usage("--colour: no scene chosen takes one");
    if (options->height && !height_found) fail_usage("--height: no scene chosen takes one");
    if (!isnan(options->scale) && !height_found) fail_usage("--scale: no scene chosen has a height map");
}

/* Makes a folder and those above it. */
static void make_folder(const char *path) {
    char *copy = text("%s", path);
    for (char *slash = copy + 1; (slash = strchr(slash, '/')); slash++) {
        *slash = '\0';
        mkdir(copy, 0777); /* what fails here fails below, with a reason */
        *slash = '/';
    }
    free(copy);
    struct stat status;
    if (mkdir(path, 0777) != 0 && errno != EEXIST) fail("%s: %s", path, strerror(errno));
    if (stat(path, &status) != 0) fail("%s: %s", path, strerror(errno));
    if (!S_ISDIR(status.st_mode)) fail("%s: is not a folder", path);
    if (access(path, W_OK) != 0) fail("%s: cannot be written: %s", path, strerror(errno));
}

/* Refuses a table that could not be written before minutes are spent on it: by writing an empty one beside
 * it, and by looking at what is there, for a device would be replaced by a file. */
static void check_writable(const char *path) {
    char *folder = text("%s", path), *slash = strrchr(folder, '/');
    if (slash) *slash = '\0';
    if (slash && slash != folder) make_folder(folder);
    free(folder);
    struct stat status;
    if (stat(path, &status) == 0 && !S_ISREG(status.st_mode)) fail("%s: is no file", path);
    char *partial = text("%s.partial", path);
    FILE *file = fopen(partial, "wb");
    if (!file) fail("%s: cannot be written: %s", path, strerror(errno));
    fclose(file);
    remove(partial);
    free(partial);
}

/* What the user gave must at least be there, whatever is done then. */
static void check_readable(const char *path) {
    if (path && access(path, R_OK) != 0) fail("%s: %s", path, strerror(errno));
}

/* What was printed must have arrived, as on a full disk it has not. */
static int finish_printing(void) {
    if (fflush(stdout) != 0 || ferror(stdout)) fail("standard output: %s", strerror(errno));
    return 0;
}

/* The letters are only these options' names in the switch below; there are no short ones. */
static const struct option long_options[] = {
    {"list", no_argument, NULL, 'l'},
    {"render", required_argument, NULL, 'r'},
    {"truth", required_argument, NULL, 't'},
    {"errors", required_argument, NULL, 'e'},
    {"measure", required_argument, NULL, 'm'},
    {"only", required_argument, NULL, 'o'},
    {"scene", required_argument, NULL, 'S'},
    {"technique", required_argument, NULL, 'T'},
    {"knob", required_argument, NULL, 'K'},
    {"view", required_argument, NULL, 'V'},
    {"size", required_argument, NULL, 'W'},
    {"colour", required_argument, NULL, 'C'},
    {"height", required_argument, NULL, 'H'},
    {"scale", required_argument, NULL, 'X'},
    {"brief", no_argument, NULL, 'b'},
    {"help", no_argument, NULL, 'h'},
    {0},
};

int lesson_run(const Lesson *lesson, int argc, char **argv) {
    Options options = {.scale = NAN};
    Choice choice = lesson_size(lesson);
    Orders orders = {0};
    const char *only = NULL;
    bool listing = false, sized = false;
    opterr = 0; /* the messages are ours */
    for (int option; (option = getopt_long(argc, argv, ":", long_options, NULL)) != -1;) {
        switch (option) {
        case 'l': listing = true; break;
        case 'r': orders.render = optarg; break;
        case 't': orders.truth = optarg; break;
        case 'e': orders.errors = optarg; break;
        case 'm':
            if (!*optarg) fail_usage("--measure: needs a file's name");
            orders.measure = optarg;
            break;
        case 'o': only = optarg; break;
        case 'S': choice.scene = optarg; break;
        case 'T': choice.technique = optarg; break;
        case 'K': choice.knob = parse_number("--knob", optarg, 1e-6, 1e6); break;
        case 'V': choice.view = optarg; break;
        case 'W':
            parse_size(optarg, &choice);
            sized = true;
            break;
        case 'C': options.colour = optarg; break;
        case 'H': options.height = optarg; break;
        case 'X': options.scale = parse_number("--scale", optarg, 0.0, SCALE_MAX); break;
        case 'b': choice.brief = true; break;
        case 'h': print_help(lesson); return finish_printing();
        case ':': fail_usage("%s: needs a value; --help lists the options", argv[optind - 1]);
        default: fail_usage("%s: no such option; --help lists them", argv[optind - 1]);
        }
    }
    if (optind < argc) fail_usage("%s: nothing is expected here; --help lists the options", argv[optind]);
    check_choice(lesson, &options, &choice);
    check_readable(options.colour);
    check_readable(options.height);
    if (listing) {
        list(lesson, &options, &choice);
        return finish_printing();
    }
    const char *const folders[] = {orders.render, orders.truth, orders.errors};
    bool making = orders.measure != NULL;
    for (int i = 0; i < 3; i++) {
        if (folders[i]) make_folder(folders[i]);
        making = making || folders[i];
    }
    if (orders.measure) check_writable(orders.measure);
    if (!making) {
        if (!sized) choice.width = 640, choice.height = 480; /* small pictures' letters need more room */
        window_run(lesson, &options, &choice);
        return 0;
    }
    Only *rows = only ? only_load(only) : NULL;
    choice.only = rows;
    Context *context = context_offscreen();
    measure_all(lesson, &options, &choice, &orders);
    only_destroy(rows);
    context_destroy(context);
    return 0;
}
