#include "refine.h"

#include "fail.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST_RAYS = 2, MORE = 4, SKETCH = 4 }; /* the sketch is a quarter as wide and high */

struct Refiner {
    Truth truth;
    int most;
    void (*wake)(void);
    pthread_t thread;
    pthread_mutex_t mutex; /* holds all below but the thread's own */
    pthread_cond_t asked;
    atomic_bool stop; /* what is being rendered is no longer wanted */
    bool quit, sketching, wanted;
    Camera camera;
    int width, height;
    unsigned camera_serial, picture_serial; /* what was begun under another number is dropped */
    Image picture;                          /* to be judged; moved out while it is */
    Refined news;
    bool fresh;
    int rays, judged; /* what exact has, and what the picture was held against; rays < 0: not begun */
    /* The thread's own. */
    Image exact;
    Sample *centres;
};

static Image copy_of(const Image *image) {
    Image copy = image_create(image->width, image->height, image->channels);
    memcpy(copy.pixels, image->pixels,
           (size_t)image->width * image->height * image->channels * sizeof(float));
    return copy;
}

static void tell(Refiner *refiner) {
    refiner->fresh = true;
    refiner->wake();
}

/* The next exact picture: a sketch, then FIRST_RAYS a pixel, and each time MORE as many. Called and left with
 * the mutex locked; open between. */
static void render(Refiner *r) {
    unsigned serial = r->camera_serial;
    Camera camera = r->camera;
    bool sketch = r->sketching = r->rays < 0;
    int width = r->width, height = r->height;
    int rays = sketch ? 0 : r->rays == 0 ? FIRST_RAYS : r->rays * MORE;
    if (rays > r->most) rays = r->most;
    atomic_store(&r->stop, false);
    pthread_mutex_unlock(&r->mutex);

    Exact exact;
    if (sketch) {
        exact = truth_render(&r->truth, &camera, (width + SKETCH - 1) / SKETCH,
                             (height + SKETCH - 1) / SKETCH, FIRST_RAYS, FILTER_BOX);
        free(r->centres);
        r->centres = NULL;
    } else {
        exact = truth_render(&r->truth, &camera, width, height, rays, FILTER_BOX);
        if (!r->centres) r->centres = truth_centres(&r->truth, &camera, width, height);
    }
    image_destroy(&r->exact);
    r->exact = exact.image;

    pthread_mutex_lock(&r->mutex);
    r->sketching = false;
    bool current = serial == r->camera_serial;
    if (current) r->rays = rays;
    if (current || (sketch && r->wanted)) { /* a camera that moves is followed by sketches a moment old */
        image_destroy(&r->news.exact);
        r->news.exact = copy_of(&r->exact);
        r->news.rays = rays;
        tell(r);
    }
}

/* The same bargain with the mutex. Where the truth knows nothing, no error may arise: there the picture is
 * made equal to it, and the means are taken over the rest, as in the tables. */
static void judge(Refiner *r) {
    unsigned camera_serial = r->camera_serial, picture_serial = r->picture_serial;
    Image picture = r->picture, map, heat = {0};
    int rays = r->rays;
    r->picture.pixels = NULL;
    pthread_mutex_unlock(&r->mutex);

    size_t count = (size_t)picture.width * picture.height, known = 0;
    for (size_t i = 0; i < count; i++) {
        known += !r->centres[i].unknown;
        if (r->centres[i].unknown) memcpy(picture.pixels + 3 * i, r->exact.pixels + 3 * i, 3 * sizeof(float));
    }
    double share = (double)known / (double)count;
    Difference difference = {0};
    const char *reason = known ? compare(&picture, &r->exact, &difference, &map) : "the truth knows no pixel";
    if (!reason) {
        heat = compare_heat(&map);
        image_destroy(&map);
        difference.rmse /= sqrt(share);
        difference.flip /= share;
    }

    pthread_mutex_lock(&r->mutex);
    if (camera_serial == r->camera_serial && picture_serial == r->picture_serial) {
        r->picture = picture;
        image_destroy(&r->news.heat);
        r->news.heat = heat;
        r->news.difference = difference;
        r->news.judged = r->judged = rays;
        snprintf(r->news.reason, sizeof r->news.reason, "%s", reason ? reason : "");
        tell(r);
    } else {
        image_destroy(&picture);
        image_destroy(&heat);
    }
}

