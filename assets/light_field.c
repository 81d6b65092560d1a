/* light-field: makes the light field of a scene as a file, however large, and says what such a file holds.
 *
 * A field may be far larger than memory: a few rows of v are made and written at a time (common/synthesis.h,
 * common/field_file.h). Stopped at any moment, even by kill -9, it goes on where it was when called again,
 * and the file is the same to the byte; assets/README.md has its format. */
#include "clock.h"
#include "fail.h"
#include "field_file.h"
#include "synthesis.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

static const char usage[] =
    "light-field make OUT       makes the light field OUT, or goes on with one that was stopped\n"
    "    --scene S      composed, effects, aliasing, placements or around (composed)\n"
    "    --size UxVxSxT its texels along each axis\n"
    "    --samples N    rays a texel (7)\n"
    "    --angles A     how s and t divide them: linear, sine or stereographic (linear)\n"
    "    --model M      what it lies on: sphere, cylinder or room (room for around, else sphere)\n"
    "    --radius R     of the model (3.5)\n"
    "    --height H     of a cylinder (6)\n"
    "light-field show FILE...   checks files, and says what they hold\n";

static const char *const models[] = {"sphere", "cylinder", "room", NULL};
static const char *const scales[] = {"linear", "sine", "stereographic", NULL};

/* ---- make ---- */

enum { TILE_BYTES = 64 << 20, TILE_BLOCKS = 1024 }; /* made at a time: at most, but one row at least */

/* Rows of v in a tile: enough blocks for all cores, and not more memory than that. */
static int tile_rows(const Field *field) {
    int rows = (TILE_BLOCKS + field->u - 1) / field->u;
    while (rows > 1 && field_row(field) * (size_t)rows > TILE_BYTES) rows--;
    return rows;
}

/* A line every hundredth of the whole, but not more than one in two seconds. */
static void say_progress(const FieldHeader *header, int done, int begun, double start) {
    static double said;
    static int row;
    int all = header->field.v;
    double now = clock_seconds();
    if (row < begun) row = begun;
    if (now - (said > 0 ? said : start) < 2.0 || (done - row) * 100 < all) return;
    said = now, row = done;
    fprintf(stderr, "light field %s: %d of %d rows, about %.0f s left\n", header->scene, done, all,
            (now - start) / (done - begun) * (all - done));
}

static void synthesise(FieldWriter *writer, const LightScene *scene) {
    const FieldHeader *header = &writer->file.header;
    const Field *field = &header->field;
    int tile = tile_rows(field), begun = writer->file.count;
    double start = clock_seconds();
    Synthesis *synthesis = synthesis_create(field, scene, header->samples, header->through);
    uint8_t *texels = allocate((size_t)tile, field_row(field));
    if (begun)
        fprintf(stderr, "light field %s: going on behind %d of %d rows\n", header->scene, begun, field->v);
    for (int v = begun; v < field->v; v += tile) {
        int rows = field->v - v < tile ? field->v - v : tile;
        synthesis_rows(synthesis, v, rows, texels, NULL);
        for (int i = 0; i < rows; i++)
            field_file_demand(field_writer_add(writer, FIELD_ROWS, (uint32_t)(v + i),
                                               texels + field_row(field) * (size_t)i, field_row(field)),
                              writer->partial);
        say_progress(header, v + rows, begun, start);
    }
    free(texels);
    synthesis_destroy(synthesis);
}

/* Whether the whole file is there already. */
static bool is_made(const char *path, const FieldHeader *header) {
    FieldFile file;
    if (access(path, F_OK) != 0) return false;
    field_file_demand(field_file_open(&file, path), path);
    if (!field_header_equal(&file.header, header))
        fail("%s: is there, and is another light field: remove it, or name another file", path);
    field_file_close(&file);
    return true;
}

static void make(const char *path, const FieldHeader *header, const LightScene *scene) {
    if (is_made(path, header)) {
        printf("%s: is there already\n", path);
        return;
    }
    double start = clock_seconds();
    FieldWriter writer;
    field_file_demand(field_writer_open(&writer, path, header), path);
    synthesise(&writer, scene);
    field_file_demand(field_writer_finish(&writer), path);
    field_writer_close(&writer);
    struct rusage used;
    getrusage(RUSAGE_SELF, &used);
    printf("%s: %zu bytes of texels, %.1f s, at most %.0f MiB of memory\n", path, field_bytes(&header->field),
           clock_seconds() - start, used.ru_maxrss / 1024.0);
}

/* ---- show ---- */

/* How many sections in a row have one tag, and how long their payloads are together. */
static void show_sections(const FieldFile *file) {
    for (int i = 0, next; i < file->count; i = next) {
        uint32_t tag = file->sections[i].tag;
        unsigned long long bytes = 0;
        for (next = i; next < file->count && file->sections[next].tag == tag; next++)
            bytes += file->sections[next].length;
        char name[5] = {0};
        for (int k = 0; k < 4; k++) {
            name[k] = (char)(tag >> 8 * k & 255);
            if (name[k] < ' ' || name[k] > '~') name[k] = '?';
        }
        printf("sections %d %s, %llu bytes\n", next - i, name, bytes);
    }
}

