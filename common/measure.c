#include "measure.h"

#include "clock.h"
#include "compare.h"
#include "fail.h"
#include "reference.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { ROUNDS_MIN = 3, ROUNDS = 7, ROUNDS_MAX = 41, PATH_FRAMES = 16 };
static const double SPEED_SECONDS = 0.5; /* after which no round more than ROUNDS is begun, */
static const double SLOW_SECONDS = 1.5;  /* and none more than ROUNDS_MIN */

/* One technique with one value of its knob. */
typedef struct {
    const Technique *technique;
    double knob;
    bool wanted; /* chosen, and not only here because costs are held against it */
} Variant;

enum { VARIANTS_MAX = TECHNIQUES_MAX * KNOBS_MAX };

typedef struct {
    Stage stage;
    const Choice *choice;
    const Orders *orders;
    Table *table;
    Variant variants[VARIANTS_MAX];
    int variant_count;
    Reference references[VIEWS_MAX];
    int view_count;
    double pixels_drawn[VARIANTS_MAX][VIEWS_MAX];
} Session;

/* ---- Progress ---- */

static struct {
    int done, total;
    double start, said;
} progress;

static double seconds_since(double then) { return clock_seconds() - then; }

static void progress_step(const Lesson *lesson, const char *what) {
    progress.done++;
    bool last = progress.done >= progress.total;
    if (!last && seconds_since(progress.said) < 2.0) return;
    progress.said = clock_seconds();
    double elapsed = seconds_since(progress.start);
    fprintf(stderr, "%s: %d of %d (%s), about %.0f s left\n", lesson->name, progress.done, progress.total,
            what, elapsed / progress.done * (progress.total - progress.done));
}

/* ---- Files ---- */

static void save_picture(const Image *image, const char *folder, const char *name, const char *suffix,
                         bool exr) {
    char *png = text("%s/%s%s.png", folder, name, suffix),
         *floats = text("%s/%s%s.exr", folder, name, suffix);
    image_save(image, png);
    if (exr) image_save(image, floats);
    free(png);
    free(floats);
}

char *picture_name(const Frame *frame) {
    char *name = text("%s-%s-%s", frame->scene->name, frame->view->name, frame->technique->name);
    if (!frame->technique->knob.name) return name;
    char *longer = text("%s-%g", name, frame->knob);
    free(name);
    return longer;
}

/* Whether a view gets pictures and times. */
static bool is_shown(const Choice *choice, const View *view) {
    return !view->extra || !choice->brief || choice->view;
}

/* ---- The references ---- */

static Frame frame_of(const Session *session, const Variant *variant, const View *view) {
    return stage_frame(&session->stage, variant->technique, variant->knob, view, session->choice->width,
                       session->choice->height);
}

/* How exact the exact pictures are that were asked for. */
static void report_reference(Session *session, const Reference *reference) {
    static const char *const metrics[] = {"truth_rmse", "truth_rmse_gaussian"};
    table_set(session->table, session->stage.scene->name, "truth", 0);
    for (int filter = 0; filter < 2; filter++)
        if (reference->exact[filter].image.pixels)
            table_row(session->table, reference->view->name, metrics[filter], reference->exact[filter].rmse,
                      "linear");
}

static void save_reference(const Session *session, Reference *reference) {
    char *name = text("%s-%s", session->stage.scene->name, reference->view->name);
    save_picture(&reference_exact(reference, FILTER_BOX)->image, session->orders->truth, name, "-truth",
                 true);
    free(name);
}

/* ---- Error ---- */

/* Where the truth knows nothing the picture is made equal to it, so that no error arises there; the means are
 * then taken over what is known alone. */
static void hide_unknown(Image *picture, const Image *exact, const Sample *centres) {
    size_t count = (size_t)picture->width * picture->height;
    for (size_t i = 0; i < count; i++)
        if (centres[i].unknown) memcpy(picture->pixels + 3 * i, exact->pixels + 3 * i, 3 * sizeof(float));
}

/* Whether the table should have such a row. */
static bool wants_row(const Session *session, const Variant *variant, const char *view, const char *metric) {
    return session->orders->measure && only_wants(session->choice->only, session->stage.scene->name,
                                                  variant->technique->name, variant->knob, view, metric);
}

