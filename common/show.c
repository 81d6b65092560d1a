#include "show.h"

#include "clock.h"
#include "fail.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double REST = 0.3;    /* seconds without a change, after which the error is sought */
static const double GLANCE = 0.25; /* seconds between two looks at the shaders' files */

enum { FRAMES_WANTED = 9 }; /* for the time of a frame */

static void drop(Texture *texture) {
    if (texture->id) texture_destroy(texture);
}

const Technique *show_chosen(const Show *show) { return &show->stage.scene->techniques[show->technique]; }

/* ---- What changes, and what is then out of date ---- */

static void picture_changed(Show *show) {
    refiner_judge(show->refiner, (Image){0});
    drop(&show->heat);
    show->refined.judged = 0;
    show->refined.reason[0] = '\0';
    show->drawn = show->given = false;
    show->changed = true;
    show->changed_at = clock_seconds();
}

static void technique_changed(Show *show) { /* or its shader or knob: a frame may take another time */
    picture_changed(show);
    show->frames = 0;
    show->spent = 0.0;
}

static void camera_changed(Show *show) {
    picture_changed(show);
    refiner_want(show->refiner, NULL, 0, 0);
    show->refined.rays = 0;
    show->wanted = false;
}

void show_moved(Show *show) {
    show->moved = true;
    camera_changed(show);
}

void show_size(Show *show, int width, int height) {
    if (width == show->width && height == show->height) return;
    show->width = width;
    show->height = height;
    camera_changed(show);
    technique_changed(show);
}

void show_technique(Show *show, int index) {
    show->technique = index;
    technique_changed(show);
}

void show_knob(Show *show, bool up) {
    const Technique *technique = show_chosen(show);
    double *knob = &show->knobs[show->technique], next = *knob;
    for (int i = 0; technique->knob.name && i < knob_count(technique); i++) {
        double value = technique->knob.values[i];
        bool beyond = up ? value > *knob : value < *knob;
        if (beyond && (next == *knob || fabs(value - *knob) < fabs(next - *knob))) next = value;
    }
    *knob = next;
    technique_changed(show);
}

static void refiner_anew(Show *show) {
    if (show->refiner) refiner_destroy(show->refiner);
    show->refiner = refiner_create(&show->stage.truth, scene_samples(show->stage.scene), show->wake);
}

void show_motion(Show *show) {
    if (!show->stage.scene->move) return;
    show->moving = !show->moving;
    show->moved_until = clock_seconds();
    refiner_anew(show); /* its thread reads the scene: it must have ended before that changes */
    camera_changed(show);
    drop(&show->exact);
}

static void move(Show *show) {
    double time = clock_seconds();
    show->seconds += time - show->moved_until;
    show->moved_until = time;
    show->stage.scene->move(show->stage.data, show->seconds);
    picture_changed(show);
}

static void set_view(Show *show, const View *view) {
    show->start = view;
    show->camera = view->camera;
    show->moved = false;
    camera_changed(show);
}

/* ---- Scenes ---- */

static int find_technique(const Scene *scene, const char *name) {
    for (int i = 0; name && i < technique_count(scene); i++)
        if (strcmp(scene->techniques[i].name, name) == 0) return i;
    return -1;
}

static int find_view(const Scene *scene, const char *name) {
    for (int i = 0; name && i < view_count(scene); i++)
        if (strcmp(scene->views[i].name, name) == 0) return i;
    return -1;
}

static void close_scene(Show *show) {
    refiner_destroy(show->refiner); /* its thread reads the scene */
    show->refiner = NULL;
    stage_close(&show->stage);
    drop(&show->exact);
    drop(&show->heat);
    show->picture = &show->nothing;
}

/* The scene, with the technique and the view of those names if it has them, else with its first. */
static void open_scene(Show *show, const Scene *scene, const char *technique, const char *view) {
    show->stage = stage_open(show->lesson, scene, show->options);
    show->moving = false;
    show->seconds = 0.0;
    refiner_anew(show);
    for (int i = 0; i < technique_count(scene); i++)
        show->knobs[i] = scene->techniques[i].knob.name ? scene->techniques[i].knob.values[0] : 0.0;
    int same_technique = find_technique(scene, technique), same_view = find_view(scene, view);
    set_view(show, &scene->views[same_view < 0 ? 0 : same_view]);
    show_technique(show, same_technique < 0 ? 0 : same_technique);
}

void show_next_scene(Show *show) {
    const char *technique = show_chosen(show)->name, *view = show->start->name;
    int next = (int)(show->stage.scene - show->lesson->scenes + 1) % scene_count(show->lesson);
    close_scene(show);
    open_scene(show, &show->lesson->scenes[next], technique, view);
}

void show_next_view(Show *show) {
    const Scene *scene = show->stage.scene;
    set_view(show, &scene->views[(find_view(scene, show->start->name) + 1) % view_count(scene)]);
}

