#define _GNU_SOURCE /* open_memstream */
#include "table.h"

#include "fail.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct Table {
    const char *lesson, *scene, *technique;
    char knob[32];
    FILE *rows, *curves;
    char *rows_text, *curves_text;
    size_t rows_size, curves_size;
    int point_count;
};

Table *table_create(const char *lesson) {
    Table *table = allocate(1, sizeof *table);
    table->lesson = lesson;
    table->rows = open_memstream(&table->rows_text, &table->rows_size);
    table->curves = open_memstream(&table->curves_text, &table->curves_size);
    if (!table->rows || !table->curves) fail("out of memory");
    fputs("lesson,scene,technique,knob,view,metric,value,unit\n", table->rows);
    fputs("lesson,scene,technique,knob,view,curve,x_name,x,y_name,y\n", table->curves);
    return table;
}

void table_destroy(Table *table) {
    fclose(table->rows);
    fclose(table->curves);
    free(table->rows_text);
    free(table->curves_text);
    free(table);
}

void table_set(Table *table, const char *scene, const char *technique, double knob) {
    table->scene = scene;
    table->technique = technique;
    table->knob[0] = '\0';
    if (knob > 0.0) snprintf(table->knob, sizeof table->knob, "%g", knob);
}

static void require_finite(const Table *table, const char *name, double value) {
    if (!isfinite(value))
        fail("%s of %s/%s/%s is not a finite number", name, table->lesson, table->scene, table->technique);
}

void table_row(Table *table, const char *view, const char *metric, double value, const char *unit) {
    require_finite(table, metric, value);
    fprintf(table->rows, "%s,%s,%s,%s,%s,%s,%.9g,%s\n", table->lesson, table->scene, table->technique,
            table->knob, view, metric, value, unit);
}

void table_add(Table *table, const Shots *shots, const View *view, const char *metric, double value,
               const char *unit) {
    (void)shots; /* table_set was told the same; the parameter says whose row it is */
    table_row(table, view ? view->name : "-", metric, value, unit);
}

void table_point(Table *table, const Shots *shots, const View *view, const char *curve, const char *x_name,
                 double x, const char *y_name, double y) {
    (void)shots;
    if (strpbrk(curve, ",\"\n") || strpbrk(x_name, ",\"\n") || strpbrk(y_name, ",\"\n"))
        fail("the curve %s of %s: a name in a table may hold no comma", curve, table->lesson);
    require_finite(table, curve, x);
    require_finite(table, curve, y);
    table->point_count++;
    fprintf(table->curves, "%s,%s,%s,%s,%s,%s,%s,%.9g,%s,%.9g\n", table->lesson, table->scene,
            table->technique, table->knob, view ? view->name : "-", curve, x_name, x, y_name, y);
}

static void save(const char *path, const char *content, size_t size) {
    char *partial = text("%s.partial", path);
    FILE *file = fopen(partial, "wb");
    bool good = file && fwrite(content, 1, size, file) == size;
    good = file && fclose(file) == 0 && good;
    if (!good || rename(partial, path) != 0) {
        int reason = errno;
        if (file) remove(partial);
        fail("%s: cannot be written: %s", path, strerror(reason));
    }
    free(partial);
}

void table_save(const Table *table, const char *path) {
    fflush(table->rows);
    fflush(table->curves);
    const char *ending = strrchr(path, '.');
    int stem = ending && strcmp(ending, ".csv") == 0 ? (int)(ending - path) : (int)strlen(path);
    char *curves = text("%.*s-curves.csv", stem, path);
    save(path, table->rows_text, table->rows_size);
    if (table->point_count)
        save(curves, table->curves_text, table->curves_size);
    else
        remove(curves); /* what an earlier run left would speak for this one */
    free(curves);
}
