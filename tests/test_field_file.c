/* Files of light fields: what comes back, what goes on, and all that must be refused. */
#define _GNU_SOURCE
#include "field_file.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>

#include "random.h"

#include <fcntl.h>
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
    uint64_t sum = 0, word; /* the header's checksum, in the plainest way */
    for (int i = 0; i < 120; i += 8) {
        memcpy(&word, raw.bytes + i, 8);
        sum = (sum ^ word) * 0x9e3779b97f4a7c15u;
        sum ^= sum >> 32;
    }
    memcpy(&word, raw.bytes + 120, 8);
    assert_true(sum == word);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_come_back),
        cmocka_unit_test(sections_come_back),
        cmocka_unit_test(headers_come_back),
        cmocka_unit_test(the_format_is_as_documented),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("field_file", tests, files_make, folder_remove);
}
