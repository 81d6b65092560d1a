/* Files of light-field textures, raw or encoded. The format, which assets/README.md describes byte by
 * byte: a header, sections, and an end; each has a checksum, and is chained to what is
 * before it. Such a file may be far larger than memory: it is written and read section by section.
 *
 * What can fail returns NULL when all went well, else the reason in one line, without the file's name, valid
 * until the thread's next call. field_file_demand ends the program with it. */
#ifndef TEXEL_FIELD_FILE_H
#define TEXEL_FIELD_FILE_H

#include "light_field.h"
#include "light_scene.h"

enum {
    FIELD_FILE_VERSION = 1,
    FIELD_RAW = 0,        /* a codec: texels as they are; all other numbers are those of who encodes */
    FIELD_NAME = 24,      /* bytes of a scene's name, its end included */
    FIELD_PARAMETERS = 6, /* of a codec */
    FIELD_SECTIONS_MOST = 1 << 20, /* of a file */
};

/* A section's tag: four letters, which are what an editor shows of it. A raw field's sections are the rows of
 * v, from 0 on, each field_row bytes as synthesis_rows makes them. */
#define FIELD_TAG(a, b, c, d) ((uint32_t)(a) | (uint32_t)(b) << 8 | (uint32_t)(c) << 16 | (uint32_t)(d) << 24)
#define FIELD_ROWS FIELD_TAG('R', 'O', 'W', 'S')
#define FIELD_END FIELD_TAG('E', 'N', 'D', ' ') /* the container's own */

/* What a light field is: two of equal headers have the same texels. */
typedef struct {
    Field field;
    int samples;            /* rays a texel */
    bool through;           /* see synthesis.h */
    char scene[FIELD_NAME]; /* letters, digits, - and _ */
    uint64_t scene_key;     /* a checksum of all numbers that the scene consists of */
    uint32_t codec;
    uint32_t parameters[FIELD_PARAMETERS]; /* the codec's own; a raw field's are 0 */
} FieldHeader;

/* The header of a raw field. */
FieldHeader field_header(const Field *field, const LightScene *scene, int samples, bool through);

/* Whether two headers say the same. */
bool field_header_equal(const FieldHeader *a, const FieldHeader *b);

typedef struct {
    uint32_t tag, number;    /* number: which of its kind, as its writer says */
    uint64_t length, offset; /* of the payload in the file, in bytes */
} FieldSection;

typedef struct {
    FieldHeader header;
    int count;
    FieldSection *sections;
    uint64_t bytes; /* of the whole file */
    int descriptor;
} FieldFile;

/* Opens a whole file: header, the sections' places and the end are checked, before any memory is asked for
 * that they speak of; payloads are checked when they are read. Refused: what is no light field, another
 * version, a field that field_refused refuses or that has no finite size, a raw field of other sections than
 * its rows, what is truncated, and what goes on behind its end. field_file_close frees it; where the opening
 * failed there is nothing to close. */
const char *field_file_open(FieldFile *file, const char *path);
void field_file_close(FieldFile *file);

/* Reads section `index` of count: its length bytes into payload, or nowhere if that is NULL, and checks them.
 * Several threads may do so at once. */
const char *field_file_section(const FieldFile *file, int index, void *payload);

/* Checks all sections. */
const char *field_file_check(const FieldFile *file);

/* The index of the section with that tag and number, or -1. */
int field_file_find(const FieldFile *file, uint32_t tag, uint32_t number);

/* A file that is being made. It is PATH.partial until it is finished, so that PATH is whole or not there. */
typedef struct {
    FieldFile file; /* what it holds so far: field_file_section reads that too */
    char *path, *partial;
} FieldWriter;

/* Begins a file, or goes on with a PATH.partial that begins with the same header: the sections that are whole
 * are kept (file.count of them), and what is torn behind them is cut off. A PATH.partial of another header is
 * refused, for hours may be in it, and so is one that another program is writing. field_writer_close frees
 * it, finished or not. */
const char *field_writer_open(FieldWriter *writer, const char *path, const FieldHeader *header);
void field_writer_close(FieldWriter *writer);

/* Appends a section. Where that fails (a full disk), what is torn is cut off when the file is opened again.
 */
const char *field_writer_add(FieldWriter *writer, uint32_t tag, uint32_t number, const void *payload,
                             uint64_t length);

/* Writes the end, and renames PATH.partial to PATH, once it is on the disk. */
const char *field_writer_finish(FieldWriter *writer);

/* Ends the program with "PATH: reason", unless reason is NULL. */
void field_file_demand(const char *reason, const char *path);

/* The checksum, going on from `sum`: eight bytes at a time, the last ones filled up with zeros. Each step is
 * one to one, so bytes that differ in one such group of eight alone never have the same sum. */
uint64_t field_checksum(uint64_t sum, const void *bytes, size_t count);

#endif
