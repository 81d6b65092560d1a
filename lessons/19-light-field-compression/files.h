/* Encoded light fields in files (common/field_file.h). Their sections: what is made before the first band,
 * then band by band a section of each plane. */
#ifndef LESSON_FILES_H
#define LESSON_FILES_H

#include "codec.h"

/* The header of a file of a raw field, encoded. Its parameters are the knob, and a block's texels along u, v,
 * s and t. */
FieldHeader encoded_header(const FieldHeader *raw, const Codec *codec, int knob);

/* Opens a file and checks everything that its header and the heads of its sections say; encoded is then one
 * that holds nothing. NULL, or the reason in one line, without the file's name; there is then nothing to
 * close. */
const char *encoded_open(const char *path, FieldFile *file, Encoded *encoded);

/* Reads all planes into one that holds nothing, or only what one band needs in place of what it holds, and
 * checks that nothing in them refers to what is not there. NULL or the reason. */
const char *encoded_read(const FieldFile *file, Encoded *encoded);
const char *encoded_read_band(const FieldFile *file, Encoded *encoded, int band);

/* Encodes into a file, band by band, from where a file of the same name and header was left. */
typedef struct {
    FieldHeader header; /* encoded_header's */
    FieldSource source;
    int bands;   /* to have in the end; the file is finished if these are all */
    bool verify; /* read each band from the file again and hold it against its texels */
    bool quiet;  /* no progress on standard error */
} StreamOrder;

typedef struct {
    int begun, done;       /* bands that were there, and that are now */
    double source_seconds; /* that the source took, */
    double seconds;        /* and all the rest, what is done before the first band included */
    uint64_t bytes;        /* of the file so far, its end included if it is finished */
    EncodedError error;    /* of the bands made now, if they were verified */
} StreamReport;

/* Ends the program with a line that names the file if that cannot be. */
StreamReport encoded_stream(const char *path, const StreamOrder *order);

#endif
