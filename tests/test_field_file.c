/* Files of light fields: what comes back, what goes on, and all that must be refused. */
#define _GNU_SOURCE
#include "field_file.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>

#include "random.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- A folder for all tests, and whole files in memory ---- */

static char folder[200], path[220], partial[240];

static int folder_make(void **state) {
    (void)state;
    const char *temporary = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/texel-XXXXXX", temporary ? temporary : "/tmp");
    if (!mkdtemp(folder)) return -1;
    snprintf(path, sizeof path, "%s/a.field", folder);
    snprintf(partial, sizeof partial, "%s.partial", path);
    return 0;
}

static int folder_remove(void **state) {
    (void)state;
    remove(path), remove(partial);
    return rmdir(folder);
}

typedef struct {
    size_t size;
    uint8_t bytes[1 << 20];
} Bytes;

static Bytes whole, raw, changed; /* whole: a written file; raw: a raw field's */

static void file_read(const char *name, Bytes *bytes) {
    FILE *file = fopen(name, "rb");
    assert_non_null(file);
    bytes->size = fread(bytes->bytes, 1, sizeof bytes->bytes, file);
    fclose(file);
    assert_true(bytes->size < sizeof bytes->bytes);
}

static void file_write(const char *name, const void *bytes, size_t size) {
    FILE *file = fopen(name, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static bool is_there(const char *name) { return access(name, F_OK) == 0; }

/* ---- Light fields for the tests: of texels that are made up ---- */

enum { HEADER = 128, HEAD = 16, SUM = 8 };

static FieldHeader header_small(void) {
    const Field field = {.radius = 3.5, .u = 8, .v = 9, .s = 10, .t = 8};
    return field_header(&field, &light_composed, 7, false);
}

/* An encoded one, whose sections may be anything. */
static FieldHeader header_encoded(void) {
    FieldHeader header = header_small();
    header.codec = 3;
    for (int i = 0; i < FIELD_PARAMETERS; i++) header.parameters[i] = 0xa0000000u + (uint32_t)i;
    return header;
}

/* Byte i of section n. */
static void fill(uint8_t *bytes, size_t count, int n) {
    for (size_t i = 0; i < count; i++) bytes[i] = (uint8_t)((i * 2654435761u >> 13) + (size_t)n * 57);
}

static void succeeds(const char *reason) {
    if (reason) fail_msg("refused: %s", reason);
}

/* One line, with `part` in it. */
static void assert_says(const char *reason, const char *part) {
    if (!reason || !strstr(reason, part)) fail_msg("expected \"...%s...\", got \"%s\"", part, reason);
    if (strchr(reason, '\n') || !*reason) fail_msg("not one line: \"%s\"", reason);
}

static void add_rows(FieldWriter *writer, int end) {
    uint8_t row[8 * 10 * 8 * 3];
    for (int v = writer->file.count; v < end; v++) {
        fill(row, sizeof row, v);
        succeeds(field_writer_add(writer, FIELD_ROWS, (uint32_t)v, row, sizeof row));
    }
}

static void write_raw(void) {
    remove(path);
    FieldHeader header = header_small();
    FieldWriter writer;
    succeeds(field_writer_open(&writer, path, &header));
    assert_int_equal(writer.file.count, 0);
    add_rows(&writer, 9);
    assert_true(is_there(partial) && !is_there(path));
    succeeds(field_writer_finish(&writer));
    field_writer_close(&writer);
    assert_true(is_there(path) && !is_there(partial));
}

static const size_t lengths[] = {0, 1, 7, 8, 9, 1000, 300000};
enum { SECTIONS = sizeof lengths / sizeof *lengths };
static uint8_t scratch[300000], expected[300000];

static void add_sections(FieldWriter *writer) {
    for (int i = writer->file.count; i < SECTIONS; i++) {
        fill(scratch, lengths[i], i);
        succeeds(
            field_writer_add(writer, FIELD_TAG('P', 'A', 'R', 'T'), 1000 - (uint32_t)i, scratch, lengths[i]));
    }
}

static void write_encoded(void) {
    FieldHeader header = header_encoded();
    FieldWriter writer;
    succeeds(field_writer_open(&writer, path, &header));
    add_sections(&writer);
    succeeds(field_writer_finish(&writer));
    field_writer_close(&writer);
}

static int files_make(void **state) {
    if (folder_make(state)) return -1;
    write_encoded(), file_read(path, &whole);
    write_raw(), file_read(path, &raw);
    return 0;
}

/* ---- Round trips ---- */

static void rows_come_back(void **state) {
    (void)state;
    FieldFile file;
    write_raw();
    succeeds(field_file_open(&file, path));
    FieldHeader header = header_small();
    assert_true(field_header_equal(&file.header, &header));
    assert_int_equal(file.count, 9);
    size_t row = field_row(&file.header.field);
    assert_int_equal(file.bytes, HEADER + 9 * (HEAD + row + SUM) + HEAD + SUM);
    for (int v = 8; v >= 0; v--) { /* in any order */
        succeeds(field_file_section(&file, v, scratch));
        fill(expected, row, v);
        assert_memory_equal(scratch, expected, row);
    }
    succeeds(field_file_check(&file));
    assert_says(field_file_section(&file, 9, scratch), "no section 9");
    assert_says(field_file_section(&file, -1, scratch), "no section");
    field_file_close(&file);
}

static void sections_come_back(void **state) {
    (void)state;
    FieldFile file;
    write_encoded();
    succeeds(field_file_open(&file, path));
    assert_int_equal(file.count, SECTIONS);
    for (int i = 0; i < SECTIONS; i++) {
        const FieldSection *section = &file.sections[i];
        assert_int_equal(section->tag, FIELD_TAG('P', 'A', 'R', 'T'));
        assert_int_equal(section->number, 1000 - i);
        assert_int_equal(section->length, lengths[i]);
        assert_int_equal(field_file_find(&file, section->tag, section->number), i);
        succeeds(field_file_section(&file, i, scratch));
        fill(expected, lengths[i], i);
        assert_memory_equal(scratch, expected, lengths[i]);
    }
    assert_int_equal(field_file_find(&file, FIELD_ROWS, 1000), -1);
    assert_int_equal(field_file_find(&file, FIELD_TAG('P', 'A', 'R', 'T'), 1), -1);
    field_file_close(&file);
    assert_memory_equal(whole.bytes + HEADER, "PART", 4); /* as an editor shows it */
}

/* Each of a header's numbers by itself: another one is another header, and what comes back is what went in.
 */
static void headers_come_back(void **state) {
    (void)state;
    enum { CHANGES = 21 };
    for (int change = 0; change < CHANGES; change++) {
        FieldHeader header = header_encoded(), before = header;
        header.field.model = FIELD_CYLINDER, header.field.height = 6, before = header;
        switch (change) {
        case 0: header.field.model = FIELD_ROOM, header.field.height = 0; break;
        case 1: header.field.angles = ANGLES_STEREOGRAPHIC; break;
        case 2: header.field.u = 1024; break;
        case 3: header.field.v = 1024; break;
        case 4: header.field.s = 256; break;
        case 5: header.field.t = 256; break;
        case 6: header.field.radius = 0.1; break;
        case 7: header.field.height = 1e5 / 3; break;
        case 8: header.samples = 4096; break;
        case 9: header.through = true; break;
        case 10: strcpy(header.scene, "x"); break;
        case 11: strcpy(header.scene, "a-name_of-23-characters"); break;
        case 12: header.scene_key ^= 1ull << 63; break;
        case 13: header.codec = 0xffffffffu; break;
        case 14: header.field.angles = ANGLES_SINE; break;
        default: header.parameters[change - 15] ^= 1; break;
        }
        FieldWriter writer;
        FieldFile file;
        succeeds(field_writer_open(&writer, path, &header));
        succeeds(field_writer_finish(&writer));
        field_writer_close(&writer);
        succeeds(field_file_open(&file, path));
        assert_true(field_header_equal(&file.header, &header));
        assert_false(field_header_equal(&file.header, &before));
        const Field *f = &file.header.field, *g = &header.field;
        assert_true(f->model == g->model && f->angles == g->angles && f->u == g->u && f->v == g->v &&
                    f->s == g->s && f->t == g->t && f->radius == g->radius && f->height == g->height);
        assert_true(file.header.samples == header.samples && file.header.through == header.through &&
                    file.header.scene_key == header.scene_key && file.header.codec == header.codec);
        assert_string_equal(file.header.scene, header.scene);
        assert_memory_equal(file.header.parameters, header.parameters, sizeof header.parameters);
        field_file_close(&file);
    }
}

static void assert_other_key(const LightScene *scene, const LightScene *other) {
    const Field field = header_small().field;
    FieldHeader a = field_header(&field, scene, 7, false), b = field_header(&field, other, 7, false);
    assert_true(a.scene_key != b.scene_key);
    assert_false(field_header_equal(&a, &b));
}

/* A scene that was changed is told from one of the same name as it was. */
static void scenes_are_told_apart(void **state) {
    (void)state;
    for (int change = 0; change < 10; change++) {
        LightScene scene = light_effects;
        Solid *last = &scene.solids[scene.count - 1];
        switch (change) {
        case 0: scene.count--; break;
        case 1: scene.toward_light.z += 1e-15; break;
        case 2: scene.effects = false; break;
        case 3: last->kind = SOLID_SPHERE; break;
        case 4: last->size.x = nextafter(last->size.x, 9); break;
        case 5: last->centre.y = nextafter(last->centre.y, 9); break;
        case 6: last->turn_degrees.z = 1; break;
        case 7: last->colour.z = 0.5; break;
        case 8: scene.mirror[scene.count - 1] = 0.1; break;
        case 9: scene.clear[0] = 0.1; break;
        }
        assert_other_key(&light_effects, &scene);
    }
    LightScene same = light_composed; /* what has no effects has no mirrors */
    same.mirror[0] = 0.5, same.name = "composed";
    const Field field = header_small().field;
    FieldHeader a = field_header(&field, &light_composed, 7, false),
                b = field_header(&field, &same, 7, false);
    assert_true(field_header_equal(&a, &b));
    assert_string_equal(a.scene, "composed");
}

/* Behind those bytes of the raw file is their checksum, in the plainest way. */
static void assert_plain_sum(size_t at, size_t count) {
    uint64_t sum = 0, word;
    for (size_t end = at + count; at < end; at += 8) {
        memcpy(&word, raw.bytes + at, 8);
        sum = (sum ^ word) * 0x9e3779b97f4a7c15u;
        sum ^= sum >> 32;
    }
    memcpy(&word, raw.bytes + at, 8);
    assert_true(sum == word);
}

/* The bytes that assets/README.md promises, made here by hand. */
static void the_format_is_as_documented(void **state) {
    (void)state;
    const uint8_t numbers[] = {1, 0, 0, 0, 0, 0,  0, 0, 0,  0,  0, 0, 0, 0, 0, 0, 8, 0, 0,
                               0, 9, 0, 0, 0, 10, 0, 0, 0,  8,  0, 0, 0, 7, 0, 0, 0, 0, 0,
                               0, 0, 0, 0, 0, 0,  0, 0, 12, 64, 0, 0, 0, 0, 0, 0, 0, 0}; /* 3.5 is 0x400c...
                                                                                          */
    assert_memory_equal(raw.bytes, "TXLFIELD", 8);
    assert_memory_equal(raw.bytes + 8, numbers, sizeof numbers);
    assert_memory_equal(raw.bytes + 64, "composed\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 24);
    assert_memory_equal(raw.bytes + HEADER, "ROWS\0\0\0\0\x80\x07\0\0\0\0\0\0", HEAD);
    assert_memory_equal(raw.bytes + raw.size - HEAD - SUM, "END \x09\0\0\0\0\0\0\0\0\0\0\0", HEAD);
    assert_plain_sum(0, 120);
    for (size_t v = 0; v < 9; v++) assert_plain_sum(120 + v * (24 + 1920), 24 + 1920);
    assert_plain_sum(raw.size - SUM - HEAD - SUM, SUM + HEAD);
}

/* ---- Refusals ---- */

/* Opening, and then reading all of it, must be refused, for a reason that holds `part`. */
static void assert_refused(const char *part) {
    FieldFile file;
    const char *reason = field_file_open(&file, path);
    if (!reason) {
        reason = field_file_check(&file);
        field_file_close(&file);
    }
    assert_says(reason, part);
}

static void refuses_what_is_no_light_field(void **state) {
    (void)state;
    FieldFile file;
    remove(path);
    assert_refused("No such file");
    assert_says(field_file_open(&file, folder), "Is a directory");
    assert_says(field_file_open(&file, "/dev/zero"), "not a regular file");
    assert_int_equal(mkfifo(path, 0600), 0);
    assert_refused("not a regular file"); /* and does not wait for somebody to write */
    remove(path);
    file_write(path, "", 0);
    assert_refused("empty");
    file_write(path, "TXLFIEL", 7);
    assert_refused("not a light field");
    file_write(path, "This is a letter to a friend.\n", 30);
    assert_refused("not a light field");
    memset(scratch, 0, 4096);
    file_write(path, scratch, 4096);
    assert_refused("not a light field");
}

/* At each boundary within the file, and just before and behind it. */
static void assert_truncations(const Bytes *of, const FieldSection *sections, int count) {
    size_t ends[128] = {8, 12, 64, HEADER}, n = 4;
    for (int i = 0; i < count; i++) {
        size_t at = (size_t)sections[i].offset, end = at + (size_t)sections[i].length;
        ends[n++] = at - HEAD + 4, ends[n++] = at - HEAD + 8, ends[n++] = at;
        ends[n++] = at + sections[i].length / 2, ends[n++] = end, ends[n++] = end + SUM;
    }
    ends[n++] = of->size - SUM, ends[n++] = of->size;
    assert_true(n < sizeof ends / sizeof *ends);
    for (size_t i = 0; i < n; i++)
        for (int more = -1; more <= 1; more++) {
            size_t size = ends[i] + (size_t)more;
            memcpy(changed.bytes, of->bytes, of->size);
            changed.bytes[of->size] = 0;
            file_write(path, changed.bytes, size);
            FieldFile file;
            if (size == of->size) {
                succeeds(field_file_open(&file, path));
                succeeds(field_file_check(&file));
                field_file_close(&file);
            } else
                assert_refused(size > of->size ? "behind its end" : size < 8 ? "not a light" : "truncated");
        }
}

static void refuses_truncated_files(void **state) {
    (void)state;
    FieldFile file;
    for (int i = 0; i < 2; i++) {
        const Bytes *of = i ? &raw : &whole;
        file_write(path, of->bytes, of->size);
        succeeds(field_file_open(&file, path));
        FieldSection sections[16];
        int count = file.count;
        memcpy(sections, file.sections, (size_t)count * sizeof *sections);
        field_file_close(&file);
        assert_truncations(of, sections, count);
    }
}

/* One to four bytes changed anywhere, two thousand times; half of them in headers, heads and checksums, which
 * are but a small part of the file. */
static void refuses_changed_bytes(void **state) {
    (void)state;
    for (int i = 0; i < 2000; i++) {
        const Bytes *of = i % 2 ? &raw : &whole;
        memcpy(changed.bytes, of->bytes, of->size);
        int changes = 1 + i / 2 % 4;
        for (int k = 0; k < changes; k++) {
            size_t at = (size_t)random_in(0, (double)of->size);
            if (i / 8 % 2) { /* in the header, or around a section of the raw one */
                size_t step = of == &raw ? HEAD + 1920 + SUM : (size_t)random_in(1, 40000);
                at = (size_t)random_in(0, HEADER + HEAD);
                if (at >= HEADER - SUM) at += step * (size_t)random_in(0, of == &raw ? 10 : 7);
            }
            if (at >= of->size) at = of->size - 1;
            changed.bytes[at] ^= (uint8_t)(k ? random_in(1, 256) : 1 << (int)random_in(0, 8));
        }
        if (memcmp(changed.bytes, of->bytes, of->size) == 0) continue;
        file_write(path, changed.bytes, of->size);
        assert_refused("");
    }
}

/* What no checksum sees: all bytes of a section moved to where another was. */
static void refuses_sections_in_another_order(void **state) {
    (void)state;
    size_t section = HEAD + 1920 + SUM;
    memcpy(changed.bytes, raw.bytes, raw.size);
    memcpy(changed.bytes + HEADER, raw.bytes + HEADER + section, section);
    memcpy(changed.bytes + HEADER + section, raw.bytes + HEADER, section);
    file_write(path, changed.bytes, raw.size);
    assert_refused("section 0 is not row 0");
    /* An encoded file is free in its order, but each checksum goes on from the one before. */
    memcpy(changed.bytes, whole.bytes, whole.size);
    size_t first = HEADER + HEAD + SUM + HEAD + 1 + SUM; /* behind the sections of 0 and 1 bytes */
    size_t a = HEAD + 7 + SUM, b = HEAD + 8 + SUM;
    memcpy(changed.bytes + first, whole.bytes + first + a, b);
    memcpy(changed.bytes + first + b, whole.bytes + first, a);
    file_write(path, changed.bytes, whole.size);
    assert_refused("the checksum of section 2 is wrong");
    /* One is left out, and what counts them put right. */
    memcpy(changed.bytes, whole.bytes, first);
    memcpy(changed.bytes + first, whole.bytes + first + a, whole.size - first - a);
    changed.bytes[whole.size - a - SUM - HEAD + 4]--;
    file_write(path, changed.bytes, whole.size - a);
    assert_refused("broken");
}

/* An end with the right checksum, behind `size` bytes of a file, that counts `number` sections. */
static void assert_end_refused(const Bytes *of, size_t size, uint32_t number, const char *part) {
    memcpy(changed.bytes, of->bytes, size);
    memset(changed.bytes + size, 0, HEAD);
    memcpy(changed.bytes + size, "END ", 4);
    memcpy(changed.bytes + size + 4, &number, 4);
    uint64_t sum = field_checksum(0, changed.bytes + size - SUM, SUM + HEAD);
    memcpy(changed.bytes + size + HEAD, &sum, SUM);
    file_write(path, changed.bytes, size + HEAD + SUM);
    if (part)
        assert_refused(part);
    else {
        FieldFile file;
        succeeds(field_file_open(&file, path));
        field_file_close(&file);
    }
}

static void refuses_ends_that_count_wrongly(void **state) {
    (void)state;
    size_t behind = whole.size - HEAD - SUM, row = HEAD + 1920 + SUM;
    assert_end_refused(&whole, behind, SECTIONS, NULL);
    assert_end_refused(&whole, behind, SECTIONS - 1, "its end is wrong");
    assert_end_refused(&whole, behind, SECTIONS + 1, "its end is wrong");
    assert_end_refused(&raw, HEADER + 9 * row, 9, NULL);
    assert_end_refused(&raw, HEADER + 5 * row, 5, "5 of 9 rows");
    assert_end_refused(&raw, HEADER, 0, "0 of 9 rows");
}

static void notices_that_a_file_shrinks(void **state) {
    (void)state;
    FieldFile file;
    file_write(path, raw.bytes, raw.size);
    succeeds(field_file_open(&file, path));
    assert_int_equal(truncate(path, HEADER + 3 * (HEAD + 1920 + SUM) - 1), 0);
    succeeds(field_file_section(&file, 1, scratch));
    assert_says(field_file_section(&file, 2, scratch), "truncated");
    assert_says(field_file_section(&file, 3, scratch), "truncated");
    assert_says(field_file_check(&file), "truncated");
    field_file_close(&file);
}

/* A header that says what it should not, with the right checksum; behind it 64 zeros. */
static void assert_header_refused(size_t at, const void *bytes, size_t count, const char *part) {
    memcpy(changed.bytes, raw.bytes, HEADER);
    memset(changed.bytes + HEADER, 0, 64);
    memcpy(changed.bytes + at, bytes, count);
    uint64_t sum = field_checksum(0, changed.bytes, HEADER - SUM);
    memcpy(changed.bytes + HEADER - SUM, &sum, SUM); /* (of little endian, as all machines that test this) */
    file_write(path, changed.bytes, HEADER + 64);
    assert_refused(part);
}

static void refuses_absurd_headers(void **state) {
    (void)state;
    struct rusage before, after;
    getrusage(RUSAGE_SELF, &before);
    static const uint32_t sides[] = {0, 1, 7, 1025, 1000000, 0x7fffffffu, 0x80000000u, 0xffffffffu};
    for (size_t at = 24; at < 40; at += 4)
        for (size_t i = 0; i < sizeof sides / sizeof *sides; i++)
            assert_header_refused(at, &sides[i], 4,
                                  sides[i] > 0x7fffffffu ? "its header says" : "a light field of ");
    assert_header_refused(24, (uint32_t[]){1000000, 1000000, 1000000, 1000000}, 16, "1000000x1000000");
    assert_header_refused(24, (uint32_t[]){9}, 4, "an odd number");
    assert_header_refused(32, (uint32_t[]){257}, 4, "more than 1024 texels along u or v, or 256");
    assert_header_refused(8, (uint32_t[]){2}, 4, "version 2: this program reads version 1");
    assert_header_refused(8, (uint32_t[]){0}, 4, "version 0");
    assert_header_refused(16, (uint32_t[]){3}, 4, "model is number 3");
    assert_header_refused(20, (uint32_t[]){3}, 4, "angles are number 3");
    assert_header_refused(20, (uint32_t[]){0xffffffffu}, 4, "its header says 4294967295");
    assert_header_refused(40, (uint32_t[]){0}, 4, "0 rays a texel");
    assert_header_refused(40, (uint32_t[]){4097}, 4, "4097 rays a texel");
    assert_header_refused(40, (uint32_t[]){0x80000000u}, 4, "its header says");
    assert_header_refused(44, (uint32_t[]){2}, 4, "through is 2");
    const double radii[] = {0, -0.0, -3.5, NAN, -NAN, INFINITY, -INFINITY, 1e300, 1e-300};
    for (size_t i = 0; i < sizeof radii / sizeof *radii; i++)
        assert_header_refused(48, &radii[i], 8, "a model of radius");
    assert_header_refused(56, (double[]){6}, 8, "a sphere of height 6");
    assert_header_refused(56, (double[]){NAN}, 8, "a sphere of height");
    for (size_t i = 0; i < sizeof radii / sizeof *radii; i++) {
        memcpy(scratch, raw.bytes + 16, 40);
        scratch[0] = FIELD_CYLINDER, memcpy(scratch + 40, &radii[i], 8);
        assert_header_refused(16, scratch, 48, "a cylinder of height");
    }
    assert_header_refused(64, "", 1, "no proper name");
    assert_header_refused(64, "a line\n", 7, "no proper name");
    assert_header_refused(64, "abcdefghijklmnopqrstuvwxyz", 24, "no proper name");
    assert_header_refused(96 + 20, (uint32_t[]){1}, 4, "a raw light field with a codec's parameters");
    /* And sections that promise too much, or do not fit the header. */
    uint64_t lengths_absurd[] = {1,         1920, 1ull << 32, 1ull << 62, UINT64_MAX - 23, UINT64_MAX - 24,
                                 UINT64_MAX};
    for (size_t i = 0; i < sizeof lengths_absurd / sizeof *lengths_absurd; i++) {
        memcpy(changed.bytes, raw.bytes, raw.size);
        memcpy(changed.bytes + HEADER + 8, &lengths_absurd[i], 8);
        if (lengths_absurd[i] == 1920) changed.bytes[HEADER] = 'r';
        file_write(path, changed.bytes, raw.size);
        assert_refused(lengths_absurd[i] <= 1920 ? "section 0 is not row 0 of 1920 bytes"
                                                 : "goes on beyond its end");
    }
    getrusage(RUSAGE_SELF, &after);
    assert_true(after.ru_maxrss - before.ru_maxrss < 4096); /* KiB */
}

/* A writer refuses the same headers, and writes nothing then. */
static void writers_refuse_too(void **state) {
    (void)state;
    FieldWriter writer;
    FieldHeader header = header_small();
    remove(path);
    header.field.u = 7;
    assert_says(field_writer_open(&writer, path, &header), "fewer than 8");
    header = header_small(), header.field.radius = NAN;
    assert_says(field_writer_open(&writer, path, &header), "radius");
    header = header_small(), header.scene[0] = ' ';
    assert_says(field_writer_open(&writer, path, &header), "no proper name");
    header = header_small();
    assert_says(field_writer_open(&writer, folder, &header), "not a regular file");
    assert_says(field_writer_open(&writer, "/dev/null/a.field", &header), "Not a directory");
    assert_false(is_there(partial));
    succeeds(field_writer_open(&writer, path, &header));
    add_rows(&writer, 8);
    assert_says(field_writer_finish(&writer), "8 of 9 rows");
    assert_says(field_writer_add(&writer, FIELD_ROWS, 7, scratch, 1920), "is not row 8");
    assert_says(field_writer_add(&writer, FIELD_ROWS, 8, scratch, 1919), "is not row 8 of 1920 bytes");
    assert_says(field_writer_add(&writer, FIELD_TAG('P', 'A', 'R', 'T'), 8, scratch, 1920), "is not row 8");
    assert_says(field_writer_add(&writer, FIELD_END, 8, scratch, 0), "the tag of the end");
    add_rows(&writer, 9);
    assert_says(field_writer_add(&writer, FIELD_ROWS, 9, scratch, 1920), "more rows");
    succeeds(field_writer_finish(&writer));
    field_writer_close(&writer);
    file_read(path, &changed);
    assert_int_equal(changed.size, raw.size);
    assert_memory_equal(changed.bytes, raw.bytes, raw.size);
}

/* ---- Going on ---- */

/* From a partial file of `size` bytes of `of`, `torn` more that are not as they should be, and `kept` whole
 * sections: the same file. */
static void assert_goes_on(const Bytes *of, size_t size, int torn, int kept) {
    FieldWriter writer;
    FieldHeader header = of == &raw ? header_small() : header_encoded();
    memcpy(changed.bytes, of->bytes, of->size);
    for (int i = 0; i < torn; i++) changed.bytes[size + (size_t)i] ^= 0x55;
    remove(path);
    file_write(partial, changed.bytes, size + (size_t)torn);
    succeeds(field_writer_open(&writer, path, &header));
    assert_int_equal(writer.file.count, kept);
    struct stat about;
    stat(partial, &about);
    assert_int_equal(about.st_size, writer.file.bytes); /* nothing that is torn is left */
    for (int i = 0; i < kept; i++) {                    /* what is there can be read */
        size_t length = (size_t)writer.file.sections[i].length;
        succeeds(field_file_section(&writer.file, i, scratch));
        fill(expected, length, i);
        assert_memory_equal(scratch, expected, length);
    }
    if (of == &raw)
        add_rows(&writer, 9);
    else
        add_sections(&writer);
    succeeds(field_writer_finish(&writer));
    field_writer_close(&writer);
    file_read(path, &changed);
    assert_int_equal(changed.size, of->size);
    assert_memory_equal(changed.bytes, of->bytes, of->size);
}

static void goes_on_behind_each_section(void **state) {
    (void)state;
    for (int i = 0; i < 2; i++) {
        const Bytes *of = i ? &raw : &whole;
        size_t at = HEADER, length;
        for (int k = 0; k <= (i ? 9 : SECTIONS); k++, at += HEAD + length + SUM) {
            bool last = k == (i ? 9 : SECTIONS);
            length = last ? 0 : i ? 1920 : lengths[k];
            size_t end = at + HEAD + length + SUM;
            assert_goes_on(of, at, 0, k);
            assert_goes_on(of, at + 1, 0, k);
            assert_goes_on(of, at + HEAD, 0, k);
            assert_goes_on(of, end - 1, 0, k);
            assert_goes_on(of, end - 1, 1, k);
            assert_goes_on(of, end - SUM - 1, 0, k);
            assert_goes_on(of, at, last ? 4 : 20, k);
            if (!last && length) assert_goes_on(of, end - SUM - 1, 1, k); /* the last byte of a payload */
        }
        assert_goes_on(of, of->size, 0, i ? 9 : SECTIONS); /* all but renamed */
        assert_goes_on(of, 0, 0, 0);
        assert_goes_on(of, 1, 0, 0);
        assert_goes_on(of, HEADER - 1, 0, 0);
    }
}

static void leaves_what_is_of_another_header(void **state) {
    (void)state;
    FieldWriter writer, second;
    FieldHeader header = header_small();
    header.samples++;
    file_write(partial, raw.bytes, raw.size - 100);
    assert_says(field_writer_open(&writer, path, &header), "a.field.partial is the beginning of another");
    header = header_small(), header.scene_key++;
    assert_says(field_writer_open(&writer, path, &header), "another light field");
    file_read(partial, &changed);
    assert_int_equal(changed.size, raw.size - 100);
    assert_memory_equal(changed.bytes, raw.bytes, changed.size);
    file_write(partial, raw.bytes, HEADER);
    assert_says(field_writer_open(&writer, path, &header), "another light field");
    header = header_small();
    memset(scratch, 'x', 300);
    file_write(partial, scratch, 300);
    assert_says(field_writer_open(&writer, path, &header),
                "a.field.partial is in its way: not a light field");
    remove(partial);
    succeeds(field_writer_open(&writer, path, &header)); /* nor what another is at */
    assert_says(field_writer_open(&second, path, &header), "another program is writing it");
    add_rows(&writer, 2);
    field_writer_close(&writer);
    succeeds(field_writer_open(&second, path, &header));
    assert_int_equal(second.file.count, 2);
    field_writer_close(&second);
    remove(partial);
}

/* A disk that is full, as far as one can have that here: a limit on the size of files. */
static void says_that_the_disk_is_full(void **state) {
    (void)state;
    FieldWriter writer;
    FieldHeader header = header_small();
    struct rlimit before, limit;
    remove(path);
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before);
    limit = before, limit.rlim_cur = 5000;
    succeeds(field_writer_open(&writer, path, &header));
    add_rows(&writer, 2);
    memset(scratch, 1, 1920);
    setrlimit(RLIMIT_FSIZE, &limit);
    const char *reason = field_writer_add(&writer, FIELD_ROWS, 2, scratch, 1920);
    setrlimit(RLIMIT_FSIZE, &before);
    assert_says(reason, "File too large");
    assert_int_equal(writer.file.count, 2);
    assert_false(is_there(path));
    add_rows(&writer, 9); /* what was torn is written over */
    succeeds(field_writer_finish(&writer));
    field_writer_close(&writer);
    file_read(path, &changed);
    assert_int_equal(changed.size, raw.size);
    assert_memory_equal(changed.bytes, raw.bytes, raw.size);
    /* Also where less comes behind it than was torn. */
    header = header_encoded();
    succeeds(field_writer_open(&writer, path, &header));
    setrlimit(RLIMIT_FSIZE, &limit);
    reason = field_writer_add(&writer, FIELD_ROWS, 0, scratch, sizeof scratch);
    setrlimit(RLIMIT_FSIZE, &before);
    assert_non_null(reason);
    succeeds(field_writer_add(&writer, FIELD_ROWS, 0, scratch, 10));
    succeeds(field_writer_finish(&writer));
    field_writer_close(&writer);
    FieldFile file;
    succeeds(field_file_open(&file, path));
    succeeds(field_file_check(&file));
    field_file_close(&file);
}

/* ---- The checksum ---- */

static void checksums_see_every_bit(void **state) {
    (void)state;
    uint8_t bytes[41];
    fill(bytes, sizeof bytes, 3);
    for (size_t count = 0; count < sizeof bytes; count++) {
        uint64_t sum = field_checksum(0, bytes, count);
        for (size_t bit = 0; bit < 8 * count; bit++) {
            bytes[bit / 8] ^= 1 << bit % 8;
            assert_true(field_checksum(0, bytes, count) != sum);
            bytes[bit / 8] ^= 1 << bit % 8;
        }
        assert_true(field_checksum(1, bytes, count) != sum);
        if (count % 8 == 0) /* it goes on */
            assert_true(field_checksum(sum, bytes + count, sizeof bytes - count) ==
                        field_checksum(0, bytes, sizeof bytes));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_come_back),
        cmocka_unit_test(sections_come_back),
        cmocka_unit_test(headers_come_back),
        cmocka_unit_test(scenes_are_told_apart),
        cmocka_unit_test(the_format_is_as_documented),
        cmocka_unit_test(refuses_what_is_no_light_field),
        cmocka_unit_test(refuses_truncated_files),
        cmocka_unit_test(refuses_changed_bytes),
        cmocka_unit_test(refuses_sections_in_another_order),
        cmocka_unit_test(refuses_ends_that_count_wrongly),
        cmocka_unit_test(notices_that_a_file_shrinks),
        cmocka_unit_test(refuses_absurd_headers),
        cmocka_unit_test(writers_refuse_too),
        cmocka_unit_test(goes_on_behind_each_section),
        cmocka_unit_test(leaves_what_is_of_another_header),
        cmocka_unit_test(says_that_the_disk_is_full),
        cmocka_unit_test(checksums_see_every_bit),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("field_file", tests, files_make, folder_remove);
}
