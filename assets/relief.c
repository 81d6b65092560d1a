/* relief: makes a relief texture of two images, takes one apart, and says what one holds.
 *
 * A relief texture is one file: colour, height, and what they measure (common/image.h has its equation,
 * assets/README.md its format). Programs that edit pictures take the fourth channel for transparency and may
 * lose the rest; so to edit one: split it, edit the two images, and combine them again --like it was. */
#include "fail.h"
#include "image.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "relief combine COLOUR HEIGHT OUT    makes the relief texture OUT, .png or .exr, of two images of one "
    "size\n"
    "    --scale S      how deep it is, in its widths (else what HEIGHT says, or 0.1)\n"
    "    --base B       the height of what lies in the polygon (else what HEIGHT says, or 1)\n"
    "    --width W      how wide it is in the world: then it has a basis, around the origin\n"
    "    --unit U       what W is measured in: m, mm, ...\n"
    "    --hollow       a height of 0 is no surface\n"
    "    --like RELIEF  all of this as RELIEF says it\n"
    "    --bits N       of a .png's numbers: 8 or 16 (16)\n"
    "relief split RELIEF COLOUR HEIGHT   makes the two images again, to edit them\n"
    "relief show RELIEF...               says what it holds, or they hold\n";

/* ---- Reading and writing ---- */

static Image relief_load(const char *path, ImageKind kind) {
    Image image = image_load(path, kind);
    if (!image.relief) fail("%s: not a relief texture (its file does not say texel:relief)", path);
    return image;
}

static void check(const char *reason, const char *path) {
    if (reason) fail("%s: %s", path, reason);
}

static void require_heights(const Image *height, const char *path) {
    for (int y = 0; y < height->height; y++)
        for (int x = 0; x < height->width; x++) {
            float h = *image_at(height, x, y);
            if (!(h >= 0 && h <= 1)) fail("%s: a height must lie in 0..1, but one is %g", path, h);
        }
}

/* ---- combine ---- */

typedef struct {
    double scale, base, width; /* NAN: not given */
    const char *unit, *like;
    bool hollow;
    int bits;
} Wishes;

static void take_after(Image *height, const char *path) {
    Image model = relief_load(path, IMAGE_HEIGHT);
    height->scale = model.scale, height->base = model.base;
    height->basis = model.basis, height->hollow = model.hollow;
    image_destroy(&model);
}

/* Upright around the origin, x along u and y along v: the polygon of mesh_plane. */
static Basis upright(double width, double tall) {
    return (Basis){
        .origin = v3(-width / 2, -tall / 2, 0), .a = v3(width, 0, 0), .b = v3(0, tall, 0), .f = v3(0, 0, 1)};
}

static void combine(char **paths, const Wishes *wishes) {
    Image colour = image_load(paths[0], IMAGE_COLOUR), height = image_load(paths[1], IMAGE_HEIGHT);
    require_heights(&height, paths[1]);
    if (wishes->like) take_after(&height, wishes->like);
    if (!isnan(wishes->scale)) height.scale = wishes->scale;
    if (!isnan(wishes->base)) height.base = wishes->base;
    if (isnan(height.scale)) height.scale = 0.1;
    if (isnan(height.base)) height.base = 1;
    if (!isnan(wishes->width))
        height.basis = upright(wishes->width, wishes->width * height.height / height.width);
    if (wishes->unit) snprintf(height.basis.unit, sizeof height.basis.unit, "%s", wishes->unit);
    height.hollow |= wishes->hollow;
    check(image_write_relief(&colour, &height, paths[2], wishes->bits), paths[2]);
    image_destroy(&colour), image_destroy(&height);
}

/* ---- split and show ---- */

static void split(char **paths) {
    Image colour = relief_load(paths[0], IMAGE_COLOUR), height = relief_load(paths[0], IMAGE_HEIGHT);
    check(image_write(&colour, paths[1]), paths[1]);
    check(image_write_raw(&height, paths[2], 16), paths[2]);
    image_destroy(&colour), image_destroy(&height);
}

static void print_vector(const char *name, Vec3 v, const char *unit) {
    printf("%-8s %.10g %.10g %.10g%s%s\n", name, v.x, v.y, v.z, *unit ? " " : "", unit);
}

