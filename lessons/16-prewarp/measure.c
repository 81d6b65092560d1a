/* The lesson's own metrics: of pictures by hits, of warped textures by judge.h, of time by pace.h. */
#include "fail.h"
#include "hits.h"
#include "judge.h"
#include "overflow.h"
#include "pace.h"
#include "two_pass.h"

#include <stdlib.h>

/* What is wrong with one way's warped texture from one view: the rms error of its colours, the rest in
 * percent. */
typedef struct {
    double holes, violations, lost, rmse, first_pass_loss;
} Figure;

/* A judge takes long to make, and is the same for all techniques: so the first that is measured from a view
 * has all of them judged. */
struct Figures {
    bool known[VIEWS_MAX];
    Figure of[VIEWS_MAX][TECHNIQUES_MAX];
};

static double first_pass_loss(const Judge *judge, const Source *source, Eye eye, Destination *destination) {
    PrewarpFactors factors = prewarp_factors(&source->plane, eye);
    float *kept = allocate((size_t)destination->width * source->height, sizeof *kept);
    warp_two_pass(source, &factors, destination, kept);
    double loss = judge_first_pass_loss_percent(judge, eye, kept);
    free(kept);
    return loss;
}

/* Where texels are kept: on the polygon's plane, and on those that stand at its edges. */
static double lost_texels(const Judge *judge, const Prewarp *prewarp, Way way, Eye eye) {
    const Source *source = &prewarp->source;
    PrewarpFactors factors = prewarp_factors(&source->plane, eye);
    Canvas canvases[1 + EDGES] = {{source->plane, judge->low, judge->high}};
    int count = 1;
    for (int edge = 0; way == AUXILIARY && edge < EDGES; edge++) {
        if (!overflow_can(&factors, overflow_displacements(source), edge)) continue;
        Auxiliary auxiliary = auxiliary_create(source, edge, false);
        canvases[count++] = (Canvas){auxiliary.plane, auxiliary.destination.low, auxiliary.destination.high};
        auxiliary_destroy(&auxiliary);
    }
    return judge_lost_texel_percent(judge, eye, canvases, count);
}

static Figure judge_way(const Judge *judge, const Prewarp *prewarp, Way way, Eye eye,
                        Destination *destination) {
    Figure figure = {0};
    if (way == TWO_PASS) figure.first_pass_loss = first_pass_loss(judge, &prewarp->source, eye, destination);
    scene_warp(prewarp, way, eye, destination);
    figure.holes = judge_hole_percent(judge, destination);
    figure.violations = judge_order_violation_percent(judge, destination);
    figure.lost = lost_texels(judge, prewarp, way, eye);
    figure.rmse = judge_rmse(judge, destination);
    return figure;
}

/* The same on a destination that has a size of its own. */
static Figure judge_resized(const Prewarp *prewarp, Eye eye) {
    const Source *source = &prewarp->source;
    PrewarpFactors factors = prewarp_factors(&source->plane, eye);
    if (!factors.possible || factors.behind) return (Figure){0};
    Destination destination = overflow_destination(source, &factors, RESIZED_LIMIT, true);
    Judge judge = judge_create(source, eye, &destination);
    Figure figure = judge_way(&judge, prewarp, RESIZED, eye, &destination);
    judge_destroy(&judge);
    destination_destroy(&destination);
    return figure;
}

static void judge_all(const Prewarp *prewarp, const Scene *scene, const View *view, Figure *figures) {
    const Source *source = &prewarp->source;
    Eye eye = scene_eye(&view->camera);
    Destination destination = destination_create(source->width, source->height, v2(0, 0), v2(1, 1), true);
    Judge judge = judge_create(source, eye, &destination);
    for (int i = 0; i < technique_count(scene); i++) {
        Way way = scene->techniques[i].variant;
        if (way == RESIZED)
            figures[i] = judge_resized(prewarp, eye);
        else if (way != PLAIN)
            figures[i] = judge_way(&judge, prewarp, way, eye, &destination);
    }
    judge_destroy(&judge);
    destination_destroy(&destination);
}

static const Figure *figure_of(const Shots *shots, int view) {
    Prewarp *prewarp = shots->frame->data;
    const Scene *scene = shots->frame->scene;
    if (!prewarp->figures) prewarp->figures = allocate(1, sizeof *prewarp->figures);
    struct Figures *figures = prewarp->figures;
    if (!figures->known[view]) judge_all(prewarp, scene, shots->shots[view].view, figures->of[view]);
    figures->known[view] = true;
    return &figures->of[view][shots->frame->technique - scene->techniques];
}

static void add_figures(const Shots *shots, int index, Table *table) {
    static const char *const names[] = {"hole_percent", "order_violation_percent", "lost_texel_percent",
                                        "texel_rmse", "first_pass_loss_percent"};
    static const char *const units[] = {"%", "%", "%", "linear", "%"};
    const View *view = shots->shots[index].view;
    bool two_pass = shots->frame->technique->variant == TWO_PASS, wanted = false;
    for (int i = 0; i < 5; i++) wanted = wanted || shots_want(shots, view, names[i]);
    if (!wanted) return;
    const Figure *figure = figure_of(shots, index);
    const double values[] = {figure->holes, figure->violations, figure->lost, figure->rmse,
                             figure->first_pass_loss};
    for (int i = 0; i < (two_pass ? 5 : 4); i++) table_add(table, shots, view, names[i], values[i], units[i]);
}

static void add_pace(const Shots *shots, int index, Table *table) {
    const Prewarp *prewarp = shots->frame->data;
    const View *view = shots->shots[index].view;
    if (view->extra || !shots_want(shots, view, "ns_per_texel")) return;
    double ns = pace_warp(prewarp, shots->frame->technique->variant, scene_eye(&view->camera));
    table_add(table, shots, view, "ns_per_texel", ns / (prewarp->source.width * prewarp->source.height),
              "ns");
}

static void add_random_pace(const Shots *shots, Table *table) {
    if (!shots_want(shots, NULL, "warps_per_second") && !shots_want(shots, NULL, "scatter_ratio")) return;
    Pace pace = pace_random(shots->frame->data, shots->frame->technique->variant);
    table_add(table, shots, NULL, "warps_per_second", 1e9 / pace.warp_ns, "1/s");
    table_add(table, shots, NULL, "scatter_ratio", pace.warp_ns / pace.scatter_ns, "1");
}

void scene_measure(const Shots *shots, Table *table) {
    Way way = shots->frame->technique->variant;
    bool warped = way != PLAIN, in_place = warped && way != AUXILIARY && way != RESIZED;
    for (int i = 0; i < shots->count; i++) {
        const Shot *shot = &shots->shots[i];
        HitErrors errors = hit_errors(&shot->picture.lookup, shot->centres, scene_texels(shots->frame->data));
        table_add(table, shots, shot->view, "wrong_hit_percent", errors.wrong_percent, "%");
        table_add(table, shots, shot->view, "hit_error_texels_p99", errors.p99, "texels");
        if (warped) add_figures(shots, i, table);
        if (in_place) add_pace(shots, i, table);
    }
    if (in_place) add_random_pace(shots, table);
}
