/* 19-encode: encodes the light field of a scene, or of a file, as a file; shows such files; checks them.
 *
 * Neither the field nor what becomes of it is ever in memory as a whole: a band of a few rows of v is
 * synthesised, encoded and written at a time. Stopped at any moment, it goes on where it was when called
 * again, and the file is the same to the byte. The format: README.md here, and assets/README.md. */
#include "fail.h"
#include "files.h"
#include "synthesis.h"

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char usage[] =
    "19-encode make OUT       encodes into the file OUT, or goes on with one that was stopped\n"
    "    --technique T  bc1, bc7, vq or ramp (ramp)\n"
    "    --knob K       vq: the logarithm of the codebook's size (12); ramp: the tolerance, more is smaller "
    "(8)\n"
    "    --scene S      composed, effects, aliasing, placements or around (composed)\n"
    "    --size UxVxSxT its texels along each axis\n"
    "    --samples N    rays a texel (7)\n"
    "    --from FILE    the texels of this raw light field instead\n"
    "    --bands N      stop when there are so many bands: a slice of the whole\n"
    "    --verify       read each band from the file again, decode it, and say how far from its texels it "
    "is\n"
    "19-encode show FILE...   checks files, and says what they hold\n"
    "19-encode check FILE...  decodes files, band by band, and holds them against their scene\n";

/* ---- Sources ---- */

static void synthesised_rows(const void *data, int first, int rows, uint8_t *texels) {
    synthesis_rows((const Synthesis *)data, first, rows, texels, NULL);
}

typedef struct {
    FieldFile file;
    const char *path;
} RawFile;

static void raw_rows(const void *data, int first, int rows, uint8_t *texels) {
    const RawFile *raw = data;
    for (int i = 0; i < rows; i++)
        field_file_demand(field_file_section(&raw->file, first + i,
                                             texels + field_row(&raw->file.header.field) * (size_t)i),
                          raw->path);
}

/* The scene that a header names, which must be as this program knows it. */
static const LightScene *scene_of(const FieldHeader *header, const char *path) {
    const LightScene *scene = light_scene_named(header->scene);
    if (!scene || field_header(&header->field, scene, 1, false).scene_key != header->scene_key)
        fail("%s: its scene, %s, is not one that this program knows", path, header->scene);
    return scene;
}

/* ---- make ---- */

typedef struct {
    const LightScene *scene;
    const Codec *codec;
    const char *from;
    Field field;
    int samples, knob, bands;
    bool verify;
} Wishes;

/* The most that was ever in memory, by Linux's own account of this program alone: getrusage goes on counting
 * from the one that started it. */
static double most_memory_mib(void) {
    double kib = 0.0;
    char line[256];
    FILE *status = fopen("/proc/self/status", "r");
    while (status && fgets(line, sizeof line, status))
        if (sscanf(line, "VmHWM: %lf", &kib) == 1) break;
    if (status) fclose(status);
    return kib / 1024.0;
}

static void say_error(const EncodedError *error) {
    printf("texture_psnr_db %.6f\ntexture_psnr_all_db %.6f\nnear_percent %.6f\n",
           squares_psnr_db(error->near_squares, error->near_texels),
           squares_psnr_db(error->squares, error->texels),
           100.0 * (double)error->near_texels / (double)error->texels);
}

static bool is_made(const char *path, const FieldHeader *header) {
    FieldFile file;
    Encoded encoded;
    if (access(path, F_OK) != 0) return false;
    field_file_demand(encoded_open(path, &file, &encoded), path);
    if (!field_header_equal(&file.header, header))
        fail("%s: is there, and is another light field: remove it, or name another file", path);
    field_file_close(&file);
    return true;
}

static void make(const char *path, const Wishes *wishes) {
    RawFile raw = {.path = wishes->from};
    FieldHeader plain =
        field_header(&wishes->field, wishes->scene, wishes->samples, wishes->scene == &light_placements);
    if (wishes->from) {
        field_file_demand(field_file_open(&raw.file, wishes->from), wishes->from);
        if (raw.file.header.codec != FIELD_RAW) fail("%s: is encoded already", wishes->from);
        plain = raw.file.header;
    }
    StreamOrder order = {.header = encoded_header(&plain, wishes->codec, wishes->knob),
                         .verify = wishes->verify};
    int all = codec_bands(wishes->codec, &plain.field);
    order.bands = wishes->bands && wishes->bands < all ? wishes->bands : all;
    if (is_made(path, &order.header)) {
        printf("%s: is there already\n", path);
        return;
    }
    Synthesis *synthesis = NULL;
    if (!wishes->from)
        synthesis = synthesis_create(&plain.field, wishes->scene, plain.samples, plain.through);
    order.source = wishes->from ? (FieldSource){raw_rows, &raw} : (FieldSource){synthesised_rows, synthesis};
    StreamReport report = encoded_stream(path, &order);
    if (report.begun) fprintf(stderr, "%s: went on behind %d of %d bands\n", path, report.begun, all);
    printf("bands %d of %d\nbytes %llu\nencode_seconds %.6f\nsource_seconds %.6f\npeak_memory_mib %.3f\n",
           report.done, all, (unsigned long long)report.bytes, report.seconds, report.source_seconds,
           most_memory_mib());
    if (wishes->verify && report.error.texels) say_error(&report.error);
    if (synthesis) synthesis_destroy(synthesis);
    if (wishes->from) field_file_close(&raw.file);
}

/* ---- show and check ---- */

