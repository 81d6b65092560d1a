#include "files.h"

#include "clock.h"
#include "fail.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Headers ---- */

FieldHeader encoded_header(const FieldHeader *raw, const Codec *codec, int knob) {
    FieldHeader header = *raw;
    const uint32_t parameters[FIELD_PARAMETERS] = {(uint32_t)knob, (uint32_t)codec->block.u,
                                                   (uint32_t)codec->block.v, (uint32_t)codec->block.s,
                                                   (uint32_t)codec->block.t};
    header.codec = codec->number;
    memcpy(header.parameters, parameters, sizeof parameters);
    return header;
}

static const char *header_refused(const FieldHeader *header) {
    const Codec *codec = codec_numbered(header->codec);
    if (header->codec == FIELD_RAW) return "is not encoded";
    if (!codec) return because("its codec is number %u, which this program does not know", header->codec);
    if (header->parameters[0] < (uint32_t)codec->knobs[0] ||
        header->parameters[0] > (uint32_t)codec->knobs[1])
        return because("%s with the knob %u: it goes from %d to %d", codec->name, header->parameters[0],
                       codec->knobs[0], codec->knobs[1]);
    FieldHeader own = encoded_header(header, codec, (int)header->parameters[0]);
    if (!field_header_equal(&own, header)) return because("%s with blocks of another size", codec->name);
    return NULL;
}

/* ---- Sections ---- */

typedef struct {
    int whole, banded; /* planes of either kind */
} Kinds;

static Kinds kinds_of(const Codec *codec) {
    Kinds kinds = {0, 0};
    for (int i = 0; i < PLANES_MAX && codec->planes[i].tag; i++)
        codec->planes[i].whole ? kinds.whole++ : kinds.banded++;
    return kinds;
}

/* The plane that section `index` is of, and its band. Whole planes come first. */
static int plane_of(const Codec *codec, int index, int *band) {
    Kinds kinds = kinds_of(codec);
    *band = index < kinds.whole ? 0 : (index - kinds.whole) / kinds.banded;
    return index < kinds.whole ? index : kinds.whole + (index - kinds.whole) % kinds.banded;
}

static const char *section_refused(const Encoded *encoded, int index, const FieldSection *section) {
    int band, plane = plane_of(encoded->codec, index, &band);
    int64_t size = encoded->codec->size(encoded, plane, band);
    if (section->tag != encoded->planes[plane].tag || section->number != (uint32_t)band)
        return because("section %d is not what %s has there", index, encoded->codec->name);
    if (size >= 0 && section->length != (uint64_t)size)
        return because("section %d has %llu bytes, not %lld", index, (unsigned long long)section->length,
                       (long long)size);
    return NULL;
}

const char *encoded_open(const char *path, FieldFile *file, Encoded *encoded) {
    FieldFile opened;
    const char *refused = field_file_open(&opened, path);
    if (refused) return refused;
    refused = header_refused(&opened.header);
    if (!refused) {
        const Codec *codec = codec_numbered(opened.header.codec);
        Encoded empty = encoded_create(codec, &opened.header.field, (int)opened.header.parameters[0]);
        Kinds kinds = kinds_of(codec);
        int sections = kinds.whole + kinds.banded * codec_bands(codec, &empty.field);
        if (opened.count != sections) refused = because("%d of %d sections", opened.count, sections);
        for (int i = 0; i < opened.count && !refused; i++)
            refused = section_refused(&empty, i, &opened.sections[i]);
        if (!refused) *file = opened, *encoded = empty;
    }
    if (refused) field_file_close(&opened);
    return refused;
}

/* ---- Reading ---- */

static const char *append(const FieldFile *file, int index, Plane *plane) {
    return field_file_section(file, index, plane_extend(plane, (size_t)file->sections[index].length));
}

static const char *unless_refers(const Encoded *encoded) {
    return encoded->codec->refers(encoded) ? NULL : "broken: it refers to what is not there";
}

const char *encoded_read(const FieldFile *file, Encoded *encoded) {
    const char *refused = NULL;
    for (int i = 0, band; i < file->count && !refused; i++)
        refused = append(file, i, &encoded->planes[plane_of(encoded->codec, i, &band)]);
    return refused ? refused : unless_refers(encoded);
}

const char *encoded_read_band(const FieldFile *file, Encoded *encoded, int wanted) {
    const char *refused = NULL;
    for (int i = 0; i < PLANES_MAX; i++) encoded->planes[i].before = encoded->planes[i].bytes = 0;
    for (int i = 0, band; i < file->count && !refused; i++) {
        Plane *plane = &encoded->planes[plane_of(encoded->codec, i, &band)];
        if (plane->whole || band == wanted)
            refused = append(file, i, plane);
        else if (band < wanted)
            plane->before += (size_t)file->sections[i].length;
    }
    return refused ? refused : unless_refers(encoded);
}