static void *work(void *argument) {
    Refiner *r = argument;
    pthread_mutex_lock(&r->mutex);
    while (!r->quit) {
        bool fits = r->picture.width == r->exact.width && r->picture.height == r->exact.height;
        if (r->wanted && r->rays > r->judged && r->picture.pixels && fits)
            judge(r);
        else if (r->wanted && r->rays < r->most)
            render(r);
        else
            pthread_cond_wait(&r->asked, &r->mutex);
    }
    pthread_mutex_unlock(&r->mutex);
    return NULL;
}

Refiner *refiner_create(const Truth *truth, int rays, void (*wake)(void)) {
    Refiner *refiner = allocate(1, sizeof *refiner);
    refiner->truth = *truth;
    refiner->truth.key = 0; /* cameras on the move are not worth keeping */
    refiner->truth.stop = &refiner->stop;
    refiner->most = rays;
    refiner->wake = wake;
    pthread_mutex_init(&refiner->mutex, NULL);
    pthread_cond_init(&refiner->asked, NULL);
    if (pthread_create(&refiner->thread, NULL, work, refiner) != 0) fail("no thread for the exact picture");
    return refiner;
}

void refiner_destroy(Refiner *refiner) {
    pthread_mutex_lock(&refiner->mutex);
    refiner->quit = true;
    atomic_store(&refiner->stop, true);
    pthread_cond_signal(&refiner->asked);
    pthread_mutex_unlock(&refiner->mutex);
    pthread_join(refiner->thread, NULL);
    pthread_mutex_destroy(&refiner->mutex);
    pthread_cond_destroy(&refiner->asked);
    image_destroy(&refiner->picture);
    image_destroy(&refiner->news.exact);
    image_destroy(&refiner->news.heat);
    image_destroy(&refiner->exact);
    free(refiner->centres);
    free(refiner);
}

static void drop_error(Refiner *refiner, Image picture) {
    refiner->picture_serial++;
    image_destroy(&refiner->picture);
    refiner->picture = picture;
    image_destroy(&refiner->news.heat);
    refiner->news.judged = refiner->judged = 0;
    refiner->news.reason[0] = '\0';
}

void refiner_want(Refiner *refiner, const Camera *camera, int width, int height) {
    pthread_mutex_lock(&refiner->mutex);
    drop_error(refiner, (Image){0});
    image_destroy(&refiner->news.exact);
    refiner->news.rays = 0;
    refiner->fresh = false;
    refiner->camera_serial++;
    refiner->rays = -1;
    refiner->wanted = camera != NULL;
    if (camera) refiner->camera = *camera;
    refiner->width = width;
    refiner->height = height;
    if (!refiner->sketching) atomic_store(&refiner->stop, true); /* else it would never end while dragging */
    pthread_cond_signal(&refiner->asked);
    pthread_mutex_unlock(&refiner->mutex);
}

void refiner_judge(Refiner *refiner, Image picture) {
    pthread_mutex_lock(&refiner->mutex);
    drop_error(refiner, picture);
    pthread_cond_signal(&refiner->asked);
    pthread_mutex_unlock(&refiner->mutex);
}

bool refiner_news(Refiner *refiner, Refined *refined) {
    pthread_mutex_lock(&refiner->mutex);
    bool fresh = refiner->fresh;
    if (fresh) {
        *refined = refiner->news;
        refiner->news.exact.pixels = refiner->news.heat.pixels = NULL; /* moved */
    }
    refiner->fresh = false;
    pthread_mutex_unlock(&refiner->mutex);
    return fresh;
}