static void show(const char *path) {
    FieldFile file;
    Encoded encoded;
    field_file_demand(encoded_open(path, &file, &encoded), path);
    field_file_demand(encoded_read(&file, &encoded), path);
    const Field *field = &file.header.field;
    double texels = (double)(field_bytes(field) / FIELD_TEXEL);
    printf("%s\nscene %s, %d rays a texel\n%d x %d x %d x %d texels along u, v, s, t\n", path,
           file.header.scene, file.header.samples, field->u, field->v, field->s, field->t);
    printf("%s %d\n%llu bytes, %.4f bits a texel, 1 to %.2f\n", encoded.codec->name, encoded.knob,
           (unsigned long long)file.bytes, 8.0 * (double)file.bytes / texels,
           3.0 * texels / (double)file.bytes);
    encoded_destroy(&encoded);
    field_file_close(&file);
}

static void check(const char *path) {
    FieldFile file;
    Encoded encoded;
    field_file_demand(encoded_open(path, &file, &encoded), path);
    const FieldHeader *header = &file.header;
    Synthesis *synthesis =
        synthesis_create(&header->field, scene_of(header, path), header->samples, header->through);
    int block = encoded.codec->block.v, v = header->field.v;
    uint8_t *texels = allocate((size_t)block, field_row(&header->field));
    EncodedError error = {0};
    for (int band = 0; band < codec_bands(encoded.codec, &header->field); band++) {
        int rows = v - band * block < block ? v - band * block : block;
        field_file_demand(encoded_read_band(&file, &encoded, band), path);
        synthesis_rows(synthesis, band * block, rows, texels, NULL);
        error = error_sum(error, encoded_error(&encoded, band * block, rows, texels));
    }
    printf("%s\n", path);
    say_error(&error);
    free(texels);
    synthesis_destroy(synthesis);
    encoded_destroy(&encoded);
    field_file_close(&file);
}

/* ---- The command line ---- */

static int whole_number(const char *option, const char *argument, int least, int most) {
    char *end;
    double x = strtod(argument, &end);
    if (end == argument || *end || !(x >= least && x <= most) || x != floor(x))
        fail_usage("--%s %s: not a whole number from %d to %d", option, argument, least, most);
    return (int)x;
}

static void read_size(const char *argument, Field *field) {
    const char *reason = field_size(field, argument);
    if (reason) fail_usage("--size %s: %s", argument, reason);
}

static Wishes read_options(int count, char **arguments) {
    enum { TECHNIQUE, KNOB, SCENE, SIZE, SAMPLES, FROM, BANDS, VERIFY };
    static const struct option options[] = {{"technique", required_argument, NULL, TECHNIQUE},
                                            {"knob", required_argument, NULL, KNOB},
                                            {"scene", required_argument, NULL, SCENE},
                                            {"size", required_argument, NULL, SIZE},
                                            {"samples", required_argument, NULL, SAMPLES},
                                            {"from", required_argument, NULL, FROM},
                                            {"bands", required_argument, NULL, BANDS},
                                            {"verify", no_argument, NULL, VERIFY},
                                            {"help", no_argument, NULL, 'h'},
                                            {0}};
    Wishes wishes = {.scene = &light_composed,
                     .codec = &codec_ramp,
                     .samples = 7,
                     .field = {.model = FIELD_SPHERE, .radius = 3.5}};
    const char *knob = NULL;
    opterr = 0; /* its message is ours */
    for (int option; (option = getopt_long(count, arguments, ":h", options, NULL)) != -1;) switch (option) {
        case TECHNIQUE:
            wishes.codec = codec_named(optarg);
            if (!wishes.codec) fail_usage("--technique %s: there is no such", optarg);
            break;
        case KNOB: knob = optarg; break;
        case SCENE:
            wishes.scene = light_scene_named(optarg);
            if (!wishes.scene) fail_usage("--scene %s: there is no such", optarg);
            break;
        case SIZE: read_size(optarg, &wishes.field); break;
        case SAMPLES: wishes.samples = whole_number("samples", optarg, 1, SAMPLES_MOST); break;
        case FROM: wishes.from = optarg; break;
        case BANDS: wishes.bands = whole_number("bands", optarg, 1, FIELD_MOST); break;
        case VERIFY: wishes.verify = true; break;
        case 'h': fputs(usage, stdout); exit(0);
        case ':': fail_usage("%s: its value is missing", arguments[optind - 1]);
        default: fail_usage("%s: no such option; --help lists them", arguments[optind - 1]);
        }
    if (wishes.scene == &light_around) wishes.field.model = FIELD_ROOM;
    const int *knobs = wishes.codec->knobs;
    wishes.knob = wishes.codec == &codec_vq ? 12 : wishes.codec == &codec_ramp ? 8 : knobs[0];
    if (knob) wishes.knob = whole_number("knob", knob, knobs[0], knobs[1]);
    return wishes;
}

int main(int count, char **arguments) {
    Wishes wishes = read_options(count, arguments); /* what is no option comes last now */
    const char *command = arguments[optind];
    if (!command) fail_usage("usage: 19-encode make|show|check ...; --help says more");
    char **paths = arguments + optind + 1;
    int given = count - optind - 1;
    void (*each)(const char *) = strcmp(command, "show") == 0    ? show
                                 : strcmp(command, "check") == 0 ? check
                                                                 : NULL;
    bool makes = strcmp(command, "make") == 0;
    if (!each && !makes) fail_usage("%s: neither make nor show nor check", command);
    if (given == 0 || (makes && given > 1)) fail_usage("%s: takes %s", command, makes ? "one file" : "files");
    for (int i = 0; each && i < given; i++) each(paths[i]);
    if (each) return 0;
    if (!wishes.field.u && !wishes.from) fail_usage("make: --size is missing, such as 512x256x32x32");
    make(paths[0], &wishes);
    return 0;
}
