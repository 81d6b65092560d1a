#define _GNU_SOURCE /* flock, and what turns bytes around */
#include "field_file.h"

#include "fail.h"
#include "synthesis.h"

#include <endian.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/* Bytes of the header, of what is in front of a payload (tag, number, length), of a checksum, and of what is
 * read at a time. */
enum { HEADER = 128, HEAD = 16, SUM = 8, CHUNK = 1 << 18 };

static const double size_least = 1e-6, size_most = 1e6; /* of a model, in the units of its scene */

void field_file_demand(const char *reason, const char *path) {
    if (reason) fail("%s: %s", path, reason);
}

/* ---- Numbers in bytes ---- */

static void put_32(uint8_t *at, uint32_t x) { memcpy(at, &(uint32_t){htole32(x)}, 4); }
static void put_64(uint8_t *at, uint64_t x) { memcpy(at, &(uint64_t){htole64(x)}, 8); }

static uint32_t get_32(const uint8_t *at) {
    uint32_t x;
    memcpy(&x, at, 4);
    return le32toh(x);
}

static uint64_t get_64(const uint8_t *at) {
    uint64_t x;
    memcpy(&x, at, 8);
    return le64toh(x);
}

static void put_double(uint8_t *at, double x) {
    uint64_t bits;
    memcpy(&bits, &x, 8);
    put_64(at, bits);
}

static double get_double(const uint8_t *at) {
    uint64_t bits = get_64(at);
    double x;
    memcpy(&x, &bits, 8);
    return x;
}

/* An odd number (of about as many ones as zeros), so that multiplying by it is one to one. */
static uint64_t stirred(uint64_t sum, uint64_t eight) {
    sum = (sum ^ eight) * 0x9e3779b97f4a7c15u;
    return sum ^ sum >> 32;
}

uint64_t field_checksum(uint64_t sum, const void *bytes, size_t count) {
    const uint8_t *at = bytes, *end = at + count / 8 * 8;
    for (; at < end; at += 8) sum = stirred(sum, get_64(at));
    uint8_t last[8] = {0};
    if (count % 8) memcpy(last, at, count % 8), sum = stirred(sum, get_64(last));
    return sum;
}

/* ---- Files: all that is asked for, or a reason ---- */

static const char *read_at(int descriptor, void *bytes, size_t count, uint64_t offset) {
    for (uint8_t *at = bytes; count > 0;) {
        ssize_t got = pread(descriptor, at, count, (off_t)offset);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return strerror(errno);
        if (got == 0) return "truncated";
        at += got, count -= (size_t)got, offset += (uint64_t)got;
    }
    return NULL;
}

static const char *write_at(int descriptor, const void *bytes, size_t count, uint64_t offset) {
    for (const uint8_t *at = bytes; count > 0;) {
        ssize_t written = pwrite(descriptor, at, count, (off_t)offset);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return strerror(errno);
        at += written, count -= (size_t)written, offset += (uint64_t)written;
    }
    return NULL;
}

/* ---- The header ---- */

static const char magic[] = "TXLFIELD";

static void header_write(const FieldHeader *header, uint8_t bytes[HEADER]) {
    const Field *field = &header->field;
    const uint32_t numbers[] = {FIELD_FILE_VERSION, header->codec,      field->model,
                                field->angles,      (uint32_t)field->u, (uint32_t)field->v,
                                (uint32_t)field->s, (uint32_t)field->t, (uint32_t)header->samples,
                                header->through};
    memset(bytes, 0, HEADER);
    memcpy(bytes, magic, 8);
    for (int i = 0; i < 10; i++) put_32(bytes + 8 + 4 * i, numbers[i]);
    put_double(bytes + 48, field->radius);
    put_double(bytes + 56, field->height);
    memcpy(bytes + 64, header->scene, strnlen(header->scene, FIELD_NAME));
    put_64(bytes + 88, header->scene_key);
    for (int i = 0; i < FIELD_PARAMETERS; i++) put_32(bytes + 96 + 4 * i, header->parameters[i]);
    put_64(bytes + HEADER - SUM, field_checksum(0, bytes, HEADER - SUM));
}