static void report_difference(Session *session, const Variant *variant, Image *picture, Reference *reference,
                              PixelFilter filter) {
    static const char *const names[2][4] = {
        {"rmse", "psnr_db", "max_abs", "flip"},
        {"rmse_gaussian", "psnr_db_gaussian", "max_abs_gaussian", "flip_gaussian"}};
    static const char *const units[] = {"linear", "dB", "linear", "1"};
    const Scene *scene = session->stage.scene;
    const char *view = reference->view->name, *errors = NULL;
    if (scene->brief_extras && !is_shown(session->choice, reference->view)) return;
    if (filter == FILTER_BOX && is_shown(session->choice, reference->view)) errors = session->orders->errors;
    bool wanted[4], any = errors != NULL;
    for (int i = 0; i < 4; i++) {
        wanted[i] = wants_row(session, variant, view, names[filter][i]);
        if (i == 3)
            wanted[i] = wanted[i] && is_shown(session->choice, reference->view); /* it takes longest */
        any = any || wanted[i];
    }
    if (!any) return;
    const Image *exact = &reference_exact(reference, filter)->image;
    Frame frame = frame_of(session, variant, reference->view);
    char *name = picture_name(&frame);
    Difference difference;
    Image map = {0};
    reference_look(reference);
    double share = reference->known_share;
    if (share < 1.0) hide_unknown(picture, exact, reference->centres);
    bool mapping = errors || wanted[3];
    const char *reason = compare_seen(picture, exact, mapping ? reference_seen(reference, filter) : NULL,
                                      &difference, mapping ? &map : NULL);
    if (reason) fail("%s/%s: %s", scene->name, name, reason);
    const double values[] = {difference.rmse / sqrt(share),
                             fmin(100.0, difference.psnr_db + 10.0 * log10(share)), difference.max_abs,
                             difference.flip / share};
    for (int i = 0; i < 4; i++)
        if (wanted[i]) table_row(session->table, view, names[filter][i], values[i], units[i]);
    if (errors) {
        Image heat = compare_heat(&map);
        save_picture(&heat, errors, name, "-error", false);
        image_destroy(&heat);
    }
    image_destroy(&map);
    free(name);
}

/* The distance in texels between what was looked up and what should have been, over the pixels whose centre
 * both say is hit. */
static void report_lookup(Session *session, const Frame *frame, const Picture *picture,
                          const Reference *reference) {
    Vec2 texels = frame->scene->texels(frame->data);
    size_t count = (size_t)frame->width * frame->height, both = 0, mismatch = 0, known = 0;
    double sum = 0.0, largest = 0.0, depth_sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        const float *lookup = picture->lookup.pixels + 4 * i;
        const Sample *exact = &reference->centres[i];
        if (exact->unknown) continue;
        known++;
        mismatch += exact->hit != (lookup[3] > 0.5f);
        if (!exact->hit || lookup[3] <= 0.5f) continue;
        double du = ((double)lookup[0] - exact->u) * texels.x, dv = ((double)lookup[1] - exact->v) * texels.y;
        both++;
        sum += du * du + dv * dv;
        largest = fmax(largest, du * du + dv * dv);
        depth_sum += (lookup[2] - exact->depth) * (lookup[2] - exact->depth);
    }
    if (!both)
        fail("%s/%s: no pixel of the picture looks anything up that the truth hits", frame->scene->name,
             frame->technique->name);
    const char *view = frame->view->name;
    table_row(session->table, view, "uv_error_texels_rms", sqrt(sum / (double)both), "texels");
    table_row(session->table, view, "uv_error_texels_max", sqrt(largest), "texels");
    table_row(session->table, view, "depth_error_rms", sqrt(depth_sum / (double)both), "world units");
    table_row(session->table, view, "coverage_error_percent", 100.0 * (double)mismatch / (double)known, "%");
}

static double count_hits(const Image *lookup) {
    size_t count = (size_t)lookup->width * lookup->height, hits = 0;
    for (size_t i = 0; i < count; i++) hits += lookup->pixels[4 * i + 3] > 0.5f;
    return hits ? (double)hits : (double)count;
}