static void print_number(const char *name, double number) {
    if (!isnan(number)) printf("%-8s %.10g\n", name, number);
}

static void show(const char *path) {
    Image height = relief_load(path, IMAGE_HEIGHT);
    const Basis *basis = &height.basis;
    printf("%s\n", path);
    printf("texels   %d x %d, %d bits\n", height.width, height.height, height.bits);
    print_number("scale", height.scale);
    print_number("base", height.base);
    if (!isnan(basis->a.x)) {
        print_vector("origin", basis->origin, basis->unit);
        print_vector("a", basis->a, basis->unit);
        print_vector("b", basis->b, basis->unit);
        print_vector("f", basis->f, "");
    }
    if (!isnan(basis->a.x) && !isnan(height.scale)) {
        double times = vec3_length(basis->f), deep = height.scale * vec3_length(basis->a) / times;
        printf("depth    %.10g %s from h = 0 to h = 1, shown %.10g times as deep\n", deep, basis->unit,
               times);
    }
    if (height.hollow) puts("hollow   where h = 0");
    image_destroy(&height);
}

/* ---- The command line ---- */

/* A finite number, greater than 0 if it must be. */
static double number(const char *option, const char *argument, bool positive) {
    char *end;
    double x = strtod(argument, &end);
    if (end == argument || *end || !isfinite(x) || (positive && x <= 0))
        fail_usage("--%s %s: not a number%s", option, argument, positive ? " above 0" : "");
    return x;
}

static Wishes read_options(int count, char **arguments) {
    enum { SCALE, BASE, WIDTH, UNIT, LIKE, HOLLOW, BITS };
    static const struct option options[] = {{"scale", required_argument, NULL, SCALE},
                                            {"base", required_argument, NULL, BASE},
                                            {"width", required_argument, NULL, WIDTH},
                                            {"unit", required_argument, NULL, UNIT},
                                            {"like", required_argument, NULL, LIKE},
                                            {"hollow", no_argument, NULL, HOLLOW},
                                            {"bits", required_argument, NULL, BITS},
                                            {"help", no_argument, NULL, 'h'},
                                            {0}};
    Wishes wishes = {.scale = NAN, .base = NAN, .width = NAN, .bits = 16};
    opterr = 0; /* its message is ours */
    for (int option; (option = getopt_long(count, arguments, ":h", options, NULL)) != -1;) switch (option) {
        case SCALE: wishes.scale = number("scale", optarg, false); break;
        case BASE: wishes.base = number("base", optarg, false); break;
        case WIDTH: wishes.width = number("width", optarg, true); break;
        case UNIT: wishes.unit = optarg; break;
        case LIKE: wishes.like = optarg; break;
        case HOLLOW: wishes.hollow = true; break;
        case BITS: wishes.bits = strcmp(optarg, "8") ? strcmp(optarg, "16") ? 0 : 16 : 8; break;
        case 'h': fputs(usage, stdout); exit(0);
        case ':': fail_usage("%s: its value is missing", arguments[optind - 1]);
        default: fail_usage("%s: no such option; --help lists them", arguments[optind - 1]);
        }
    if (!wishes.bits) fail_usage("--bits: neither 8 nor 16");
    if (wishes.unit && strlen(wishes.unit) >= sizeof((Basis *)0)->unit)
        fail_usage("--unit %s: longer than %zu bytes", wishes.unit, sizeof((Basis *)0)->unit - 1);
    return wishes;
}

int main(int count, char **arguments) {
    Wishes wishes = read_options(count, arguments); /* what is no option comes last now */
    const char *command = arguments[optind];
    if (!command) fail_usage("usage: relief combine|split|show ...; --help says more");
    char **paths = arguments + optind + 1;
    int given = count - optind - 1;
    bool combines = !strcmp(command, "combine"), splits = !strcmp(command, "split");
    bool shows = !strcmp(command, "show");
    if (!combines && !splits && !shows) fail_usage("%s: neither combine, split nor show", command);
    if (shows && given == 0) fail_usage("show: of what?");
    if (!shows && given != 3) fail_usage("%s takes 3 files, not %d", command, given);
    if (combines) combine(paths, &wishes);
    if (splits) split(paths);
    for (int i = 0; shows && i < given; i++) show(paths[i]);
    return 0;
}