static uint64_t with_numbers(uint64_t sum, const double *numbers, int count) {
    uint8_t bytes[8];
    for (int i = 0; i < count; i++) put_double(bytes, numbers[i]), sum = field_checksum(sum, bytes, 8);
    return sum;
}

static uint64_t with_vector(uint64_t sum, Vec3 v) { return with_numbers(sum, (double[]){v.x, v.y, v.z}, 3); }

/* Of all that the scene's light depends on, but not of its name. */
static uint64_t scene_key(const LightScene *scene) {
    const double light[] = {LIGHT_AMBIENT,  LIGHT_DIFFUSE, LIGHT_SPECULAR,
                            LIGHT_EXPONENT, scene->count,  scene->effects};
    uint64_t sum = with_vector(with_numbers(0, light, 6), scene->toward_light);
    for (int i = 0; i < scene->count; i++) {
        const Solid *solid = &scene->solids[i];
        sum = with_vector(with_vector(with_vector(sum, solid->size), solid->centre), solid->turn_degrees);
        sum = with_vector(with_numbers(sum, (double[]){solid->kind}, 1), solid->colour);
        if (scene->effects) sum = with_numbers(sum, (double[]){scene->mirror[i], scene->clear[i]}, 2);
    }
    return sum;
}

FieldHeader field_header(const Field *field, const LightScene *scene, int samples, bool through) {
    FieldHeader header = {
        .field = *field, .samples = samples, .through = through, .scene_key = scene_key(scene)};
    strncpy(header.scene, scene->name, FIELD_NAME - 1); /* zeros up to its end */
    return header;
}

bool field_header_equal(const FieldHeader *a, const FieldHeader *b) {
    uint8_t one[HEADER], other[HEADER];
    header_write(a, one), header_write(b, other);
    return memcmp(one, other, HEADER) == 0;
}

static bool is_name(const char *scene) {
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    size_t length = strnlen(scene, FIELD_NAME);
    return length > 0 && length < FIELD_NAME && strspn(scene, plain) == length;
}

static bool is_size(double x) { return x >= size_least && x <= size_most; }

/* What may be in a file and what may not. */
static const char *header_refused(const FieldHeader *header) {
    const Field *field = &header->field;
    if (field->model > FIELD_ROOM) return because("its model is number %u, of 3", field->model);
    if (field->angles > ANGLES_STEREOGRAPHIC) return because("its angles are number %u, of 3", field->angles);
    if (field_refused(field))
        return because("a light field of %dx%dx%dx%d: %s", field->u, field->v, field->s, field->t,
                       field_refused(field));
    if (!is_size(field->radius)) return because("a model of radius %g", field->radius);
    bool cylinder = field->model == FIELD_CYLINDER;
    if (cylinder ? !is_size(field->height) : field->height != 0.0)
        return because("a %s of height %g", cylinder ? "cylinder" : "sphere", field->height);
    if (header->samples < 1 || header->samples > SAMPLES_MOST)
        return because("%d rays a texel: there may be 1 to %d", header->samples, SAMPLES_MOST);
    if (!is_name(header->scene)) return "its scene has no proper name";
    for (int i = 0; i < FIELD_PARAMETERS && header->codec == FIELD_RAW; i++)
        if (header->parameters[i]) return "a raw light field with a codec's parameters";
    return NULL;
}