void show_open(Show *show, const Lesson *lesson, const Options *options, const Choice *choice,
               void (*wake)(void)) {
    const Scene *scene = NULL; /* the first that has all that was chosen */
    for (int i = 0; i < scene_count(lesson) && !scene; i++) {
        const Scene *one = &lesson->scenes[i];
        bool fits = !choice->scene || strcmp(choice->scene, one->name) == 0;
        fits = fits && (!choice->technique || find_technique(one, choice->technique) >= 0);
        fits = fits && (!choice->view || choice->custom || find_view(one, choice->view) >= 0);
        if (fits) scene = one;
    }
    if (!scene) fail_usage("no scene has both --technique %s and --view %s", choice->technique, choice->view);
    *show = (Show){.lesson = lesson, .options = options, .wake = wake, .picture = &show->nothing};
    Image black = image_create(1, 1, 1);
    show->nothing = texture_create(&black, 1, TEXTURE_FLOAT, TEXTURE_NEAREST);
    image_destroy(&black);
    open_scene(show, scene, choice->technique, choice->view);
    for (int i = 0; choice->knob > 0.0 && i < technique_count(scene); i++)
        if (scene->techniques[i].knob.name) show->knobs[i] = choice->knob;
    if (!choice->custom) return;
    set_view(show, choice->custom);
    show->moved = true;
}

void show_close(Show *show) {
    close_scene(show);
    picture_destroy(&show->painted);
    drop(&show->paint);
    drop(&show->nothing);
    free(show->log);
}

/* ---- The technique's picture ---- */

Frame show_frame(const Show *show) {
    static const View camera = {.name = "camera"};
    Frame frame = stage_frame(&show->stage, show_chosen(show), show->knobs[show->technique], show->start,
                              show->width, show->height);
    frame.camera = show->camera;
    if (show->moved) frame.view = &camera;
    return frame;
}

static void reload(Show *show) {
    free(show->log);
    show->log = stage_reload(&show->stage);
    if (show->log) fprintf(stderr, "%s\n", show->log);
    technique_changed(show);
}

/* Whether the technique can be drawn: its shader may have been broken from the start. */
static bool is_built(Show *show) {
    const Program *program = &show->stage.programs[show->technique];
    if (!show_chosen(show)->fragment || program->id) return true;
    if (!show->log) reload(show);
    return program->id != 0;
}

static void draw(Show *show) {
    const Technique *technique = show_chosen(show);
    const Image *colour = &show->painted.colour;
    if (technique->paint && (colour->width != show->width || colour->height != show->height)) {
        picture_destroy(&show->painted);
        show->painted = picture_create(show->width, show->height, false);
    }
    Frame frame = show_frame(show);
    frame.view = show->start; /* a technique may ask where the camera began */
    Cost cost = stage_time(&show->stage, &frame, &show->painted);
    show->costs[show->frames++ % SHOW_FRAMES] = cost;
    show->spent += 1e-9 * (cost.prepare_ns + cost.draw_ns);
    if (technique->paint) {
        drop(&show->paint);
        show->paint = texture_create(colour, 1, TEXTURE_FLOAT, TEXTURE_NEAREST);
        show->picture = &show->paint;
    } else {
        show->target = (Texture){show->stage.plain.colour, show->width, show->height, 1}; /* the stage's */
        show->picture = &show->target;
    }
}

void show_draw(Show *show) {
    if (show->drawn) return;
    if (is_built(show)) draw(show);
    show->drawn = show->changed = true;
}

static int by_size(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

Cost show_cost(const Show *show) {
    double draws[SHOW_FRAMES], prepares[SHOW_FRAMES];
    int count = show->frames < SHOW_FRAMES ? show->frames : SHOW_FRAMES;
    if (!count) return (Cost){0};
    for (int i = 0; i < count; i++) {
        draws[i] = show->costs[i].draw_ns;
        prepares[i] = show->costs[i].prepare_ns;
    }
    qsort(draws, (size_t)count, sizeof *draws, by_size);
    qsort(prepares, (size_t)count, sizeof *prepares, by_size);
    return (Cost){prepares[count / 2], draws[count / 2]};
}

/* ---- The truth and the error ---- */

static void ask(Show *show) {
    bool rested = clock_seconds() - show->changed_at > REST;
    if (!show->wanted && (rested || show->eager)) {
        refiner_want(show->refiner, &show->camera, show->width, show->height);
        show->wanted = true;
    }
    if (show->given || !rested || !show->frames) return;
    Picture picture = picture_create(show->width, show->height, false);
    size_t count = (size_t)show->width * show->height * 3;
    if (show_chosen(show)->paint)
        memcpy(picture.colour.pixels, show->painted.colour.pixels, count * sizeof(float));
    else
        target_read(&show->stage.plain, &picture);
    refiner_judge(show->refiner, picture.colour);
    show->given = true;
}

static void keep(Texture *texture, Image *image) {
    if (!image->pixels) return;
    drop(texture);
    *texture = texture_create(image, 1, TEXTURE_FLOAT, TEXTURE_NEAREST);
    image_destroy(image);
}

static void hear(Show *show) {
    if (!refiner_news(show->refiner, &show->refined)) return;
    keep(&show->exact, &show->refined.exact);
    keep(&show->heat, &show->refined.heat);
    show->changed = true;
}

static void glance(Show *show) {
    if (show->stamp && clock_seconds() - show->glanced < GLANCE) return;
    show->glanced = clock_seconds();
    uint64_t stamp = stage_stamp(&show->stage);
    if (show->stamp && stamp != show->stamp) reload(show);
    show->stamp = stamp;
}

double show_update(Show *show) {
    glance(show);
    if (show->moving) move(show);
    show_draw(show);
    if (show->moving) return 0.0;
    bool timing = show->frames < FRAMES_WANTED && show->spent < REST / 2 && is_built(show);
    if (timing) {
        draw(show);
        show->changed = show->changed || show->frames == FRAMES_WANTED;
    } else {
        ask(show); /* only now, for the truth takes all cores */
    }
    hear(show);
    return timing ? 0.0 : show->given ? GLANCE : REST / 6;
}