static void show(const char *path) {
    FieldFile file;
    field_file_demand(field_file_open(&file, path), path);
    field_file_demand(field_file_check(&file), path);
    const FieldHeader *header = &file.header;
    const Field *field = &header->field;
    const LightScene *scene = light_scene_named(header->scene);
    bool same =
        scene && field_header(field, scene, header->samples, header->through).scene_key == header->scene_key;
    printf("%s\nscene    %s%s\n", path, header->scene, same ? "" : ", but not as this program knows it");
    printf("model    %s of radius %.10g", models[field->model], field->radius);
    if (field->model == FIELD_CYLINDER) printf(", height %.10g", field->height);
    printf("\ntexels   %d x %d x %d x %d along u, v, s, t, %s angles\n", field->u, field->v, field->s,
           field->t, scales[field->angles]);
    printf("rays     %d a texel%s\n", header->samples, header->through ? ", from outside of everything" : "");
    if (header->codec == FIELD_RAW) {
        printf("codec    none: sRGB\n");
    } else {
        printf("codec    %u, parameters", header->codec);
        for (int i = 0; i < FIELD_PARAMETERS; i++) printf(" %u", header->parameters[i]);
        putchar('\n');
    }
    show_sections(&file);
    field_file_close(&file);
}

/* ---- The command line ---- */

/* A number from 0 to 10^6. */
static double number(const char *option, const char *argument) {
    char *end;
    double x = strtod(argument, &end);
    if (end == argument || *end || !(x >= 0 && x <= 1e6))
        fail_usage("--%s %s: not a number from 0 to 10^6", option, argument);
    return x;
}

static int whole_number(const char *option, const char *argument) {
    double x = number(option, argument);
    if (x != floor(x)) fail_usage("--%s %s: not a whole number", option, argument);
    return (int)x;
}

static int choice(const char *option, const char *argument, const char *const *names) {
    for (int i = 0; names[i]; i++)
        if (strcmp(names[i], argument) == 0) return i;
    fail_usage("--%s %s: there is no such", option, argument);
}

static void read_size(const char *argument, Field *field) {
    const char *reason = field_size(field, argument);
    if (reason) fail_usage("--size %s: %s", argument, reason);
}

typedef struct {
    const LightScene *scene;
    Field field;
    int samples;
} Wishes;

static Wishes read_options(int count, char **arguments) {
    enum { SCENE, SIZE, SAMPLES, ANGLES, MODEL, RADIUS, HEIGHT };
    static const struct option options[] = {{"scene", required_argument, NULL, SCENE},
                                            {"size", required_argument, NULL, SIZE},
                                            {"samples", required_argument, NULL, SAMPLES},
                                            {"angles", required_argument, NULL, ANGLES},
                                            {"model", required_argument, NULL, MODEL},
                                            {"radius", required_argument, NULL, RADIUS},
                                            {"height", required_argument, NULL, HEIGHT},
                                            {"help", no_argument, NULL, 'h'},
                                            {0}};
    Wishes wishes = {.scene = &light_composed, .field = {.radius = 3.5}, .samples = 7};
    int model = -1;
    double height = NAN;
    opterr = 0; /* its message is ours */
    for (int option; (option = getopt_long(count, arguments, ":h", options, NULL)) != -1;) switch (option) {
        case SCENE:
            wishes.scene = light_scene_named(optarg);
            if (!wishes.scene) fail_usage("--scene %s: there is no such", optarg);
            break;
        case SIZE: read_size(optarg, &wishes.field); break;
        case SAMPLES: wishes.samples = whole_number("samples", optarg); break;
        case ANGLES: wishes.field.angles = (FieldAngles)choice("angles", optarg, scales); break;
        case MODEL: model = choice("model", optarg, models); break;
        case RADIUS: wishes.field.radius = number("radius", optarg); break;
        case HEIGHT: height = number("height", optarg); break;
        case 'h': fputs(usage, stdout); exit(0);
        case ':': fail_usage("%s: its value is missing", arguments[optind - 1]);
        default: fail_usage("%s: no such option; --help lists them", arguments[optind - 1]);
        }
    if (wishes.samples < 1 || wishes.samples > SAMPLES_MOST)
        fail_usage("--samples %d: there may be 1 to %d", wishes.samples, SAMPLES_MOST);
    if (model < 0) model = wishes.scene == &light_around ? FIELD_ROOM : FIELD_SPHERE;
    wishes.field.model = (FieldModel)model;
    if (model != FIELD_CYLINDER && !isnan(height)) fail_usage("--height: only a cylinder has one");
    if ((model == FIELD_ROOM) != (wishes.scene == &light_around))
        fail_usage("--model %s: a room is for the scene around, and only that", models[model]);
    if (model == FIELD_CYLINDER) wishes.field.height = isnan(height) ? 6.0 : height;
    return wishes;
}

int main(int count, char **arguments) {
    Wishes wishes = read_options(count, arguments); /* what is no option comes last now */
    const char *command = arguments[optind];
    if (!command) fail_usage("usage: light-field make|show ...; --help says more");
    char **paths = arguments + optind + 1;
    int given = count - optind - 1;
    bool makes = strcmp(command, "make") == 0;
    if (!makes && strcmp(command, "show")) fail_usage("%s: neither make nor show", command);
    if (given == 0 || (makes && given > 1)) fail_usage("%s: takes %s", command, makes ? "one file" : "files");
    for (int i = 0; !makes && i < given; i++) show(paths[i]);
    if (!makes) return 0;
    if (!wishes.field.u) fail_usage("make: --size is missing, such as 512x256x32x32");
    /* What lies in front of its model is what that scene is about. */
    bool through = wishes.scene == &light_placements;
    FieldHeader header = field_header(&wishes.field, wishes.scene, wishes.samples, through);
    make(paths[0], &header, wishes.scene);
    return 0;
}