/* ---- Writing ---- */

/* A line in two seconds at most. */
static void say_progress(const StreamOrder *order, const StreamReport *report, double start) {
    static double said;
    double now = clock_seconds();
    if (order->quiet || now - (said > 0 ? said : start) < 2.0) return;
    said = now;
    fprintf(stderr, "encoding %s: %d of %d bands, about %.0f s left\n", order->header.scene, report->done,
            order->bands, (now - start) / (report->done - report->begun) * (order->bands - report->done));
}

/* What of a band is not in the file yet: a stop may have come between its planes. Encoding it again makes the
 * same bytes. */
static void write_band(FieldWriter *writer, const Encoded *encoded, int band) {
    Kinds kinds = kinds_of(encoded->codec);
    for (int plane = kinds.whole; plane < kinds.whole + kinds.banded; plane++) {
        const Plane *from = &encoded->planes[plane];
        if (writer->file.count > plane + band * kinds.banded) continue;
        field_file_demand(field_writer_add(writer, from->tag, (uint32_t)band, from->data, from->bytes),
                          writer->partial);
    }
}

/* The planes before the first band: from the file, or made now. */
static void begin(FieldWriter *writer, Encoded *encoded, const FieldSource *source) {
    int whole = kinds_of(encoded->codec).whole;
    if (!encoded->codec->begin) return;
    if (writer->file.count >= whole) {
        for (int i = 0; i < whole; i++)
            field_file_demand(append(&writer->file, i, &encoded->planes[i]), writer->partial);
        return;
    }
    encoded->codec->begin(encoded, source);
    for (int i = writer->file.count; i < whole; i++)
        field_file_demand(field_writer_add(writer, encoded->planes[i].tag, 0, encoded->planes[i].data,
                                           encoded->planes[i].bytes),
                          writer->partial);
}

/* Forgets a band, but for how much it was. */
static void pass_on(Encoded *encoded) {
    for (int i = 0; i < PLANES_MAX; i++) {
        Plane *plane = &encoded->planes[i];
        if (plane->whole) continue;
        plane->before += plane->bytes;
        plane->bytes = 0;
    }
}

typedef struct {
    const FieldSource *source;
    double seconds;
} Timed;

static void rows_timed(const void *data, int first, int rows, uint8_t *texels) {
    Timed *timed = (Timed *)data;
    double start = clock_seconds();
    timed->source->rows(timed->source->data, first, rows, texels);
    timed->seconds += clock_seconds() - start;
}

StreamReport encoded_stream(const char *path, const StreamOrder *order) {
    const FieldHeader *header = &order->header;
    const Codec *codec = codec_numbered(header->codec);
    const Field *field = &header->field;
    Kinds kinds = kinds_of(codec);
    double start = clock_seconds();
    FieldWriter writer;
    field_file_demand(field_writer_open(&writer, path, header), path);
    Timed timed = {&order->source, 0.0};
    FieldSource source = {rows_timed, &timed};
    Encoded encoded = encoded_create(codec, field, (int)header->parameters[0]), again = encoded;
    StreamReport report = {0};
    begin(&writer, &encoded, &source);
    report.begun = report.done = (writer.file.count - kinds.whole) / kinds.banded;
    for (int i = 0, band; i < writer.file.count; i++) {
        Plane *plane = &encoded.planes[plane_of(codec, i, &band)];
        if (!plane->whole && band < report.begun) plane->before += (size_t)writer.file.sections[i].length;
    }
    uint8_t *texels = allocate((size_t)codec->block.v, field_row(field));
    for (int band = report.begun; band < order->bands; band++) {
        int first = band * codec->block.v,
            rows = field->v - first < codec->block.v ? field->v - first : codec->block.v;
        source.rows(source.data, first, rows, texels);
        codec->encode(&encoded, band, rows, texels);
        write_band(&writer, &encoded, band);
        pass_on(&encoded);
        report.done++;
        if (order->verify) {
            field_file_demand(encoded_read_band(&writer.file, &again, band), writer.partial);
            report.error = error_sum(report.error, encoded_error(&again, first, rows, texels));
        }
        say_progress(order, &report, start);
    }
    if (order->bands == codec_bands(codec, field)) field_file_demand(field_writer_finish(&writer), path);
    report.bytes = writer.file.bytes + (order->bands == codec_bands(codec, field) ? 24 : 0);
    report.source_seconds = timed.seconds;
    report.seconds = clock_seconds() - start - timed.seconds;
    field_writer_close(&writer);
    encoded_destroy(&encoded), encoded_destroy(&again);
    free(texels);
    return report;
}