static const char *header_read(FieldHeader *header, int descriptor, uint64_t bytes_of_file) {
    uint8_t bytes[HEADER];
    if (bytes_of_file == 0) return "empty";
    const char *failed =
        read_at(descriptor, bytes, bytes_of_file < HEADER ? (size_t)bytes_of_file : HEADER, 0);
    if (failed) return failed;
    if (bytes_of_file < 8 || memcmp(bytes, magic, 8) != 0) return "not a light field";
    if (bytes_of_file < HEADER) return "truncated within its header";
    uint32_t n[10];
    for (int i = 0; i < 10; i++) n[i] = get_32(bytes + 8 + 4 * i);
    if (n[0] != FIELD_FILE_VERSION)
        return because("a light field of version %u: this program reads version %d", n[0],
                       FIELD_FILE_VERSION);
    if (get_64(bytes + HEADER - SUM) != field_checksum(0, bytes, HEADER - SUM))
        return "broken: the checksum of its header is wrong";
    for (int i = 2; i < 9; i++)
        if (n[i] > INT_MAX) return because("broken: its header says %u", n[i]);
    if (n[9] > 1) return because("broken: through is %u, neither 0 nor 1", n[9]);
    *header = (FieldHeader){
        .field = {.model = n[2],
                  .angles = n[3],
                  .radius = get_double(bytes + 48),
                  .height = get_double(bytes + 56),
                  .u = (int)n[4],
                  .v = (int)n[5],
                  .s = (int)n[6],
                  .t = (int)n[7]},
        .samples = (int)n[8],
        .through = n[9],
        .scene_key = get_64(bytes + 88),
        .codec = n[1],
    };
    memcpy(header->scene, bytes + 64, FIELD_NAME);
    for (int i = 0; i < FIELD_PARAMETERS; i++) header->parameters[i] = get_32(bytes + 96 + 4 * i);
    return header_refused(header);
}

/* ---- Sections ---- */

/* What a raw field's section must be: row `index`. */
static const char *section_refused(const FieldHeader *header, int index, const FieldSection *section) {
    if (index == FIELD_SECTIONS_MOST) return because("more than %d sections", FIELD_SECTIONS_MOST);
    if (header->codec != FIELD_RAW) return NULL;
    size_t row = field_row(&header->field);
    if (index >= header->field.v) return "more rows than its header says";
    if (section->tag != FIELD_ROWS || section->number != (uint32_t)index || section->length != row)
        return because("section %d is not row %d of %zu bytes", index, index, row);
    return NULL;
}

/* Adds a section, making room in powers of two. */
static void section_add(FieldFile *file, FieldSection section) {
    if ((file->count & (file->count - 1)) == 0) {
        size_t room = file->count ? 2 * (size_t)file->count : 1;
        file->sections = realloc(file->sections, room * sizeof section);
        if (!file->sections) fail("out of memory for %zu sections of a light field", room);
    }
    file->sections[file->count++] = section;
}

/* The head of the section that begins at `at`, if all of it lies in the file. */
static const char *section_at(const FieldFile *file, uint64_t at, FieldSection *section) {
    uint8_t head[HEAD];
    if (file->bytes - at < HEAD + SUM) return because("truncated: no end behind %d sections", file->count);
    const char *failed = read_at(file->descriptor, head, HEAD, at);
    if (failed) return failed;
    *section = (FieldSection){get_32(head), get_32(head + 4), get_64(head + 8), at + HEAD};
    if (section->length > file->bytes - at - HEAD - SUM)
        return because("truncated: section %d of %llu bytes goes on beyond its end", file->count,
                       (unsigned long long)section->length);
    return NULL;
}

static uint64_t section_end(const FieldSection *section) { return section->offset + section->length + SUM; }

static const char wrong[] = "a wrong checksum";

/* Reads a payload and checks it. Its checksum goes on from the bytes in front of it: the checksum before
 * it, and its own head. */
static const char *section_read(const FieldFile *file, const FieldSection *section, uint8_t *payload) {
    uint8_t before[SUM + HEAD], after[SUM], *chunk = payload ? NULL : allocate(1, CHUNK);
    const char *failed = read_at(file->descriptor, before, sizeof before, section->offset - sizeof before);
    uint64_t sum = failed ? 0 : field_checksum(0, before, sizeof before), at = 0;
    while (!failed && at < section->length) {
        size_t count = section->length - at < CHUNK ? (size_t)(section->length - at) : CHUNK;
        uint8_t *to = payload ? payload + at : chunk;
        failed = read_at(file->descriptor, to, count, section->offset + at);
        if (!failed) sum = field_checksum(sum, to, count), at += count;
    }
    free(chunk);
    if (!failed) failed = read_at(file->descriptor, after, SUM, section->offset + section->length);
    return failed ? failed : get_64(after) == sum ? NULL : wrong;
}

