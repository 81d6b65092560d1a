#define _GNU_SOURCE /* mkdtemp */
#include "encoder.h"

#include "fail.h"
#include "files.h"
#include "stage.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/* Starts a program whose standard output is read from the file returned. */
static FILE *start(char *const arguments[], pid_t *process) {
    int ends[2];
    if (pipe(ends) != 0 || (*process = fork()) < 0)
        fail("%s: cannot be started: %s", arguments[0], strerror(errno));
    if (*process == 0) {
        dup2(ends[1], STDOUT_FILENO);
        close(ends[0]), close(ends[1]);
        execv(arguments[0], arguments);
        _exit(127);
    }
    close(ends[1]);
    FILE *output = fdopen(ends[0], "r");
    if (!output) fail("%s: cannot be read: %s", arguments[0], strerror(errno));
    return output;
}

/* Lines of a name and a number. */
static Encoder listen(FILE *output) {
    Encoder encoder = {0};
    char line[256];
    while (fgets(line, sizeof line, output)) {
        unsigned long long bytes;
        if (sscanf(line, "bytes %llu", &bytes) == 1) encoder.bytes = bytes;
        sscanf(line, "encode_seconds %lf", &encoder.seconds);
        sscanf(line, "peak_memory_mib %lf", &encoder.peak_memory_mib);
    }
    return encoder;
}

Encoder encoder_run(const Field *field, const char *from, const Codec *codec, int knob, Encoded *encoded) {
    char *program = project_path("build/19-encode"), *folder = project_path("build/cache");
    mkdir(folder, 0777);
    char *place = text("%s/encoded-XXXXXX", folder);
    if (!mkdtemp(place)) fail("%s: cannot be made: %s", place, strerror(errno));
    char *path = text("%s/field", place), *knob_text = text("%d", knob);
    char *size = text("%dx%dx%dx%d", field->u, field->v, field->s, field->t);
    char *arguments[] = {program,
                         "make",
                         path,
                         "--technique",
                         (char *)codec->name,
                         "--knob",
                         knob_text,
                         from ? "--from" : "--size",
                         from ? (char *)from : size,
                         NULL};
    pid_t process;
    int status;
    FILE *output = start(arguments, &process);
    Encoder encoder = listen(output);
    fclose(output);
    bool good = waitpid(process, &status, 0) == process && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    FieldFile file;
    const char *refused = good ? encoded_open(path, &file, encoded) : NULL;
    if (good && !refused) {
        refused = encoded_read(&file, encoded);
        field_file_close(&file);
    }
    unlink(path);
    char *partial = text("%s.partial", path);
    unlink(partial), rmdir(place);
    if (!good) fail("%s: failed, or is not there: make all", program);
    field_file_demand(refused, path);
    free(program), free(folder), free(place), free(path), free(knob_text), free(size), free(partial);
    return encoder;
}