/* One variant from all views: pictures, their errors, and the scene's own metrics. */
static void measure_errors(Session *session, int v) {
    const Variant *variant = &session->variants[v];
    const Scene *scene = session->stage.scene;
    Shot shots[VIEWS_MAX];
    Frame first = frame_of(session, variant, session->references[0].view);
    bool measuring = session->table != NULL; /* else only colours are needed, and one picture at a time */
    if (measuring) table_set(session->table, scene->name, variant->technique->name, variant->knob);
    for (int i = 0; i < session->view_count; i++) {
        Reference *reference = &session->references[i];
        Frame frame = frame_of(session, variant, reference->view);
        Picture picture = picture_create(frame.width, frame.height, measuring);
        stage_draw(&session->stage, &frame, &picture);
        if (measuring) {
            session->pixels_drawn[v][i] = count_hits(&picture.lookup);
            reference_look(reference);
        }
        if (session->orders->render && is_shown(session->choice, reference->view)) {
            char *name = picture_name(&frame);
            save_picture(&picture.colour, session->orders->render, name, "", true);
            free(name);
        }
        if (measuring && scene->texels) report_lookup(session, &frame, &picture, reference);
        report_difference(session, variant, &picture.colour, reference, FILTER_BOX);
        if (scene->gaussian) report_difference(session, variant, &picture.colour, reference, FILTER_GAUSSIAN);
        if (measuring)
            shots[i] = (Shot){reference->view, picture, reference->centres, reference};
        else
            picture_destroy(&picture);
        progress_step(session->stage.lesson, scene->name);
    }
    if (!measuring) return;
    if (scene->measure)
        scene->measure(&(Shots){&first, shots, session->view_count, session->choice->only, &session->stage},
                       session->table);
    for (int i = 0; i < session->view_count; i++) picture_destroy(&shots[i].picture);
}

/* ---- Flicker ---- */

static bool wants_flicker(const Session *session, const Variant *variant) {
    return session->stage.scene->path[0].far > 0.0 && wants_row(session, variant, "-", "flicker");
}

/* The variants that a row is wanted of, in their order; how many. */
static int choose_for_flicker(const Session *session, const Variant *chosen[VARIANTS_MAX]) {
    int count = 0;
    for (int v = 0; v < session->variant_count; v++)
        if (session->variants[v].wanted && wants_flicker(session, &session->variants[v]))
            chosen[count++] = &session->variants[v];
    return count;
}

/* The change of (picture - exact) from one frame of the path to the next, summed over all of them. The
 * path is drawn at half the size; the noise of the truth, the same at a pixel in every frame, mostly cancels.
 */
static void measure_flicker(Session *session) {
    const Variant *variants[VARIANTS_MAX];
    int variant_count = choose_for_flicker(session, variants);
    if (!variant_count) return;
    const Scene *scene = session->stage.scene;
    int width = (session->choice->width + 1) / 2, height = (session->choice->height + 1) / 2;
    size_t count = (size_t)width * height * 3;
    View view = {.name = "path"};
    double sums[VARIANTS_MAX] = {0};
    Picture picture = picture_create(width, height, false);
    float *before = allocate(count * (size_t)variant_count, sizeof(float));
    for (int k = 0; k < PATH_FRAMES; k++) {
        view.camera = camera_mix(&scene->path[0], &scene->path[1], k / (PATH_FRAMES - 1.0));
        Exact exact = truth_render(&session->stage.truth, &view.camera, width, height, scene_samples(scene),
                                   FILTER_BOX);
        for (int v = 0; v < variant_count; v++) {
            Frame frame =
                stage_frame(&session->stage, variants[v]->technique, variants[v]->knob, &view, width, height);
            stage_draw(&session->stage, &frame, &picture);
            float *last = before + count * (size_t)v;
            for (size_t i = 0; i < count; i++) {
                float error = picture.colour.pixels[i] - exact.image.pixels[i], change = error - last[i];
                if (k > 0) sums[v] += (double)change * change;
                last[i] = error;
            }
        }
        image_destroy(&exact.image);
        progress_step(session->stage.lesson, "flicker");
    }
    for (int v = 0; v < variant_count; v++) {
        table_set(session->table, scene->name, variants[v]->technique->name, variants[v]->knob);
        table_row(session->table, "-", "flicker", sqrt(sums[v] / ((PATH_FRAMES - 1.0) * (double)count)),
                  "linear");
    }
    free(before);
    picture_destroy(&picture);
}

/* ---- Speed ---- */

static bool wants_cost(const Session *session, const Variant *variant, const char *view) {
    return wants_row(session, variant, view, "ns_per_pixel") ||
           wants_row(session, variant, view, "cost_ratio") ||
           wants_row(session, variant, view, "prepare_ns_per_pixel");
}

