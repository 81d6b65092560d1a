#define _GNU_SOURCE /* getline, strsep */
#include "only.h"

#include "fail.h"
#include "lesson.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SCENE, TECHNIQUE, KNOB, VIEW, METRIC, COLUMNS };

typedef struct {
    char *line; /* owns the fields */
    const char *fields[COLUMNS];
} Row;

struct Only {
    Row *rows;
    int count;
};

/* Splits a line, which the row then owns; false if it has too few fields. */
static bool split(char *line, Row *row) {
    line[strcspn(line, "\r\n")] = '\0';
    row->line = line;
    for (int i = 0; i < COLUMNS; i++)
        if (!(row->fields[i] = strsep(&line, ","))) return false;
    return true;
}

Only *only_load(const char *path) {
    static const char *const names[COLUMNS] = {"scene", "technique", "knob", "view", "metric"};
    FILE *file = fopen(path, "r");
    if (!file) fail("%s: %s", path, strerror(errno));
    Only *only = allocate(1, sizeof *only);
    char *line = NULL;
    size_t size = 0;
    for (int number = 1; getline(&line, &size, file) > 0; number++) {
        Row row;
        if (!split(line, &row)) fail("%s: line %d has fewer than %d fields", path, number, COLUMNS);
        for (int i = 0; number == 1 && i < COLUMNS; i++)
            if (strcmp(row.fields[i], names[i])) fail("%s: column %d is not %s", path, i + 1, names[i]);
        if (number == 1) continue;
        only->rows = realloc(only->rows, (size_t)(only->count + 1) * sizeof *only->rows);
        if (!only->rows) fail("out of memory");
        only->rows[only->count++] = row;
        line = NULL; /* the row has it */
    }
    free(line);
    fclose(file);
    return only;
}

void only_destroy(Only *only) {
    if (!only) return;
    for (int i = 0; i < only->count; i++) free(only->rows[i].line);
    free(only->rows);
    free(only);
}

static bool matches(const char *wanted, const char *name) { return !name || strcmp(wanted, name) == 0; }

bool only_wants(const Only *only, const char *scene, const char *technique, double knob, const char *view,
                const char *metric) {
    if (!only) return true;
    char number[32] = "";
    if (knob > 0.0) snprintf(number, sizeof number, "%g", knob);
    for (int i = 0; i < only->count; i++) {
        const char *const *fields = only->rows[i].fields;
        if (matches(fields[SCENE], scene) && matches(fields[TECHNIQUE], technique) &&
            (knob == ONLY_ANY_KNOB || matches(fields[KNOB], number)) &&
            (matches(fields[VIEW], view) || strcmp(fields[VIEW], "-") == 0) &&
            matches(fields[METRIC], metric))
            return true;
    }
    return false;
}

bool only_names_view(const Only *only, const char *scene, const char *view) {
    bool named = !only;
    for (int i = 0; only && i < only->count; i++)
        named = named ||
                (matches(only->rows[i].fields[SCENE], scene) && matches(only->rows[i].fields[VIEW], view));
    return named;
}

bool shots_want(const Shots *shots, const View *view, const char *metric) {
    const Frame *frame = shots->frame;
    return only_wants(shots->only, frame->scene->name, frame->technique->name, frame->knob,
                      view ? view->name : "-", metric);
}