const char *field_file_section(const FieldFile *file, int index, void *payload) {
    if (index < 0 || index >= file->count) return because("no section %d of %d", index, file->count);
    const char *failed = section_read(file, &file->sections[index], payload);
    return failed == wrong ? because("broken: the checksum of section %d is wrong", index) : failed;
}

const char *field_file_check(const FieldFile *file) {
    const char *failed = NULL;
    for (int i = 0; i < file->count && !failed; i++) failed = field_file_section(file, i, NULL);
    return failed;
}

int field_file_find(const FieldFile *file, uint32_t tag, uint32_t number) {
    for (int i = 0; i < file->count; i++)
        if (file->sections[i].tag == tag && file->sections[i].number == number) return i;
    return -1;
}

/* ---- Reading ---- */

/* All sections up to the end. */
static const char *sections_find(FieldFile *file) {
    for (uint64_t at = HEADER;;) {
        FieldSection section;
        const char *refused = section_at(file, at, &section);
        if (refused) return refused;
        if (section.tag == FIELD_END) {
            if (section.length || section.number != (uint32_t)file->count ||
                section_read(file, &section, NULL))
                return "broken: its end is wrong";
            if (section_end(&section) != file->bytes)
                return because("goes on for %llu bytes behind its end",
                               (unsigned long long)(file->bytes - section_end(&section)));
            if (file->header.codec == FIELD_RAW && file->count != file->header.field.v)
                return because("%d of %d rows", file->count, file->header.field.v);
            return NULL;
        }
        refused = section_refused(&file->header, file->count, &section);
        if (refused) return refused;
        section_add(file, section);
        at = section_end(&section);
    }
}

static const char *file_size(FieldFile *file) {
    struct stat about;
    if (fstat(file->descriptor, &about) != 0) return strerror(errno);
    if (S_ISDIR(about.st_mode)) return strerror(EISDIR);
    if (!S_ISREG(about.st_mode)) return "not a regular file";
    file->bytes = (uint64_t)about.st_size;
    return NULL;
}

const char *field_file_open(FieldFile *file, const char *path) {
    FieldFile opened = {.descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK)}; /* a pipe: no wait */
    if (opened.descriptor < 0) return strerror(errno);
    const char *failed = file_size(&opened);
    if (!failed) failed = header_read(&opened.header, opened.descriptor, opened.bytes);
    if (!failed) failed = sections_find(&opened);
    if (failed)
        field_file_close(&opened);
    else
        *file = opened;
    return failed;
}

void field_file_close(FieldFile *file) {
    close(file->descriptor);
    free(file->sections);
    *file = (FieldFile){.descriptor = -1};
}

/* ---- Writing ---- */

/* Keeps the sections that are whole; the end of a file that was never renamed is not among them. */
static const char *sections_keep(FieldFile *file) {
    uint64_t at = HEADER;
    FieldSection section;
    while (!section_at(file, at, &section) && section.tag != FIELD_END &&
           !section_refused(&file->header, file->count, &section) && !section_read(file, &section, NULL)) {
        section_add(file, section);
        at = section_end(&section);
    }
    if (ftruncate(file->descriptor, (off_t)at) != 0) return strerror(errno);
    file->bytes = at;
    return NULL;
}

/* Locks what is open under the name `partial`, which the program that had it before may have renamed. */
static const char *partial_lock(const FieldFile *file, const char *partial) {
    struct stat here, there;
    if (flock(file->descriptor, LOCK_EX | LOCK_NB) != 0)
        return errno == EWOULDBLOCK ? "another program is writing it" : strerror(errno);
    if (fstat(file->descriptor, &here) != 0 || stat(partial, &there) != 0 || here.st_ino != there.st_ino ||
        here.st_dev != there.st_dev)
        return "another program was writing it";
    return NULL;
}