/* The variants whose cost is wanted, behind the one that costs are held against; how many, 0 if it stands
 * alone. */
static int choose_for_speed(const Session *session, const char *view, int chosen[VARIANTS_MAX]) {
    int count = 0;
    chosen[count++] = 0;
    for (int v = 1; v < session->variant_count; v++)
        if (wants_cost(session, &session->variants[v], view)) chosen[count++] = v;
    return count > 1 || wants_cost(session, &session->variants[0], view) ? count : 0;
}

typedef struct {
    double draw_ns[ROUNDS_MAX], ratio[ROUNDS_MAX], prepare_ns[ROUNDS_MAX];
} Timing;

static int by_size(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void report_timing(Session *session, int v, int view_index, Timing *timing, int rounds) {
    const Variant *variant = &session->variants[v];
    const char *view = session->references[view_index].view->name;
    double pixels = session->pixels_drawn[v][view_index];
    qsort(timing->draw_ns, rounds, sizeof(double), by_size);
    qsort(timing->ratio, rounds, sizeof(double), by_size);
    qsort(timing->prepare_ns, rounds, sizeof(double), by_size);
    table_set(session->table, session->stage.scene->name, variant->technique->name, variant->knob);
    table_row(session->table, view, "ns_per_pixel", timing->draw_ns[0] / pixels, "ns");
    table_row(session->table, view, "cost_ratio", timing->ratio[rounds / 2], "1");
    if (variant->technique->prepare)
        table_row(session->table, view, "prepare_ns_per_pixel", timing->prepare_ns[0] / pixels, "ns");
}

static bool another_round(int done, double seconds) {
    return done < ROUNDS_MIN || (done < ROUNDS && seconds < SLOW_SECONDS) ||
           (done < ROUNDS_MAX && seconds < SPEED_SECONDS);
}

/* All variants from one view take turns, so that what else the machine does falls on all alike; where frames
 * are short, for more rounds. */
static void measure_speed(Session *session, int view_index) {
    const View *view = session->references[view_index].view;
    int chosen[VARIANTS_MAX], count = choose_for_speed(session, view->name, chosen);
    if (!count) return;
    Timing *timings = allocate((size_t)count, sizeof *timings);
    Picture scratch = picture_create(session->choice->width, session->choice->height, false);
    double start = clock_seconds();
    int round = -1; /* which warms up and is not counted */
    for (; another_round(round, seconds_since(start)); round++) {
        for (int i = 0; i < count; i++) {
            Frame frame = frame_of(session, &session->variants[chosen[i]], view);
            Cost cost = stage_time(&session->stage, &frame, &scratch);
            if (round < 0) continue;
            timings[i].draw_ns[round] = cost.draw_ns;
            timings[i].prepare_ns[round] = cost.prepare_ns;
            timings[i].ratio[round] = cost.draw_ns / timings[0].draw_ns[round];
        }
    }
    for (int i = 0; i < count; i++)
        if (session->variants[chosen[i]].wanted)
            report_timing(session, chosen[i], view_index, &timings[i], round);
    free(timings);
    picture_destroy(&scratch);
    progress_step(session->stage.lesson, "speed");
}

Cost shots_time(const Shots *shots, const Camera *camera) {
    View view = {.name = "-", .camera = *camera};
    Frame frame = *shots->frame;
    frame.view = &view;
    frame.camera = *camera;
    frame.looking = false;
    Picture scratch = {0}; /* only what paints in C needs one */
    if (frame.technique->paint) scratch = picture_create(frame.width, frame.height, false);
    Cost cost = stage_time(shots->stage, &frame, &scratch);
    picture_destroy(&scratch);
    return cost;
}

/* ---- All of it ---- */

static bool chosen(const char *choice, const char *name) { return !choice || strcmp(choice, name) == 0; }

static bool scene_chosen(const Choice *choice, const Scene *scene) {
    return chosen(choice->scene, scene->name) &&
           only_wants(choice->only, scene->name, NULL, ONLY_ANY_KNOB, NULL, NULL);
}

static void choose_variants(Session *session) {
    const Scene *scene = session->stage.scene;
    const Choice *choice = session->choice;
    for (int t = 0; t < technique_count(scene); t++) {
        const Technique *technique = &scene->techniques[t];
        bool one_knob = choice->knob > 0.0 && technique->knob.name; /* of the list or not */
        for (int k = 0; k < (one_knob ? 1 : knob_count(technique)); k++) {
            double knob = one_knob ? choice->knob : technique->knob.values[k];
            bool wanted = chosen(choice->technique, technique->name) &&
                          only_wants(choice->only, scene->name, technique->name, knob, NULL, NULL);
            if (wanted || (t == 0 && k == 0)) /* costs are held against the first */
                session->variants[session->variant_count++] = (Variant){technique, knob, wanted};
        }
    }
}

static int choose_views(const Scene *scene, const Choice *choice, const View *views[VIEWS_MAX]) {
    if (choice->custom) {
        views[0] = choice->custom;
        return 1;
    }
    int count = 0;
    for (int i = 0; i < view_count(scene); i++) {
        const View *view = &scene->views[i];
        bool wanted = view->extra /* too many to be meant by a "-" */
                          ? only_names_view(choice->only, scene->name, view->name)
                          : only_wants(choice->only, scene->name, NULL, ONLY_ANY_KNOB, view->name, NULL);
        if (wanted && chosen(choice->view, view->name)) views[count++] = view;
    }
    return count;
}

static void measure_scene(Session *session) {
    const Scene *scene = session->stage.scene;
    const Orders *orders = session->orders;
    const View *views[VIEWS_MAX];
    session->view_count = choose_views(scene, session->choice, views);
    if (!session->view_count) return;
    choose_variants(session);
    for (int i = 0; i < session->view_count; i++) {
        session->references[i] = reference_create(&session->stage.truth, views[i], session->choice->width,
                                                  session->choice->height, scene_samples(scene));
        if (orders->truth && is_shown(session->choice, views[i]))
            save_reference(session, &session->references[i]);
        progress_step(session->stage.lesson, "truth");
    }
    if (orders->render || orders->errors || orders->measure)
        for (int v = 0; v < session->variant_count; v++)
            if (session->variants[v].wanted) measure_errors(session, v);
    if (!orders->measure) return;
    measure_flicker(session);
    for (int i = 0; i < session->view_count; i++)
        if (is_shown(session->choice, views[i])) measure_speed(session, i);
    for (int i = 0; i < session->view_count; i++) report_reference(session, &session->references[i]);
}

/* The steps that progress_step will be called for, of one scene. */
static int count_steps(const Scene *scene, const Choice *choice, const Orders *orders) {
    const View *views[VIEWS_MAX];
    Session session = {.stage = {.scene = scene}, .choice = choice, .orders = orders};
    choose_variants(&session);
    int view_count = choose_views(scene, choice, views), wanted = 0, steps = view_count;
    for (int v = 0; v < session.variant_count; v++) wanted += session.variants[v].wanted;
    if (!wanted) return 0;
    if (orders->render || orders->errors || orders->measure) steps += view_count * wanted;
    const Variant *flickering[VARIANTS_MAX];
    int timed[VARIANTS_MAX];
    if (choose_for_flicker(&session, flickering)) steps += PATH_FRAMES;
    for (int i = 0; i < view_count; i++)
        steps += is_shown(choice, views[i]) && choose_for_speed(&session, views[i]->name, timed) > 0;
    return steps;
}

void measure_all(const Lesson *lesson, const Options *options, const Choice *choice, const Orders *orders) {
    progress.start = clock_seconds();
    progress.said = progress.start;
    progress.done = progress.total = 0;
    for (int i = 0; i < scene_count(lesson); i++)
        if (scene_chosen(choice, &lesson->scenes[i]))
            progress.total += count_steps(&lesson->scenes[i], choice, orders);
    if (!progress.total) fail_usage("nothing is chosen: no scene has all that was asked for");
    Table *table = orders->measure ? table_create(lesson->name) : NULL;
    for (int i = 0; i < scene_count(lesson); i++) {
        if (!scene_chosen(choice, &lesson->scenes[i])) continue;
        if (!count_steps(&lesson->scenes[i], choice, orders)) continue;
        Session *session = allocate(1, sizeof *session);
        session->stage = stage_open(lesson, &lesson->scenes[i], options);
        session->choice = choice;
        session->orders = orders;
        session->table = table;
        measure_scene(session);
        for (int k = 0; k < session->view_count; k++) reference_destroy(&session->references[k]);
        stage_close(&session->stage);
        free(session);
    }
    if (table) {
        table_save(table, orders->measure);
        table_destroy(table);
    }
}