static const char *partial_begin(FieldFile *file, const FieldHeader *header, const char *partial) {
    uint8_t bytes[HEADER];
    const char *failed = file_size(file);
    if (!failed) failed = partial_lock(file, partial);
    if (!failed) failed = file_size(file); /* nobody else changes it from here on */
    if (failed) return failed;
    if (file->bytes >= HEADER) {
        char reason[256] = ""; /* of its own, for both come from because */
        failed = header_read(&file->header, file->descriptor, file->bytes);
        if (failed) snprintf(reason, sizeof reason, "%s", failed);
        if (failed) return because("%s is in its way: %s", partial, reason);
        if (!field_header_equal(&file->header, header))
            return because("%s is the beginning of another light field: remove it to begin anew", partial);
        return sections_keep(file);
    }
    header_write(header, bytes);
    failed = write_at(file->descriptor, bytes, HEADER, 0);
    file->header = *header, file->bytes = HEADER;
    return failed;
}

const char *field_writer_open(FieldWriter *writer, const char *path, const FieldHeader *header) {
    const char *failed = header_refused(header);
    if (failed) return failed;
    struct stat about;
    if (stat(path, &about) == 0 && !S_ISREG(about.st_mode)) return "not a regular file";
    FieldWriter opened = {.path = text("%s", path), .partial = text("%s.partial", path)};
    opened.file.descriptor = open(opened.partial, O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666);
    failed =
        opened.file.descriptor < 0 ? strerror(errno) : partial_begin(&opened.file, header, opened.partial);
    if (failed)
        field_writer_close(&opened);
    else
        *writer = opened;
    return failed;
}

void field_writer_close(FieldWriter *writer) {
    if (writer->file.descriptor >= 0) field_file_close(&writer->file);
    free(writer->path);
    free(writer->partial);
    *writer = (FieldWriter){.file = {.descriptor = -1}};
}

/* Writes a section, or the end. */
static const char *section_write(FieldFile *file, const FieldSection *section, const void *payload) {
    uint8_t before[SUM + HEAD], after[SUM];
    const char *failed = read_at(file->descriptor, before, SUM, file->bytes - SUM);
    put_32(before + SUM, section->tag);
    put_32(before + SUM + 4, section->number);
    put_64(before + SUM + 8, section->length);
    if (!failed) failed = write_at(file->descriptor, before + SUM, HEAD, file->bytes);
    if (!failed) failed = write_at(file->descriptor, payload, (size_t)section->length, section->offset);
    if (failed) return failed;
    put_64(after, field_checksum(field_checksum(0, before, sizeof before), payload, (size_t)section->length));
    return write_at(file->descriptor, after, SUM, section->offset + section->length);
}

const char *field_writer_add(FieldWriter *writer, uint32_t tag, uint32_t number, const void *payload,
                             uint64_t length) {
    FieldFile *file = &writer->file;
    FieldSection section = {tag, number, length, file->bytes + HEAD};
    const char *failed = tag == FIELD_END ? "a section with the tag of the end"
                                          : section_refused(&file->header, file->count, &section);
    if (!failed) failed = section_write(file, &section, payload);
    if (failed) return failed;
    section_add(file, section);
    file->bytes = section_end(&section);
    return NULL;
}

const char *field_writer_finish(FieldWriter *writer) {
    FieldFile *file = &writer->file;
    if (file->header.codec == FIELD_RAW && file->count != file->header.field.v)
        return because("%d of %d rows", file->count, file->header.field.v);
    FieldSection end = {FIELD_END, (uint32_t)file->count, 0, file->bytes + HEAD};
    const char *failed = section_write(file, &end, "");
    if (failed) return failed;
    if (ftruncate(file->descriptor, (off_t)section_end(&end)) != 0)
        return strerror(errno); /* a failed add's */
    if (fsync(file->descriptor) != 0 || rename(writer->partial, writer->path) != 0) return strerror(errno);
    return NULL;
}
